// SPDX-License-Identifier: MIT
/// A small pull parser of XML that may come from anywhere: elements, attributes, the five predefined entities and character references;
/// text between elements is passed over. UTF-8. A document type (and with it every entity of a file's own) is refused. For 3MF.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::core::mesh_files {

/// Walks over the tags of a text, which outlives it:
///
///     while (xml.next()) if (xml.opens() && xml.name() == "vertex") x = xml.attribute("x");
///     if (!xml.errors().empty()) ...
///
/// A tag that closes itself opens and closes: two visits.
class XmlReader {
public:
    XmlReader(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

    /// False at the end, and at a fault.
    bool next();
    bool opens() const { return opens_; }            ///< else this is an end tag
    std::string_view name() const { return name_; }  ///< of the element, without its prefix ("p:item": "item")
    int depth() const { return depth_; }             ///< of the element, the root's is 1

    /// By its full name ("p:path"), entities resolved.
    std::optional<std::string> attribute(std::string_view name) const;
    /// The same as it stands, for numbers.
    std::optional<std::string_view> raw_attribute(std::string_view name) const;
    /// Full names, in order.
    std::vector<std::string_view> attribute_names() const;

    /// "path:12": the line of the tag.
    std::string where() const;
    void fail(ErrorCode code, const std::string& message);
    const Errors& errors() const { return errors_; }

private:
    struct Attribute {
        std::string_view name, value;
    };
    bool skip_to_tag();
    bool read_attributes();
    void skip_blanks();
    std::string_view word();
    bool fault(const std::string& message);

    std::string_view text_;
    std::string where_;
    std::size_t at_ = 0, tag_ = 0;
    bool opens_ = false, closes_itself_ = false, known_as_utf8_ = false;
    mutable std::size_t counted_to_ = 0, lines_counted_ = 0;  ///< new lines before a place in the text
    int depth_ = 0;
    std::string_view name_;
    std::vector<std::string_view> open_;  ///< full names of the elements that are open
    std::vector<Attribute> attributes_;
    Errors errors_;
};

}  // namespace fettle::core::mesh_files
