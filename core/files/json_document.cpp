// SPDX-License-Identifier: MIT
#include "core/files/json_document.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"
#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_text.hpp"
#include "core/files/nearest_word.hpp"
#include "core/files/warning_groups.hpp"

namespace fettle::core::files {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

struct JsonNode::Context {  // NOLINT(bugprone-exception-escape): the tree moves without throwing
    std::string path;
    json tree;
    base::Errors errors;
    std::vector<Warning> warnings;
    FormulaReader formulas;
    std::vector<std::pair<std::string, std::string>> replaced;  // pointers, and where what stands there now comes from
};

namespace {

const json& value_of(const void* value) { return *static_cast<const json*>(value); }

/// A `/` or `~` inside a key is written as RFC 6901 wants it.
void append_escaped(std::string_view key, std::string& to) {
    if (std::none_of(key.begin(), key.end(), [](char c) { return c == '~' || c == '/'; })) {
        to += key;
        return;
    }
    for (const char c : key) {
        if (c == '~')
            to += "~0";
        else if (c == '/')
            to += "~1";
        else
            to += c;
    }
}

std::string unescaped(std::string_view coded) {
    std::string out;
    for (std::size_t k = 0; k < coded.size(); ++k) {
        const bool escape = coded[k] == '~' && k + 1 < coded.size();
        out += escape ? (coded[++k] == '1' ? '/' : '~') : coded[k];
    }
    return out;
}

// By number, or by `name`.
std::optional<std::size_t> element_named(const json& array, const std::string& word) {
    const bool is_number = !word.empty() && word.size() < 10 && word.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) return std::stoul(word) < array.size() ? std::optional<std::size_t>(std::stoul(word)) : std::nullopt;
    for (std::size_t k = 0; k < array.size(); ++k)
        if (array[k].is_object() && array[k].contains("name") && array[k]["name"] == word) return k;
    return std::nullopt;
}

// "; did you mean `pin`?"
std::string element_names(const json& array, const std::string& word) {
    std::vector<std::string> names;
    for (const json& element : array)
        if (element.is_object() && element.contains("name") && element["name"].is_string())
            names.push_back(element["name"].get<std::string>());
    return names.empty() ? std::string() : "; " + did_you_mean(word, {names.begin(), names.end()}, '`');
}

std::string shortest(double number) {
    const std::string text = dumped(json(number));
    return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

struct Place {
    std::size_t line = 1, column = 1;
};

Place place_of(const std::string& text, std::size_t offset) {
    Place place;
    for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
        if (text[i] == '\n') {
            ++place.line;
            place.column = 1;
        } else {
            ++place.column;
        }
    }
    return place;
}

std::string at(const std::string& name, const Place& place) {
    return name + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

/// The run of letters, digits and signs around an offset: what a person would call the word at fault.
std::string word_around(const std::string& text, std::size_t offset, std::size_t& start) {
    const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.'; };
    start = std::min(offset, text.size());
    while (start > 0 && is_part(text[start - 1])) --start;
    std::size_t end = start;
    while (end < text.size() && is_part(text[end])) ++end;
    return text.substr(start, std::min<std::size_t>(end - start, 40));
}

bool spells_not_finite(std::string word) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.erase(0, 1);
    return word == "nan" || word == "inf" || word == "infinity";
}

Error not_finite_error(const std::string& where, const std::string& found) {
    return {ErrorCode::not_finite, where, "not finite: " + found + "; a finite number is expected"};
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// What is wrong at this place, to one who writes JSON by hand; empty where the library's own words must do.
std::string plain_words(const std::string& text, std::size_t offset, const std::string& word, const std::string& said) {
    const char here = offset < text.size() ? text[offset] : ' ';
    const std::size_t before = offset == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", std::min(offset, text.size()) - 1);
    const bool is_literal = has(said, "invalid literal");
    if (has(said, "unexpected end of input")) return "the text ends too early: is its end missing, or a closing bracket?";
    if (has(said, "missing closing quote")) return "a text has no closing quote";
    if ((here == '}' || here == ']') && before != std::string::npos && text[before] == ',')
        return std::string("a comma stands before ") + here + "; after the last entry there is none";
    if (is_literal && here == '\'') return "text is in double quotes, not in single ones";
    if (is_literal && (here == '/' || here == '#')) return "JSON has no comments";
    if (has(said, "expected end of input")) return "more text follows behind the end";
    if (is_literal && has(said, "object key")) return "a key is expected, which is text in double quotes";
    if (word == "True" || word == "False" || word == "None" || word == "Null") return "JSON writes true, false and null, not " + word;
    if (word.size() > 1 && word[0] == '0' && std::isdigit(static_cast<unsigned char>(word[1]))) return "a number begins with a 0 too many";
    if (has(said, "parsing object separator - unexpected")) return "a colon is missing behind a key";
    if (has(said, "parsing object - unexpected") || has(said, "parsing array - unexpected"))
        if (has(said, "literal; expected") || here == '{' || here == '[') return "a comma is missing before this entry";
    return {};
}

Error parse_fault(const std::string& text, const std::string& name, const json::parse_error& fault) {
    // The library's offset is one past the last character that it read.
    const std::size_t offset = fault.byte > 0 ? fault.byte - 1 : 0;
    std::size_t start = offset;
    const std::string word = word_around(text, offset, start);
    if (spells_not_finite(word)) return not_finite_error(at(name, place_of(text, start)), word);
    std::string message = fault.what();
    const auto colon = message.find(": ");
    if (colon != std::string::npos) message = message.substr(colon + 2);
    const std::string plain = plain_words(text, offset, word, message);
    return {ErrorCode::parse, at(name, place_of(text, offset)), "not valid JSON: " + (plain.empty() ? message : plain)};
}

Error overflow_fault(const std::string& text, const std::string& name, const std::string& what) {
    const auto quote = what.find('\'');
    const std::string number = quote == std::string::npos ? "" : what.substr(quote + 1, what.rfind('\'') - quote - 1);
    const auto offset = number.empty() ? std::string::npos : text.find(number);
    return not_finite_error(offset == std::string::npos ? name : at(name, place_of(text, offset)), number + " is beyond double precision");
}

/// Makes the tree from what the parser sees, and sees every key: a tree keeps only one of two equal ones.
class TreeBuilder {
public:
    TreeBuilder(const std::string& text, const std::string& name, json& tree) : text_(text), name_(name), root_(tree) {}

    base::Errors errors;

    // The parser calls these. @return whether to go on
    bool null() { return place(nullptr); }
    bool boolean(bool value) { return place(value); }
    bool number_integer(json::number_integer_t value) { return place(value); }
    bool number_unsigned(json::number_unsigned_t value) { return place(value); }
    bool number_float(json::number_float_t value, const std::string&) { return place(value); }
    bool string(std::string& value) { return place(std::move(value)); }
    bool binary(json::binary_t& value) { return place(std::move(value)); }
    bool start_object(std::size_t) { return open(json::object()); }
    bool end_object() { return close(); }
    bool start_array(std::size_t) { return open(json::array()); }
    bool end_array() { return close(); }
    bool key(std::string& key) {
        const auto [entry, fresh] = open_.back()->get_ref<json::object_t&>().try_emplace(std::move(key));
        keys_.back() = &entry->first;
        if (!fresh)
            errors.push_back({ErrorCode::inconsistent, here(open_.size()),
                              "the key `" + entry->first + "` stands twice in one object; keep one of them"});
        member_ = &entry->second;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const json::exception& fault) {
        const auto* syntax = dynamic_cast<const json::parse_error*>(&fault);
        errors = {syntax != nullptr ? parse_fault(text_, name_, *syntax) : overflow_fault(text_, name_, fault.what())};
        return false;
    }

private:
    template <class Value>
    json& put(Value&& value) {
        if (open_.empty()) return root_ = std::forward<Value>(value);
        json& parent = *open_.back();
        if (parent.is_array()) return parent.get_ref<json::array_t&>().emplace_back(std::forward<Value>(value));
        return *member_ = std::forward<Value>(value);
    }
    template <class Value>
    bool place(Value&& value) {
        put(std::forward<Value>(value));
        return true;
    }
    bool open(json&& value) {
        if (open_.size() >= deepest_json) {
            errors = {{ErrorCode::out_of_range, here(3) + "/...",
                       "lists and objects are nested deeper than " + std::to_string(deepest_json) + "; nothing that is read needs that"}};
            return false;
        }
        open_.push_back(&put(std::move(value)));
        keys_.push_back(nullptr);
        return true;
    }
    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }
    /// The file, and what is being read in the outermost `levels` as a JSON pointer.
    std::string here(std::size_t levels) const {
        std::string out = name_ + "#";
        for (std::size_t i = 0; i < std::min(levels, open_.size()); ++i) {
            const std::string index = open_[i]->is_array() && !open_[i]->empty() ? std::to_string(open_[i]->size() - 1) : "0";
            append_escaped(keys_[i] != nullptr ? *keys_[i] : index, out += '/');
        }
        return out;
    }

    const std::string& text_;
    const std::string& name_;
    json& root_;
    std::vector<json*> open_;               // objects and arrays, outermost first
    std::vector<const std::string*> keys_;  // of each, the key that was read last; null in an array
    json* member_ = nullptr;                // of the last object, whose value comes next
};

}  // namespace

double in_metres(double number, double unit) {
    const double per_metre = std::round(1 / unit);
    return per_metre >= 2 && 1 / per_metre == unit ? number / per_metre : number * unit;
}

bool JsonNode::is_null() const { return value_ && value_of(value_).is_null(); }
bool JsonNode::is_bool() const { return value_ && value_of(value_).is_boolean(); }
bool JsonNode::is_number() const { return value_ && value_of(value_).is_number(); }
bool JsonNode::is_string() const { return value_ && value_of(value_).is_string(); }
bool JsonNode::is_array() const { return value_ && value_of(value_).is_array(); }
bool JsonNode::is_object() const { return value_ && value_of(value_).is_object(); }

std::string JsonNode::where() const {
    for (const auto& [pointer, source] : context_->replaced) {
        if (!pointer_.starts_with(pointer)) continue;
        const std::string_view rest = std::string_view(pointer_).substr(pointer.size());
        if (rest.empty() || rest.front() == '/') return source + std::string(rest);
    }
    return context_->path + "#" + pointer_;
}

std::string JsonNode::shown() const {
    if (!exists()) return "nothing";
    const json& value = value_of(value_);
    if (value.is_object()) return "an object";
    if (value.is_array()) return "a list of " + std::to_string(value.size());
    std::string text = dumped(value);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

std::string JsonNode::text() const { return exists() ? dumped(value_of(value_)) : "null"; }

void JsonNode::fail(ErrorCode code, std::string message) const { context_->errors.push_back({code, where(), std::move(message)}); }

void JsonNode::warn(const std::string& message) const { context_->warnings.push_back({pointer_, message}); }

JsonNode JsonNode::child(const void* value, std::string_view key) const {
    std::string pointer;
    pointer.reserve(pointer_.size() + key.size() + 2);
    pointer.append(pointer_).push_back('/');
    append_escaped(key, pointer);
    return {context_, value, std::move(pointer)};
}

// However many of its members are asked for, one after the other.
void JsonNode::fail_as_no_object() const {
    const base::Errors& errors = context_->errors;
    if (!errors.empty() && errors.back().code == ErrorCode::wrong_type && errors.back().where == where()) return;
    fail(ErrorCode::wrong_type, "an object is expected, found " + shown());
}

JsonNode JsonNode::operator[](std::string_view key) const {
    if (!exists()) return child(nullptr, key);
    if (!is_object()) {
        fail_as_no_object();
        return child(nullptr, key);
    }
    const json& object = value_of(value_);
    const auto found = object.find(key);
    return child(found == object.end() ? nullptr : &*found, key);
}

JsonNode JsonNode::require(std::string_view key) const {
    const JsonNode found = (*this)[key];
    if (is_object() && !found.exists()) fail(ErrorCode::missing_key, "the key `" + std::string(key) + "` is required here");
    return found;
}

JsonNode JsonNode::unless_null() const& { return JsonNode(*this).unless_null(); }
JsonNode JsonNode::unless_null() && { return {context_, is_null() ? nullptr : value_, std::move(pointer_)}; }

std::vector<JsonNode> JsonNode::elements() const {
    std::vector<JsonNode> out;
    if (!exists()) return out;
    if (!is_array()) {
        fail(ErrorCode::wrong_type, "a list is expected, found " + shown());
        return out;
    }
    const json& array = value_of(value_);
    out.reserve(array.size());
    for (std::size_t i = 0; i < array.size(); ++i) out.push_back(child(&array[i], std::to_string(i)));
    return out;
}

std::vector<JsonNode> JsonNode::objects() const {
    std::vector<JsonNode> out = elements();
    std::erase_if(out, [](const JsonNode& element) {
        if (!element.is_object()) element.fail_as_no_object();
        return !element.is_object();
    });
    return out;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
    std::vector<std::pair<std::string, JsonNode>> out;
    if (!exists()) return out;
    if (!is_object()) {
        fail_as_no_object();
        return out;
    }
    for (const auto& [key, value] : value_of(value_).items()) out.emplace_back(key, child(&value, key));
    return out;
}

void JsonNode::read_each(const std::vector<JsonNode>& nodes, const std::function<void(std::size_t, const JsonNode&)>& read) {
    constexpr int at_once = 16;  // that a thread takes
    if (nodes.empty()) return;
    Context& all = *nodes.front().context_;
    std::vector<Context> reports(nodes.size() / at_once + 1);
    base::parallel_pieces(count_of(nodes), at_once, [&](int begin, int end) {
        Context& own = reports[begin / at_once];
        own.path = all.path;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            read(i, JsonNode(&own, nodes[i].value_, nodes[i].pointer_));
    });
    for (const Context& own : reports) {
        all.errors.insert(all.errors.end(), own.errors.begin(), own.errors.end());
        all.warnings.insert(all.warnings.end(), own.warnings.begin(), own.warnings.end());
    }
}

std::size_t JsonNode::error_count() const { return context_->errors.size(); }

std::vector<std::string> JsonNode::other_keys(const std::vector<std::string_view>& known) const {
    std::vector<std::string> out;
    for (const auto& [key, value] : value_of(value_).get_ref<const json::object_t&>())
        if (!key.starts_with('#') && std::find(known.begin(), known.end(), key) == known.end()) out.push_back(key);
    return out;
}

void JsonNode::allow_keys(const std::vector<std::string_view>& known) const {
    if (!exists()) return;
    if (!is_object()) return fail_as_no_object();
    for (const std::string& key : other_keys(known))
        (*this)[key].fail(ErrorCode::unknown_key, "unknown key `" + key + "`; " + did_you_mean(key, known, '`'));
}

void JsonNode::warn_of_other_keys(const std::vector<std::string_view>& known) const {
    if (!is_object()) return;
    for (const std::string& key : other_keys(known)) {
        const auto nearest = nearest_word(key, known);
        (*this)[key].warn("unknown key `" + key + "` is ignored" + (nearest ? "; did you mean `" + *nearest + "`?" : ""));
    }
}

bool JsonNode::check_range(double number, const NumberRange& range, std::string_view unit) const {
    if (!std::isfinite(number)) {
        context_->errors.push_back(not_finite_error(where(), shown()));
        return false;
    }
    if (!base::is_usable_number(number)) {
        fail(ErrorCode::out_of_range, shown() + " is out of range: at most 1e30 in absolute value is allowed");
        return false;
    }
    const bool low_fails = range.low_open ? !(number > range.low) : !(number >= range.low);
    if (!low_fails && number <= range.high) return true;
    std::string allowed;
    if (std::isfinite(range.low)) allowed = (range.low_open ? "greater than " : "at least ") + shortest(range.low);
    if (std::isfinite(range.high)) allowed += (allowed.empty() ? "" : " and ") + ("at most " + shortest(range.high));
    const auto wants_unit = [](double limit) { return std::isfinite(limit) && limit != 0; };  // 0 m is 0 in every unit
    if (wants_unit(range.low) || wants_unit(range.high)) allowed += unit;
    fail(ErrorCode::out_of_range, shown() + " is out of range: it must be " + allowed);
    return false;
}

bool JsonNode::is_formula() const { return is_string() && value_of(value_).get_ref<const std::string&>().starts_with('='); }

std::optional<double> JsonNode::formula(base::Dimension dimension, double si_per_number, const NumberRange& range) const {
    const std::string& text = value_of(value_).get_ref<const std::string&>();
    if (!context_->formulas) {
        fail(ErrorCode::wrong_type, "a number is expected; formulas such as " + shown() + " are not read here");
        return std::nullopt;
    }
    const auto value = context_->formulas(*this, text, dimension, si_per_number);
    if (!value || !check_range(*value, range, " " + std::string(base::si_unit(dimension)))) return std::nullopt;
    return value;
}

std::optional<double> JsonNode::number(const NumberRange& range) const {
    if (!exists()) return std::nullopt;
    if (is_formula()) return formula(base::Dimension::number, 1, range);
    if (!is_number()) {
        if (is_string() && spells_not_finite(value_of(value_).get<std::string>())) {
            context_->errors.push_back(not_finite_error(where(), shown()));
        } else {
            fail(ErrorCode::wrong_type, "a number is expected, found " + shown());
        }
        return std::nullopt;
    }
    const auto found = value_of(value_).get<double>();
    if (!check_range(found, range, "")) return std::nullopt;
    return found;
}

std::optional<int> JsonNode::integer(int low, int high) const {
    const auto found = number();
    if (!found) return std::nullopt;
    if (*found != std::floor(*found)) {
        fail(ErrorCode::wrong_type, "a whole number is expected, found " + shown());
        return std::nullopt;
    }
    if (!check_range(*found, {static_cast<double>(low), static_cast<double>(high)}, "")) return std::nullopt;
    return static_cast<int>(*found);
}

std::optional<bool> JsonNode::boolean() const {
    if (!exists()) return std::nullopt;
    if (is_bool()) return value_of(value_).get<bool>();
    fail(ErrorCode::wrong_type, "true or false is expected, found " + shown());
    return std::nullopt;
}

std::optional<std::string> JsonNode::string() const {
    if (!exists()) return std::nullopt;
    if (is_string()) return value_of(value_).get<std::string>();
    fail(ErrorCode::wrong_type, "a string is expected, found " + shown());
    return std::nullopt;
}

std::optional<std::string> JsonNode::choice(const std::vector<std::string_view>& allowed) const {
    const auto found = string();
    if (!found || std::find(allowed.begin(), allowed.end(), *found) != allowed.end()) return found;
    const auto nearest = nearest_word(*found, allowed);
    fail(ErrorCode::out_of_range, shown() + " is not one of: " + joined(allowed) + (nearest ? "; did you mean `" + *nearest + "`?" : ""));
    return std::nullopt;
}

std::optional<double> JsonNode::length(double unit, const NumberRange& range) const {
    return quantity(base::Dimension::length, unit, range);
}

std::optional<double> JsonNode::quantity(base::Dimension dimension, double si_per_number, const NumberRange& range) const {
    if (!exists()) return std::nullopt;
    if (is_formula()) return formula(dimension, si_per_number, range);
    const std::string unit = " " + std::string(base::si_unit(dimension));
    if (is_string() && !spells_not_finite(value_of(value_).get<std::string>())) {
        const auto parsed = base::parse_quantity(value_of(value_).get<std::string>(), dimension, where());
        if (!parsed) {
            context_->errors.insert(context_->errors.end(), parsed.errors().begin(), parsed.errors().end());
            return std::nullopt;
        }
        if (!check_range(*parsed, range, unit)) return std::nullopt;
        return *parsed;
    }
    const auto found = number();
    if (!found || !check_range(in_metres(*found, si_per_number), range, unit)) return std::nullopt;
    return in_metres(*found, si_per_number);
}

template <class Read>
std::optional<Vector3> JsonNode::three(const Read& read, std::string_view what) const {
    if (!exists()) return std::nullopt;
    if (!is_array() || value_of(value_).size() != 3) {
        fail(ErrorCode::wrong_type, "a list of three " + std::string(what) + " is expected, found " + shown());
        return std::nullopt;
    }
    Vector3 out;
    bool good = true;
    const auto entries = elements();
    for (int i = 0; i < 3; ++i) {
        const std::optional<double> entry = read(entries[i]);
        good = good && entry.has_value();
        out[i] = entry.value_or(0);
    }
    if (!good) return std::nullopt;
    return out;
}

std::optional<Vector3> JsonNode::vector3() const {
    return three([](const JsonNode& node) { return node.number(); }, "numbers");
}

std::optional<Vector3> JsonNode::length3(double unit) const {
    return three([unit](const JsonNode& node) { return node.length(unit); }, "lengths");
}

std::optional<Vector3> JsonNode::quantity3(base::Dimension dimension, double si_per_number) const {
    return three([=](const JsonNode& node) { return node.quantity(dimension, si_per_number); }, "numbers");
}

std::optional<std::vector<double>> JsonNode::numbers() const {
    if (!exists()) return std::nullopt;
    if (!is_array()) {
        fail(ErrorCode::wrong_type, "a list of numbers is expected, found " + shown());
        return std::nullopt;
    }
    std::vector<double> out;
    bool good = true;
    const json& array = value_of(value_);
    out.reserve(array.size());
    for (std::size_t i = 0; i < array.size(); ++i) {
        // Long lists of numbers are common: a node, with its pointer, is made only to report a fault.
        const bool plain = array[i].is_number() && base::is_usable_number(array[i].get<double>());
        const std::optional<double> found = plain ? array[i].get<double>() : child(&array[i], std::to_string(i)).number();
        good = good && found.has_value();
        out.push_back(found.value_or(0));
    }
    if (!good) return std::nullopt;
    return out;
}

JsonDocument::JsonDocument() : context_(std::make_unique<JsonNode::Context>()) {}
JsonDocument::~JsonDocument() = default;
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;

base::Result<JsonDocument> JsonDocument::read(const std::string& path) {
    const auto text = read_file(path);
    if (!text) return text.errors();
    return parse(*text, path);
}

base::Result<JsonDocument> JsonDocument::parse(const std::string& text, const std::string& name) {
    JsonDocument document;
    document.context_->path = name;
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
        return Error{ErrorCode::parse, name, "is empty; JSON is expected, which begins with {"};
    if (const std::size_t nul = text.find('\0'); nul != std::string::npos)
        return Error{ErrorCode::parse, at(name, place_of(text, nul)), "not valid JSON: here stands a NUL; is the file damaged?"};
    TreeBuilder builder(text, name, document.context_->tree);
    json::sax_parse(text, &builder);
    if (!builder.errors.empty()) return builder.errors;
    return document;
}

const std::string& JsonDocument::path() const { return context_->path; }

void JsonDocument::read_formulas(FormulaReader reader) { context_->formulas = std::move(reader); }

std::string JsonDocument::replace(std::string_view pointer, const JsonNode& value) {
    json* at = &context_->tree;
    std::string resolved;
    std::string_view rest = pointer;
    if (!rest.starts_with('/')) return "a place is expected, such as /bodies/pin/density";
    while (!rest.empty()) {
        rest.remove_prefix(1);
        const std::string_view coded = rest.substr(0, rest.find('/'));
        rest.remove_prefix(coded.size());
        const std::string word = unescaped(coded);
        const bool is_last = rest.empty();
        if (at->is_array()) {
            const auto index = element_named(*at, word);
            if (!index) return "`" + resolved + "` has no element `" + word + "`" + element_names(*at, word);
            resolved += "/" + std::to_string(*index);
            at = &(*at)[*index];
        } else if (at->is_object()) {
            if (!is_last && !at->contains(word))
                return "there is no `" + word + "` " + (resolved.empty() ? "in the file" : "in `" + resolved + "`");
            append_escaped(word, resolved += '/');
            at = &(*at)[word];
        } else {
            return "`" + resolved + "` is neither a list nor an object, so that there is no `" + word + "` in it";
        }
    }
    *at = value_of(value.value_);
    context_->replaced.insert(context_->replaced.begin(), {resolved, value.where()});
    return {};
}
JsonNode JsonDocument::root() { return {context_.get(), &context_->tree, ""}; }
void JsonDocument::forget_errors() { context_->errors.clear(); }
const base::Errors& JsonDocument::errors() const { return context_->errors; }
std::vector<std::string> JsonDocument::warnings() const { return grouped_warnings(context_->path, context_->warnings); }

}  // namespace fettle::core::files
