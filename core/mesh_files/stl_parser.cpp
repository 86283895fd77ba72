// SPDX-License-Identifier: MIT
// STL, binary (80 bytes, the number of triangles, 50 bytes each, little-endian floats) and text (`solid NAME`, facets, `endsolid`).
// Normals and attributes are passed over: the order of the corners says the same as a normal.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/files/text_lines.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

static_assert(std::endian::native == std::endian::little, "numbers of binary STL are taken as they stand");

std::string in_lower_case(std::string_view word) {
    std::string out(word);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

void add_triangle(RawMesh& mesh, int group) {
    const int count = count_of(mesh.vertices);
    mesh.corners.insert(mesh.corners.end(), {count - 3, count - 2, count - 1});
    mesh.polygon_ends.push_back(count);
    mesh.polygon_group.push_back(group);
}

RawMesh binary_mesh(std::string_view bytes, std::size_t count) {
    RawMesh mesh;
    mesh.vertices.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t corner = 1; corner <= 3; ++corner) {  // after the normal
            float x[3];
            std::memcpy(x, bytes.data() + header_size + facet_size * i + sizeof x * corner, sizeof x);
            mesh.vertices.emplace_back(x[0], x[1], x[2]);
        }
        add_triangle(mesh, -1);
    }
    return mesh;
}

class TextParser {
public:
    TextParser(std::string_view text, const std::string& where) : words_(text), where_(where) {}

    Result<RawMesh> parse() {
        bool in_solid = false;
        std::string word;
        while (errors_.empty() && !(word = in_lower_case(words_.next())).empty()) {
            if (!in_solid && word == "solid") {
                start_solid();
                in_solid = true;
            } else if (in_solid && word == "facet") {
                parse_facet();
            } else if (in_solid && word == "endsolid") {
                words_.rest_of_line();
                in_solid = false;
            } else {
                fail("`" + word.substr(0, 20) + "` stands where " + (in_solid ? "`facet` or `endsolid`" : "`solid`") + " is expected");
            }
        }
        if (in_solid && errors_.empty()) fail("ends without `endsolid`: the file is cut short; export or download it again");
        if (!errors_.empty()) return errors_;
        return std::move(mesh_);
    }

private:
    void start_solid() {
        group_ = -1;
        const std::string_view name = words_.rest_of_line();
        if (name.empty()) return;
        group_ = count_of(mesh_.groups);
        mesh_.groups.emplace_back(name);
    }

    /// normal, three numbers, outer loop, three times vertex and three numbers, endloop, endfacet.
    void parse_facet() {
        const int line = words_.line_number();
        const auto expect = [&](std::string_view wanted) {
            if (!errors_.empty()) return;
            const std::string_view word = words_.next();
            if (in_lower_case(word) != wanted) fail_in_facet(line, word, "`" + std::string(wanted) + "`");
        };
        const auto number = [&](bool of_normal) {
            if (!errors_.empty()) return 0.0;
            const std::string_view word = words_.next();
            const auto value = files::parsed_number(word);
            // Some programs write what is no number as the normal of a triangle without area.
            if (!value && (word.empty() || !of_normal)) fail_in_facet(line, word, "a number");
            return value.value_or(0);
        };
        expect("normal");
        for (int i = 0; i < 3; ++i) number(true);
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const double x = number(false), y = number(false), z = number(false);
            mesh_.vertices.emplace_back(x, y, z);
        }
        expect("endloop");
        expect("endfacet");
        if (errors_.empty()) add_triangle(mesh_, group_);
    }

    void fail_in_facet(int line, std::string_view found, const std::string& wanted) {
        if (found.empty())
            return fail("ends inside the facet that begins on line " + std::to_string(line) +
                        ": the file is cut short; export or download it again");
        fail("`" + std::string(found.substr(0, 20)) + "` stands where " + wanted + " is expected, in a facet");
    }

    void fail(const std::string& message) {
        errors_.push_back({ErrorCode::parse, where_ + ":" + std::to_string(words_.line_number()), message});
    }

    files::TextWords words_;
    std::string where_;
    RawMesh mesh_;
    Errors errors_;
    int group_ = -1;
};

/// `solid`, and `facet` or `endsolid` soon after: headers of binary files may begin with the first alone. A file that ends before the
/// second is text if its first line is one: it ends, and has none of the bytes that only binary files have.
bool is_text(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 1 << 16);
    files::TextWords words(start);
    const std::string_view first = words.next();
    if (in_lower_case(first) != "solid") return false;
    words.rest_of_line();
    const std::string second = in_lower_case(words.next());
    if (!second.empty()) return second == "facet" || second == "endsolid";
    const std::string_view line = start.substr(static_cast<std::size_t>(first.data() - start.data()));
    const std::size_t end = line.find('\n');
    return end != std::string_view::npos &&
           std::none_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(end), [](unsigned char c) { return c < '\t'; });
}

}  // namespace

Result<RawMesh> parse_stl(std::string_view bytes, const std::string& where) {
    if (bytes.empty()) return Error{ErrorCode::parse, where, "is empty; export or download it again"};
    std::uint32_t count = 0;
    if (bytes.size() >= header_size) {
        std::memcpy(&count, bytes.data() + header_size - sizeof count, sizeof count);
        if (bytes.size() == header_size + facet_size * count) return binary_mesh(bytes, count);
    }
    if (is_text(bytes)) return TextParser(bytes, where).parse();
    const std::string neither = "is not an STL file, or is damaged: it has no text that begins with `solid` and goes on with `facet`, and ";
    if (bytes.size() < header_size)
        return Error{ErrorCode::parse, where,
                     neither + "its " + std::to_string(bytes.size()) + " bytes are fewer than the 84 that a binary one begins with; " +
                         "export or download it again"};
    return Error{ErrorCode::parse, where,
                 neither + "a binary one that begins so has " + std::to_string(count) + " triangles in " +
                     std::to_string(header_size + facet_size * count) + " bytes, this has " + std::to_string(bytes.size()) +
                     (bytes.size() < header_size + facet_size * count ? " and may be cut short" : "") + "; export or download it again"};
}

}  // namespace fettle::core::mesh_files
