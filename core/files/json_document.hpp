// SPDX-License-Identifier: MIT
/// A JSON file as something to read from without surprises: typed reading that collects every fault with its place (file and JSON
/// pointer), unknown keys refused with the nearest known one, numbers finite, lengths in the file's unit or with a unit of their own.
/// Used by every reader of JSON here and in design/. Writing is elsewhere; the JSON library (nlohmann) stays inside the .cpp: it knows no
/// places of values, collects no faults and knows no units, which is what is done by hand here.
///
///     auto document = JsonDocument::read(path);          // file_not_found, file_unreadable, parse (line and column), not_finite
///     if (!document) return document.errors();
///     JsonNode root = document->root();
///     root.allow_keys({"units", "mass"});
///     double mass = root.require("mass").number(positive).value_or(1);
///     if (!document->errors().empty()) return document->errors();
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"

namespace fettle::core::files {

/// Which numbers are allowed. Infinite ends mean no limit but base::largest_magnitude, which holds for every number of every file.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;  ///< `low` itself is not allowed
};
inline constexpr NumberRange any_number{};
inline constexpr NumberRange positive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr NumberRange not_negative{0, std::numeric_limits<double>::infinity(), false};

class JsonNode;

/// Reads a number that is written as a formula, a text that begins with "=". @param si_per_number  What a number without a unit counts.
/// @return its value in SI; nothing if it has faults, which the reader has given to the node.
using FormulaReader =
    std::function<std::optional<double>(const JsonNode& node, const std::string& text, base::Dimension dimension, double si_per_number)>;

/// A value of a document, or the place where one could be. Cheap to copy; lives no longer than its document.
/// Reading functions: nullopt if the value is absent, or if it is wrong (then the fault has been added to the document's errors).
class JsonNode {
public:
    bool exists() const { return value_ != nullptr; }  ///< false: an absent key
    bool is_null() const;
    bool is_bool() const;
    bool is_number() const;
    bool is_string() const;
    bool is_array() const;
    bool is_object() const;

    /// File and JSON pointer: "a.scene.json#/bodies/3/density".
    std::string where() const;
    /// The JSON pointer alone: "/bodies/3/density".
    const std::string& pointer() const { return pointer_; }
    /// What stands there, cut short, for messages: `-5`, `"abc"`, `an object`.
    std::string shown() const;
    /// The value as JSON.
    std::string text() const;

    void fail(base::ErrorCode code, std::string message) const;
    void warn(const std::string& message) const;

    /// Member of an object; absent if there is none. On something that is not an object: wrong_type, reported once for all calls that
    /// follow one another.
    JsonNode operator[](std::string_view key) const;
    /// The same, but absence is a missing_key error.
    JsonNode require(std::string_view key) const;
    /// This node; absent if it is null (for formats where null means "as if it were not there").
    JsonNode unless_null() const&;
    JsonNode unless_null() &&;
    std::vector<JsonNode> elements() const;                         ///< of an array; wrong_type otherwise; empty if absent
    std::vector<JsonNode> objects() const;                          ///< the same, of objects alone; wrong_type of each that is none
    std::vector<std::pair<std::string, JsonNode>> members() const;  ///< of an object, sorted by key; the same rules
    /// read(i, nodes[i]) for each of some nodes of one document, on all threads. What they report comes in their order.
    static void read_each(const std::vector<JsonNode>& nodes, const std::function<void(std::size_t i, const JsonNode& node)>& read);
    /// Errors found so far; within read_each() those of this node and some others.
    std::size_t error_count() const;

    /// unknown_key for every member that is not listed, with the nearest one that is (or all of them if none is near). Keys that start with
    /// `#` are comments.
    void allow_keys(const std::vector<std::string_view>& known) const;
    /// As allow_keys, but warns, and passes over keys that start with `#` (comments in the paper's format).
    void warn_of_other_keys(const std::vector<std::string_view>& known) const;

    std::optional<double> number(const NumberRange& range = any_number) const;
    std::optional<int> integer(int low, int high = std::numeric_limits<int>::max()) const;
    std::optional<bool> boolean() const;
    std::optional<std::string> string() const;
    /// One of `allowed`; out_of_range with the nearest one otherwise.
    std::optional<std::string> choice(const std::vector<std::string_view>& allowed) const;
    /// A number in units of `unit` [m], or a string with a unit of its own ("0.3mm"). @return [m]
    std::optional<double> length(double unit, const NumberRange& range = any_number) const;
    /// A number in units of `si_per_number`, or a string with a unit of its own, of the same dimension ("30 g" where a mass is wanted).
    /// @return SI
    std::optional<double> quantity(base::Dimension dimension, double si_per_number, const NumberRange& range = any_number) const;
    /// Three numbers; three lengths [m].
    std::optional<Vector3> vector3() const;
    std::optional<Vector3> length3(double unit) const;
    std::optional<Vector3> quantity3(base::Dimension dimension, double si_per_number) const;
    std::optional<std::vector<double>> numbers() const;

private:
    friend class JsonDocument;
    struct Context;
    JsonNode(Context* context, const void* value, std::string pointer) : context_(context), value_(value), pointer_(std::move(pointer)) {}
    void fail_as_no_object() const;
    JsonNode child(const void* value, std::string_view key) const;
    std::vector<std::string> other_keys(const std::vector<std::string_view>& known) const;
    bool is_formula() const;
    std::optional<double> formula(base::Dimension dimension, double si_per_number, const NumberRange& range) const;
    bool check_range(double number, const NumberRange& range, std::string_view unit) const;
    template <class Read>
    std::optional<Vector3> three(const Read& read, std::string_view what) const;

    Context* context_;
    const void* value_;    ///< a nlohmann::json, or null
    std::string pointer_;  ///< RFC 6901, "" at the root
};

class JsonDocument {
public:
    static base::Result<JsonDocument> read(const std::string& path);
    /// `name` takes the file's place in messages.
    static base::Result<JsonDocument> parse(const std::string& text, const std::string& name);
    ~JsonDocument();
    JsonDocument(JsonDocument&&) noexcept;
    JsonDocument& operator=(JsonDocument&&) noexcept;

    const std::string& path() const;
    /// What reads numbers that are formulas; without one they are faults.
    void read_formulas(FormulaReader reader);
    /// Puts a copy of `value`, of any document, at a place of this one, before it is read. Elements of lists may be named by their `name`
    /// in place of their number: "/bodies/pin/density". Faults there are reported with the place that `value` has in its own document.
    /// @return what is wrong with the pointer: no such element, nothing that could have such a member. Empty: done.
    std::string replace(std::string_view pointer, const JsonNode& value);
    JsonNode root();
    void forget_errors();                       ///< of a first look, which a whole reading follows
    const base::Errors& errors() const;         ///< found so far by reading nodes, in the order of reading
    std::vector<std::string> warnings() const;  ///< those that say the same of several elements of a list as one (warning_groups.hpp)

private:
    JsonDocument();
    std::unique_ptr<JsonNode::Context> context_;
};

/// `number` times `unit`, correctly rounded where one metre is a whole number of units (30 mm is 0.03 m, bit for bit).
double in_metres(double number, double unit);

}  // namespace fettle::core::files
