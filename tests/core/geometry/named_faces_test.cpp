// SPDX-License-Identifier: MIT
#include "core/geometry/named_faces.hpp"

#include <catch2/catch.hpp>

#include "tests/support/box_mesh.hpp"

namespace fettle::core::geometry::named_faces_test {

namespace {

// Two triangles a side: below, above, front, back, left, right.
Mesh named_box() {
    Mesh box = tests::support::box_mesh(Vector3::Zero(), Vector3::Ones());
    box.face_names = {"", "rim end", "side 1", "side 2", "slot 1 2"};
    box.triangle_face = {1, 1, 1, 1, 0, 0, 2, 2, 3, 3, 4, 4};
    return box;
}

}  // namespace

TEST_CASE("faces are asked for by their names, copies by one name or by their own") {
    const Mesh box = named_box();
    CHECK(triangles_of_face(box, "rim end") == std::vector<int>{0, 1, 2, 3});
    CHECK(triangles_of_face(box, "side") == std::vector<int>{6, 7, 8, 9});
    CHECK(triangles_of_face(box, "side 2") == std::vector<int>{8, 9});
    CHECK(triangles_of_face(box, "slot 1") == std::vector<int>{10, 11});  // a copy of copies
    CHECK(triangles_of_face(box, "slot") == std::vector<int>{10, 11});
    CHECK(triangles_of_face(box, "rim").empty());  // which is not its end
    CHECK(triangles_of_face(tests::support::box_mesh(Vector3::Zero(), Vector3::Ones()), "side").empty());
    CHECK(names_of_faces(box) == std::vector<std::string>{"rim end", "side", "slot", "side 1", "side 2", "slot 1", "slot 1 2"});
}

TEST_CASE("some triangles of a mesh are a mesh of their own, and know what they are in the whole") {
    const Mesh box = named_box();
    const SubMesh right = sub_mesh(box, triangles_of_face(box, "slot"));
    CHECK(right.triangles == std::vector<int>{10, 11});
    REQUIRE(right.mesh.vertices.cols() == 4);
    CHECK((right.mesh.vertices.row(0).array() == 1).all());
    REQUIRE(right.mesh.edges.size() == 5);
    CHECK(right.mesh.codimensional_points.empty());
    for (std::size_t v = 0; v < right.vertices.size(); ++v)
        CHECK(right.mesh.vertices.col(static_cast<Eigen::Index>(v)) == box.vertices.col(right.vertices[v]));
    for (std::size_t e = 0; e < right.edges.size(); ++e) {
        const Edge whole = box.edges[right.edges[e]], own = right.mesh.edges[e];
        const int u = right.vertices[own[0]], v = right.vertices[own[1]];
        CHECK(((whole == Edge{u, v}) || (whole == Edge{v, u})));
    }
}

}  // namespace fettle::core::geometry::named_faces_test
