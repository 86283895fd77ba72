// SPDX-License-Identifier: MIT
// PLY in its three forms, and files that say what is not so.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::ply_parser_test {

using geometry::Mesh;
using tests::support::contains;

namespace {

const std::string vertex_xyz = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string ply(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\ncomment made here\nobj_info no object\n" + elements + "end_header\n";
}
std::string face_element(int count, const std::string& types = "uchar int", const std::string& name = "vertex_indices") {
    return "element face " + std::to_string(count) + "\nproperty list " + types + " " + name + "\n";
}

/// Numbers as the machine has them, or turned.
struct Bytes {
    std::string text;
    bool turned = false;
    template <class Value>
    void add(Value value) {
        std::string raw(sizeof value, '\0');
        std::memcpy(raw.data(), &value, sizeof value);
        if (turned) std::reverse(raw.begin(), raw.end());
        text += raw;
    }
};

struct Read {
    tests::support::TemporaryFolder folder;
    Result<Mesh> operator()(const std::string& text) const { return read_mesh(folder.write("a.ply", text), {0.5, true}); }
    std::string fault(const std::string& text) const {
        const auto mesh = (*this)(text);
        REQUIRE_FALSE(mesh);
        return mesh.errors().front().where.substr(folder.path.string().size() + 1) + ": " + mesh.errors().front().message;
    }
};

void check_tetrahedron(const Result<Mesh>& mesh) {
    REQUIRE(mesh);
    CHECK(mesh->vertices.cols() == 4);
    CHECK(solids::validate_mesh(*mesh, {}).empty());
    CHECK(geometry::solid_moments(mesh->vertices, mesh->triangles)(3, 3) == Approx(0.125 / 6).epsilon(1e-14));
}

}  // namespace

TEST_CASE("PLY: text, both byte orders, any types, elements in any order") {
    const Read read;
    check_tetrahedron(read(ply("ascii", vertex_xyz + face_element(4)) + corners + faces));
    // Wherever lines end, and with what does not belong to the shape between.
    std::string crooked = ply("ascii", face_element(4, "int32 uint", "vertex_index") +
                                           "element camera 2\nproperty list uchar float view\n" + vertex_xyz + "property uchar red\n") +
                          "3 0 2\n1 3 0 1 3 3 0 3 2 3 1 2 3\n2 7 8\n0 0 0\n0 255 1 0 0 254\n 0 1 0 0\t0 0 1 1\n";
    std::replace(crooked.begin(), crooked.end(), '\t', ' ');
    check_tetrahedron(read(crooked));
    std::string windows;
    for (const char c : ply("ascii", vertex_xyz + face_element(4)) + corners + faces)
        windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    check_tetrahedron(read(windows));

    const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int f[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (const bool big : {false, true}) {
        Bytes body{"", big};
        for (int v = 0; v < 4; ++v) {
            body.add(static_cast<std::uint16_t>(65535));
            body.add(x[v][0]);
            body.add(static_cast<std::int8_t>(x[v][1]));
            body.add(static_cast<float>(x[v][2]));
        }
        for (const auto& face : f) {
            body.add(static_cast<std::uint8_t>(3));
            for (const int corner : face) body.add(static_cast<std::uint32_t>(corner));
            body.add(0.5);
        }
        const std::string types = "element vertex 4\nproperty ushort quality\nproperty double x\nproperty char y\nproperty float32 z\n" +
                                  face_element(4, "uchar uint") + "property float64 area\n";
        check_tetrahedron(read(ply(big ? "binary_big_endian" : "binary_little_endian", types) + body.text));
    }
}

TEST_CASE("PLY: double precision, polygons, edges, and vertices alone are points") {
    const Read read;
    const auto fine = read(ply("ascii", "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + face_element(1)) +
                           "100.123456789 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    REQUIRE(fine);
    CHECK(fine->vertices.row(0).maxCoeff() == 100.123456789 * 0.5);
    const auto square = read(ply("ascii", vertex_xyz + face_element(3) + "element edge 1\nproperty int vertex1\nproperty int vertex2\n") +
                             "0 0 0\n1 0 0\n1 1 0\n0 1 1\n3 0 1 2\n2 0 3\n0\n1 3\n");
    REQUIRE(square);
    CHECK(square->triangles.size() == 1);
    CHECK(square->edges.size() == 5);
    CHECK(read(ply("ascii", vertex_xyz + face_element(1)) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")->triangles.size() == 2);
    CHECK(read(ply("ascii", vertex_xyz) + corners)->codimensional_points.size() == 4);
}

TEST_CASE("PLY: what a file says is checked before it is used") {
    const Read read;
    const std::string good = ply("ascii", vertex_xyz + face_element(4)) + corners;
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 4\n3 0 3 2\n3 1 2 3\n"), "names the vertex 4, but the file has 4, counted from 0"));
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 10000000\n3 0 3 2\n3 1 2 3\n"), "names the vertex 10000000, but the file has 4"));
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 -1\n3 0 3 2\n3 1 2 3\n"), "names the vertex -1"));
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 0.5\n3 0 3 2\n3 1 2 3\n"), "names the vertex 0.5"));
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 nan\n3 0 3 2\n3 1 2 3\n"), "names the vertex nan"));
    CHECK(contains(read.fault(good + "3 0 2 1\n3 0 1 3\n"), "a.ply:18: ends after 2 of the 4 elements `face`"));
    CHECK(contains(read.fault(good + "3 0 2 x\n3 0 1 3\n1 1\n1 1\n1 1\n"), "a.ply:16: `x` is not a number"));
    CHECK(contains(read.fault(good + "99999999 0 2 1\n 1 2 3 4 5 6 7 8\n"), "ends after 0 of the 4 elements `face`"));
    CHECK(contains(read.fault(good + "-3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"), "is not a whole number"));
    CHECK(contains(read.fault("ply\nformat ascii 1.0\n"), "a.ply:3: ends inside its header (there is no `end_header`)"));
    CHECK(contains(read.fault("ply"), "it is not a PLY file"));
    CHECK(contains(read.fault("ply\nend_header\n"), "no line `format`"));
    CHECK(contains(read.fault("ply\nformat ascii 2.0\nend_header\n"), "must be 1.0"));
    CHECK(contains(read.fault("ply\nformat middle_endian 1.0\nend_header\n"), "must be ascii, binary_little_endian"));
    CHECK(contains(read.fault(ply("ascii", face_element(0))), "has no element `vertex`"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + "element face 1\nproperty int vertex_indices\n") + corners + "1\n"),
                   "needs a list `vertex_indices`"));
    CHECK(contains(read.fault(ply("ascii", "element vertex 4\nproperty float x\nproperty float y\n") + corners),
                   "needs a single number `z`"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + "property float x\n") + corners), "stands twice"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + "property quad w\n") + corners), "a.ply:9: `quad` is not a type"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + "element nothing 2000000000\n") + corners), "has no property"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + face_element(2000000000)) + corners), "has no room for the 2000000000 elements"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + face_element(-1)) + corners), "with a count from 0"));
    CHECK(contains(read.fault(ply("binary_little_endian", vertex_xyz) + "short"), "has no room for the 4 elements `vertex`"));
    CHECK(contains(
        read.fault(ply("ascii", vertex_xyz + "element tristrips 1\nproperty list int int vertex_indices\n") + corners + "3 0 1 2\n"),
        "triangle strips, which are not read"));
    CHECK(contains(read.fault(ply("ascii", vertex_xyz + face_element(1, "float int")) + corners + "3 0 1 2\n"), "must be of a whole type"));
    const auto many = [](int count) {
        std::string text = vertex_xyz;
        for (int i = 0; i < count; ++i) text += "property char p" + std::to_string(i) + "\n";
        return ply("ascii", text);
    };
    CHECK(contains(read.fault(many(997)), "a.ply:1005: its header has more than 1000 elements and properties"));
    CHECK(contains(read.fault(many(996)), "has no room for the 4 elements `vertex`"));
    // A binary file cut anywhere is told as such, never read as another shape.
    Bytes body;
    for (int i = 0; i < 12; ++i) body.add(static_cast<float>(i * i % 7));
    body.add(static_cast<std::uint8_t>(3));
    for (const int corner : {0, 1, 2}) body.add(corner);
    const std::string whole = ply("binary_little_endian", vertex_xyz + face_element(1)) + body.text;
    REQUIRE(read(whole));
    for (std::size_t size = 0; size < whole.size(); ++size) REQUIRE_FALSE(read(whole.substr(0, size)));
}

}  // namespace fettle::core::mesh_files::ply_parser_test
