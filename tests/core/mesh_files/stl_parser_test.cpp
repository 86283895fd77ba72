// SPDX-License-Identifier: MIT
// STL: which of its two forms a file is, and what is said of a damaged one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>

#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::stl_parser_test {

using tests::support::contains;

namespace {

const std::string facet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1.123456789012 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

struct Read {
    tests::support::TemporaryFolder folder;
    Result<geometry::Mesh> operator()(const std::string& text) const { return read_mesh(folder.write("a.stl", text)); }
    std::string fault(const std::string& text) const {
        const auto mesh = (*this)(text);
        REQUIRE_FALSE(mesh);
        return mesh.errors().front().where.substr(folder.path.string().size() + 1) + ": " + mesh.errors().front().message;
    }
};

}  // namespace

TEST_CASE("STL: text in double precision, in any case, of several solids") {
    const Read read;
    const auto mesh =
        read("solid a lid # 3\n" + facet + "endsolid a lid # 3\nSOLID\n" +
             "FACET NORMAL nan nan -nan(ind)\nOUTER LOOP\nVERTEX 5 0 0\nvertex 6 0 0\nvertex 5 1 0\nENDLOOP\nENDFACET\nendsolid\n");
    REQUIRE(mesh);
    CHECK(mesh->triangles.size() == 2);
    CHECK(mesh->vertices(0, 1) == 1.123456789012);
    CHECK(mesh->shell_names == std::vector<std::string>{"a lid # 3", "a.stl/1"});
}

TEST_CASE("STL: a binary file is known by its size, whatever its header says") {
    const Read read;
    const geometry::Mesh box = tests::support::box_mesh(Vector3::Zero(), {0.01, 0.02, 0.03});
    std::string bytes = stl_bytes({{"box", &box}});
    REQUIRE(read(bytes));
    bytes.replace(0, 5, "solid");
    CHECK(read(bytes)->triangles.size() == 12);
    bytes.replace(6, 6, "facet ");
    CHECK(read(bytes)->triangles.size() == 12);
}

TEST_CASE("STL: what is cut short, damaged or something else is told as that") {
    const Read read;
    CHECK(contains(read.fault(""), "a.stl: is empty"));
    CHECK(contains(read.fault("solid a\n" + facet), "a.stl:9: ends without `endsolid`: the file is cut short"));
    CHECK(contains(read.fault("solid a\n" + facet.substr(0, 60)), "ends inside the facet that begins on line 2: the file is cut short"));
    CHECK(contains(read.fault("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"),
                   "a.stl:4: `zero` stands where a number is expected"));
    CHECK(contains(read.fault("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop\n"),
                   "`endloop` stands where `vertex` is expected"));
    CHECK(contains(read.fault("solid a\n" + facet + "hello\n"), "`hello` stands where `facet` or `endsolid` is expected"));
    CHECK(contains(read.fault("junk"), "is not an STL file, or is damaged"));
    CHECK(contains(read.fault("junk"), "its 4 bytes are fewer than the 84"));
    CHECK(contains(read.fault("solid of another kind of file\n"), "ends without `endsolid`"));
    CHECK(contains(read.fault("solid a\nendsolid a\n"), "has no vertices"));
    CHECK(contains(read.fault("solid of another kind of file"), "is not an STL file, or is damaged"));
    const geometry::Mesh box = tests::support::box_mesh(Vector3::Zero(), {0.01, 0.02, 0.03});
    const std::string bytes = stl_bytes({{"box", &box}});
    // A header that begins like a text, before numbers: without a line end, and with one that happens to be the last byte.
    std::string like_text = bytes;
    like_text.replace(0, 6, "solid ");
    std::replace(like_text.begin(), like_text.end(), '\n', '\v');
    CHECK(contains(read.fault(like_text.substr(0, 600)), "12 triangles in 684 bytes, this has 600 and may be cut short"));
    CHECK(contains(read.fault(like_text.substr(0, 599) + "\n"), "12 triangles in 684 bytes, this has 600 and may be cut short"));
    CHECK(contains(read.fault(bytes.substr(0, bytes.size() - 1)), "12 triangles in 684 bytes, this has 683 and may be cut short"));
    CHECK(contains(read.fault(bytes + "x"), "12 triangles in 684 bytes, this has 685"));
    std::string huge = bytes;
    huge.replace(80, 4, "\xff\xff\xff\xff");
    CHECK(contains(read.fault(huge), "4294967295 triangles in 214748364834 bytes"));
    for (std::size_t size = 0; size < bytes.size(); ++size) REQUIRE_FALSE(read(bytes.substr(0, size)));
}

}  // namespace fettle::core::mesh_files::stl_parser_test
