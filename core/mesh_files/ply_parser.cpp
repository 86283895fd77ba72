// SPDX-License-Identifier: MIT
// PLY 1.0 (Turk 1994): text and both byte orders, any type for any property, elements in any order. Taken: x, y, z of `vertex`,
// `vertex_indices` or `vertex_index` of `face`, `vertex1` and `vertex2` of `edge`; the rest is passed over. Every count is checked against
// what the file still holds before anything is done with it.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "core/files/text_lines.hpp"
#include "core/mesh_files/millimetres.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
    std::string_view name;
    Type type;
};
constexpr std::array<TypeName, 16> type_names = {{{"char", Type::int8},
                                                  {"uchar", Type::uint8},
                                                  {"short", Type::int16},
                                                  {"ushort", Type::uint16},
                                                  {"int", Type::int32},
                                                  {"uint", Type::uint32},
                                                  {"float", Type::float32},
                                                  {"double", Type::float64},
                                                  {"int8", Type::int8},
                                                  {"uint8", Type::uint8},
                                                  {"int16", Type::int16},
                                                  {"uint16", Type::uint16},
                                                  {"int32", Type::int32},
                                                  {"uint32", Type::uint32},
                                                  {"float32", Type::float32},
                                                  {"float64", Type::float64}}};

std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

struct Property {
    std::string name;
    Type type = Type::float32;
    std::optional<Type> count;  ///< of a list: the type of its length
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;

    /// The place of the property of this name, or -1.
    int find(std::string_view property) const {
        for (std::size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == property) return static_cast<int>(i);
        return -1;
    }
};

/// One number after the other behind the header; nullopt at the end of the file, and in text for a word that is no number.
class Numbers {
public:
    enum class Order { text, little_endian, big_endian };

    Numbers(std::string_view body, Order order) : order_(order), bytes_(body), words_(body) {}

    std::optional<double> next(Type type) {
        if (order_ == Order::text) {
            last_word_ = words_.next();
            return files::parsed_number(last_word_);
        }
        const std::size_t size = size_of(type);
        if (bytes_.size() < size) {
            bytes_ = {};
            return std::nullopt;
        }
        std::array<char, 8> raw{};
        std::copy_n(bytes_.begin(), size, raw.begin());
        bytes_.remove_prefix(size);
        if ((order_ == Order::big_endian) != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.begin() + size);
        return value(raw.data(), type);
    }
    /// At most so many times can still come what is so many numbers in text, and in binary so many bytes.
    std::uint64_t most_left(std::size_t numbers, std::size_t bytes) const {
        return order_ == Order::text ? (words_.bytes_left() / 2 + 1) / numbers : bytes_.size() / bytes;
    }
    /// Empty: the file has ended.
    std::string_view last_word() const { return last_word_; }
    int line_number() const { return words_.line_number(); }
    bool is_text() const { return order_ == Order::text; }

private:
    template <class Number>
    static double as(const char* raw) {
        Number number;
        std::memcpy(&number, raw, sizeof number);
        return static_cast<double>(number);
    }
    static double value(const char* raw, Type type) {
        switch (type) {
            case Type::int8:
                return as<std::int8_t>(raw);
            case Type::uint8:
                return as<std::uint8_t>(raw);
            case Type::int16:
                return as<std::int16_t>(raw);
            case Type::uint16:
                return as<std::uint16_t>(raw);
            case Type::int32:
                return as<std::int32_t>(raw);
            case Type::uint32:
                return as<std::uint32_t>(raw);
            case Type::float32:
                return as<float>(raw);
            case Type::float64:
                break;
        }
        return as<double>(raw);
    }

    Order order_;
    std::string_view bytes_;
    files::TextWords words_;
    std::string_view last_word_;
};

class PlyParser {
public:
    PlyParser(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    Result<RawMesh> parse() {
        read_header();
        if (errors_.empty()) check_elements();
        if (errors_.empty()) read_body();
        if (errors_.empty()) check_indices();
        if (!errors_.empty()) return errors_;
        return std::move(mesh_);
    }

private:
    void fail(ErrorCode code, const std::string& message, int line = 0) {
        errors_.push_back({code, line > 0 ? where_ + ":" + std::to_string(line) : where_, message});
    }

    void read_header() {
        std::size_t at = 0;
        int line = 0;
        bool format = false;
        std::vector<std::string_view> words;
        while (errors_.empty()) {
            const std::size_t end = bytes_.find('\n', at);
            if (end == std::string_view::npos && line == 0)
                return fail(ErrorCode::parse, "does not begin with `ply`: it is not a PLY file");
            if (end == std::string_view::npos)
                return fail(ErrorCode::parse, "ends inside its header (there is no `end_header`): the file is cut short", line + 1);
            files::TextWords in_line(bytes_.substr(at, end - at));
            at = end + 1;
            words.clear();
            for (std::string_view word = in_line.next(); !word.empty(); word = in_line.next()) words.push_back(word);
            if (++line == 1) {
                if (words.size() != 1 || words[0] != "ply") fail(ErrorCode::parse, "does not begin with `ply`: it is not a PLY file");
                continue;
            }
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format") {
                format = true;
                read_format(words, line);
            } else if (words[0] == "element") {
                read_element(words, line);
            } else if (words[0] == "property") {
                read_property(words, line);
            } else {
                fail(ErrorCode::parse, "`" + std::string(words[0].substr(0, 20)) + "` is not a keyword of a PLY header", line);
            }
        }
        if (errors_.empty() && !format) fail(ErrorCode::parse, "its header has no line `format`");
        header_lines_ = line;
        body_ = bytes_.substr(at);
    }

    void read_format(const std::vector<std::string_view>& words, int line) {
        const std::string_view name = words.size() > 1 ? words[1] : "";
        if (name == "ascii")
            order_ = Numbers::Order::text;
        else if (name == "binary_little_endian")
            order_ = Numbers::Order::little_endian;
        else if (name == "binary_big_endian")
            order_ = Numbers::Order::big_endian;
        else
            fail(ErrorCode::unsupported, "the format must be ascii, binary_little_endian or binary_big_endian", line);
        if (words.size() != 3 || words[2] != "1.0") fail(ErrorCode::unsupported, "the version of the format must be 1.0", line);
    }

    /// Every name is compared with those before it.
    void count_declaration(int line) {
        constexpr int most = 1000;
        if (++declarations_ > most)
            fail(ErrorCode::out_of_range, "its header has more than " + std::to_string(most) + " elements and properties", line);
    }

    void read_element(const std::vector<std::string_view>& words, int line) {
        count_declaration(line);
        const auto count = words.size() == 3 ? files::parsed_integer(words[2]) : std::nullopt;
        if (!count || *count < 0)
            return fail(ErrorCode::parse, "an element is `element NAME COUNT`, with a count from 0 to 2147483647", line);
        elements_.push_back({std::string(words[1]), static_cast<std::uint64_t>(*count), {}});
    }

    void read_property(const std::vector<std::string_view>& words, int line) {
        const auto type_of = [&](std::string_view name) {
            const auto known = std::find_if(type_names.begin(), type_names.end(), [&](const TypeName& each) { return each.name == name; });
            if (known != type_names.end()) return known->type;
            fail(ErrorCode::parse, "`" + std::string(name.substr(0, 20)) + "` is not a type of PLY (char, uchar, short, ... double)", line);
            return Type::int8;
        };
        count_declaration(line);
        if (elements_.empty()) return fail(ErrorCode::parse, "a property stands before any element", line);
        const bool list = words.size() > 1 && words[1] == "list";
        if (words.size() != (list ? 5u : 3u))
            return fail(ErrorCode::parse, "a property is `property TYPE NAME` or `property list TYPE TYPE NAME`", line);
        Property property{std::string(words.back()), type_of(words[list ? 3 : 1]), std::nullopt};
        if (list) property.count = type_of(words[2]);
        if (list && (*property.count == Type::float32 || *property.count == Type::float64))
            fail(ErrorCode::parse, "the length of a list must be of a whole type", line);
        if (elements_.back().find(property.name) >= 0)
            fail(ErrorCode::inconsistent, "the property `" + property.name.substr(0, 40) + "` stands twice in one element", line);
        elements_.back().properties.push_back(std::move(property));
    }

    /// That what is taken is there, and of a kind that can be taken.
    void check_elements() {
        bool vertices = false;
        for (const Element& element : elements_) {
            if (element.name == "tristrips" && element.count > 0)
                fail(ErrorCode::unsupported, "has triangle strips, which are not read; export its faces as triangles or polygons");
            if (element.properties.empty() && element.count > 0)
                fail(ErrorCode::parse, "the element `" + element.name.substr(0, 40) + "` has no property");
            if (element.name == "vertex") {
                if (std::exchange(vertices, true)) fail(ErrorCode::inconsistent, "has two elements `vertex`");
                for (const char* axis : {"x", "y", "z"}) require(element, axis, false);
            }
            if (element.name == "face" && element.count > 0) require(element, face_list(element), true);
            if (element.name == "edge" && element.count > 0)
                for (const char* end : {"vertex1", "vertex2"}) require(element, end, false);
        }
        if (!vertices) fail(ErrorCode::parse, "has no element `vertex`");
    }

    static const char* face_list(const Element& element) {
        return element.find("vertex_indices") < 0 && element.find("vertex_index") >= 0 ? "vertex_index" : "vertex_indices";
    }

    void require(const Element& element, std::string_view name, bool list) {
        const int found = element.find(name);
        if (found >= 0 && element.properties[found].count.has_value() == list) return;
        fail(ErrorCode::parse, "the element `" + element.name + "` needs " + (list ? "a list" : "a single number") + " `" +
                                   std::string(name) + "` as a property");
    }

    void read_body() {
        Numbers numbers(body_, order_);
        for (const Element& element : elements_) {
            if (errors_.empty() && element.count > 0) read_elements(numbers, element);
        }
    }

    void read_elements(Numbers& numbers, const Element& element) {
        if (element.count > numbers.most_left(element.properties.size(), least_size(element)))
            return cut_short(numbers, element, std::nullopt);
        const Taken taken = taken_from(element);
        std::vector<double> single(element.properties.size()), list, corners;
        for (std::uint64_t i = 0; i < element.count && errors_.empty(); ++i) {
            for (std::size_t p = 0; p < element.properties.size() && errors_.empty(); ++p) {
                const Property& property = element.properties[p];
                if (property.count) {
                    read_list(numbers, element, i, property, list);
                    if (taken.what == Taken::What::face && p == taken.places[0]) std::swap(corners, list);
                } else {
                    single[p] = number(numbers, element, i, property.type);
                }
            }
            if (errors_.empty()) take(taken, single, corners);
        }
    }

    /// What becomes of an element, and at which of its properties the numbers for it are.
    struct Taken {
        enum class What { nothing, vertex, edge, face } what = What::nothing;
        std::array<std::size_t, 3> places{};
    };
    static Taken taken_from(const Element& element) {
        const auto at = [&](std::string_view name) { return static_cast<std::size_t>(element.find(name)); };
        if (element.name == "vertex") return {Taken::What::vertex, {at("x"), at("y"), at("z")}};
        if (element.name == "edge") return {Taken::What::edge, {at("vertex1"), at("vertex2"), 0}};
        if (element.name == "face") return {Taken::What::face, {at(face_list(element)), 0, 0}};
        return {};
    }

    /// The least size of one such element in a binary file [bytes].
    static std::size_t least_size(const Element& element) {
        std::size_t size = 0;
        for (const Property& property : element.properties) size += size_of(property.count.value_or(property.type));
        return size;
    }

    void cut_short(const Numbers& numbers, const Element& element, std::optional<std::uint64_t> index) {
        const std::string which = index ? "ends after " + std::to_string(*index) + " of" : "has no room for";
        fail(ErrorCode::parse,
             which + " the " + std::to_string(element.count) + " elements `" + element.name.substr(0, 40) +
                 "` that its header announces: the file is cut short; export or download it again",
             index && numbers.is_text() ? header_lines_ + numbers.line_number() : 0);
    }

    double number(Numbers& numbers, const Element& element, std::uint64_t index, Type type) {
        const auto value = numbers.next(type);
        if (value) return *value;
        if (numbers.last_word().empty()) {
            cut_short(numbers, element, index);
        } else {
            fail(ErrorCode::parse, "`" + std::string(numbers.last_word().substr(0, 20)) + "` is not a number",
                 header_lines_ + numbers.line_number());
        }
        return 0;
    }

    void read_list(Numbers& numbers, const Element& element, std::uint64_t index, const Property& property, std::vector<double>& list) {
        list.clear();
        const double length = number(numbers, element, index, *property.count);
        if (!errors_.empty()) return;
        if (!(length >= 0) || length != std::floor(length))
            return fail(ErrorCode::parse, "the length of the list `" + property.name.substr(0, 40) + "` of element " +
                                              std::to_string(index) + " of `" + element.name.substr(0, 40) + "` is not a whole number");
        if (length > static_cast<double>(numbers.most_left(1, size_of(property.type)))) return cut_short(numbers, element, index);
        for (double i = 0; i < length && errors_.empty(); ++i) list.push_back(number(numbers, element, index, property.type));
    }

    void take(const Taken& taken, const std::vector<double>& single, const std::vector<double>& corners) {
        const auto at = [&](std::size_t k) { return single[taken.places[k]]; };
        if (taken.what == Taken::What::vertex) mesh_.vertices.emplace_back(at(0), at(1), at(2));
        if (taken.what == Taken::What::edge) mesh_.edges.push_back({index_of(at(0), "edge"), index_of(at(1), "edge")});
        if (taken.what != Taken::What::face) return;
        if (corners.size() == 1) mesh_.points.push_back(index_of(corners[0], "face"));
        if (corners.size() == 2) mesh_.edges.push_back({index_of(corners[0], "face"), index_of(corners[1], "face")});
        if (corners.size() < 3) return;
        for (const double corner : corners) mesh_.corners.push_back(index_of(corner, "face"));
        mesh_.polygon_ends.push_back(count_of(mesh_.corners));
        mesh_.polygon_group.push_back(-1);
    }

    /// A whole number from 0; whether there is such a vertex is known at the end.
    int index_of(double value, const char* of) {
        if (value >= 0 && value <= std::numeric_limits<int>::max() && value == std::floor(value)) return static_cast<int>(value);
        if (errors_.empty()) fail(ErrorCode::out_of_range, no_vertex(decimal(value), of));
        return 0;
    }

    std::string no_vertex(const std::string& index, const char* of) const {
        std::uint64_t count = 0;
        for (const Element& element : elements_)
            if (element.name == "vertex") count = element.count;
        return "a" + std::string(of[0] == 'e' ? "n " : " ") + of + " names the vertex " + index + ", but the file has " +
               std::to_string(count) + ", counted from 0";
    }

    void check_indices() {
        const int count = count_of(mesh_.vertices);
        for (const std::vector<int>* corners : {&mesh_.corners, &mesh_.points})
            for (const int corner : *corners)
                if (corner >= count) return fail(ErrorCode::out_of_range, no_vertex(std::to_string(corner), "face"));
        for (const geometry::Edge& edge : mesh_.edges)
            for (const int end : edge)
                if (end >= count) return fail(ErrorCode::out_of_range, no_vertex(std::to_string(end), "edge"));
    }

    std::string_view bytes_, body_;
    std::string where_;
    int header_lines_ = 0, declarations_ = 0;
    Numbers::Order order_ = Numbers::Order::text;
    std::vector<Element> elements_;
    RawMesh mesh_;
    Errors errors_;
};

}  // namespace

Result<RawMesh> parse_ply(std::string_view bytes, const std::string& where) { return PlyParser(bytes, where).parse(); }

}  // namespace fettle::core::mesh_files
