// SPDX-License-Identifier: MIT
/// What profiles and solids of a part's file have in common (profile_reader.hpp, solid_reader.hpp). A shape is the name of one that the
/// file defines, or an object with one verb and the keys that go with it, which may hold shapes in turn. What is read is a maker, which
/// draws the shape on a sheet. Faults of the file go to the document as it is read; what cannot be drawn is an error with the place of the
/// shape.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/nearest_word.hpp"
#include "core/part_files/part_numbers.hpp"

namespace fettle::core::part_files {

/// Shapes within one another, names looked through, that are drawn; more are a fault.
inline constexpr int deepest_shape = 200;

/// The error of points that are not finite, or farther away than any number of a file.
Error out_of_reach(const std::string& feature, const std::string& where);

/// The verb of a shape: which of `known` its object has as a key. Fault, and nothing: none, with what was probably meant; several.
std::optional<std::string> verb_of(const files::JsonNode& node, const std::vector<std::string_view>& known, std::string_view what);

/// @tparam Reader  derives from this, and has
///     static const std::vector<Verb>& verbs();
///     static Result<Shape> drawn_once(const std::string& name, const Maker& maker, Sheet& sheet);     // of a shape with a name
///     static std::optional<Error> fault_of(const Shape& shape, const std::string& where);                // too large, not finite
///     static std::optional<Error> fault_of(const std::vector<Shape>& shapes, const std::string& where);  // before they become one
///     ListMaker repeated(const files::JsonNode& node, const std::string& name);                         // the copies of a `repeat`
template <class Reader, class Shape>
class ShapeReader {
public:
    using Maker = std::function<Result<Shape>(Sheet&)>;
    using ListMaker = std::function<Result<std::vector<Shape>>(Sheet&)>;
    using Makers = std::map<std::string, Maker>;

    /// Reads all that have a name. Then read() may be called.
    void read_named() {
        for (const auto& [name, node] : named_.members())
            if (!name.starts_with('#')) (*makers_)[name] = {};  // known before any is read: they stand in any order
        for (auto& [name, maker] : *makers_) maker = read(named_[name], name);
    }

    Maker read(const files::JsonNode& node, const std::string& name) {
        Maker maker = node.is_string() ? reference(node) : read_object(node, name);
        return [maker = std::move(maker), where = node.where()](Sheet& sheet) -> Result<Shape> {
            if (!maker || sheet.depth >= deepest_shape)
                return Error{
                    base::ErrorCode::inconsistent, where,
                    "shapes stand within one another more than " + std::to_string(deepest_shape) + " deep; is one made of itself?"};
            ++sheet.depth;
            Result<Shape> made = maker(sheet);
            --sheet.depth;
            if (made)
                if (std::optional<Error> fault = Reader::fault_of(*made, where)) return *std::move(fault);
            return located(std::move(made), where);
        };
    }

    /// What has been read must not outlive this.
    std::shared_ptr<const Makers> named_makers() const { return makers_; }

protected:
    struct Verb {
        std::string_view name;
        std::vector<std::string_view> keys;
        Maker (Reader::*read)(const files::JsonNode& node, const std::string& name);
    };

    /// @param kind  "profile"; the file's list of those that have a name, `named`, is `profiles`.
    ShapeReader(PartNumbers& numbers, const files::JsonNode& named, std::string kind)
        : numbers_(numbers), named_(named), kind_(std::move(kind)), makers_(std::make_shared<Makers>()) {}

    /// One shape or a list of them, in which a repeat counts as its copies.
    ListMaker read_list(const files::JsonNode& node, const std::string& name) {
        std::vector<ListMaker> makers;
        if (node.is_array())
            for (const files::JsonNode& element : node.elements()) makers.push_back(read_copies(element, name));
        else if (node.exists())
            makers.push_back(read_copies(node, name));
        return [makers, where = node.where()](Sheet& sheet) -> Result<std::vector<Shape>> {
            std::vector<Shape> out;
            for (const ListMaker& maker : makers) {
                Result<std::vector<Shape>> made = maker(sheet);
                if (!made) return made.errors();
                out.insert(out.end(), made->begin(), made->end());
                if (std::optional<Error> fault = Reader::fault_of(out, where)) return *std::move(fault);
            }
            return out;
        };
    }

    PartNumbers& numbers_;

private:
    Maker reference(const files::JsonNode& node) {
        const std::string name = *node.string();
        if (makers_->count(name) == 0) {
            std::vector<std::string_view> known;
            for (const auto& [each, maker] : *makers_) known.emplace_back(each);
            node.fail(base::ErrorCode::out_of_range, "there is no " + kind_ + " `" + name + "`; " + files::did_you_mean(name, known, '`'));
            return {};
        }
        return [name, makers = makers_.get()](Sheet& sheet) { return Reader::drawn_once(name, makers->at(name), sheet); };
    }

    Maker read_object(const files::JsonNode& node, const std::string& name) {
        if (!node.is_object()) {
            if (node.exists())
                node.fail(base::ErrorCode::wrong_type,
                          "expected a " + kind_ + ", which is an object or the name of one of `" + kind_ + "s`; found " + node.shown());
            return {};
        }
        const std::vector<Verb>& verbs = Reader::verbs();
        std::vector<std::string_view> known;
        for (const Verb& verb : verbs) known.push_back(verb.name);
        const auto found = verb_of(node, known, "a " + kind_);
        if (!found) return {};
        const Verb& verb = *std::find_if(verbs.begin(), verbs.end(), [&](const Verb& each) { return each.name == *found; });
        std::vector<std::string_view> keys{verb.name, "name"};
        keys.insert(keys.end(), verb.keys.begin(), verb.keys.end());
        node.allow_keys(keys);
        return (static_cast<Reader*>(this)->*verb.read)(node, node["name"].string().value_or(name));
    }

    ListMaker read_copies(const files::JsonNode& node, const std::string& name) {
        if (node.is_object() && node["repeat"].exists()) return static_cast<Reader*>(this)->repeated(node, name);
        return [one = read(node, name)](Sheet& sheet) -> Result<std::vector<Shape>> {
            Result<Shape> made = one(sheet);
            if (!made) return made.errors();
            return std::vector<Shape>{std::move(*made)};
        };
    }

    files::JsonNode named_;
    std::string kind_;
    std::shared_ptr<Makers> makers_;
};

}  // namespace fettle::core::part_files
