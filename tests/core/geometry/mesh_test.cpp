// SPDX-License-Identifier: MIT
#include "core/geometry/mesh.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "core/base/contract.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::mesh_test {

namespace {

/// Every triangle with its own three vertices, as an STL file has it.
Mesh soup_of(const Mesh& mesh) {
    Matrix3X v(3, 3 * count_of(mesh.triangles));
    std::vector<Triangle> triangles;
    for (const Triangle& t : mesh.triangles) {
        const int first = 3 * count_of(triangles);
        for (int k = 0; k < 3; ++k) v.col(first + k) = mesh.vertices.col(t[k]);
        triangles.push_back({first, first + 1, first + 2});
    }
    return make_mesh(mesh.name, v, triangles);
}

}  // namespace

TEST_CASE("edges of a box appear once, in the order of their first triangle") {
    const Mesh box = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    CHECK(box.edges.size() == 18);  // 12 edges and 6 diagonals
    CHECK(box.edges[0] == Edge{0, 2});
    CHECK(box.edges[1] == Edge{2, 3});
    CHECK(box.edges[2] == Edge{3, 0});
    CHECK(box.edges[3] == Edge{3, 1});
    CHECK(box.edges[4] == Edge{1, 0});
    std::set<std::set<int>> distinct;
    for (const Edge& edge : box.edges) distinct.insert({edge[0], edge[1]});
    CHECK(distinct.size() == 18);
    CHECK(box.codimensional_points.empty());
    CHECK(box.shell_names == std::vector<std::string>{"box/0"});
}

TEST_CASE("Euler characteristic of a torus") {
    const Mesh torus = tests::torus_mesh(2, 0.5, 20);
    CHECK(torus.vertices.cols() - count_of(torus.edges) + count_of(torus.triangles) == 0);
}

TEST_CASE("shells are edge-connected and numbered by first triangle") {
    // Triangles 0 and 2 share the edge 0-1, triangle 1 touches them in vertex 0 only, triangle 3 shares an edge with 1.
    Matrix3X v = Matrix3X::Zero(3, 7);
    Mesh mesh = make_mesh("m", v, {{0, 1, 2}, {0, 4, 5}, {1, 0, 3}, {5, 4, 6}});
    CHECK(mesh.triangle_shell == std::vector<int>{0, 1, 0, 1});
    CHECK(mesh.shell_names == std::vector<std::string>{"m/0", "m/1"});
    mesh.shell_names = {"left", "right"};
    build_connectivity(mesh);
    CHECK(mesh.shell_names == std::vector<std::string>{"left", "right"});
    mesh.shell_names = {"left"};
    build_connectivity(mesh);
    CHECK(mesh.shell_names == std::vector<std::string>{"m/0", "m/1"});
}

TEST_CASE("codimensional edges follow the triangles' edges, points are what no edge uses") {
    Mesh mesh;
    mesh.vertices = Matrix3X::Zero(3, 7);
    mesh.triangles = {{1, 2, 3}};
    build_connectivity(mesh, {{3, 2}, {3, 4}, {4, 3}, {5, 5}, {4, 6}});  // one of the triangle, one twice, one of length zero
    CHECK(mesh.edges == std::vector<Edge>{{1, 2}, {2, 3}, {3, 1}, {3, 4}, {4, 6}});
    CHECK(mesh.codimensional_points == std::vector<int>{0, 5});
}

TEST_CASE("connectivity of indices out of range does not crash") {
    Mesh mesh;
    mesh.vertices = Matrix3X::Zero(3, 3);
    mesh.triangles = {{0, 1, 9}, {-1, 0, 2}};
    CHECK_NOTHROW(build_connectivity(mesh));
    CHECK_THROWS_AS(weld_exactly(mesh), ContractError);
}

TEST_CASE("welding a triangle soup gives the mesh back") {
    const Mesh torus = tests::torus_mesh(2, 0.5, 12);
    const Mesh soup = soup_of(torus);
    REQUIRE(soup.vertices.cols() == 3 * 288);
    REQUIRE(soup.shell_names.size() == 288);
    const Mesh welded = weld_exactly(soup);
    CHECK(welded.vertices.cols() == torus.vertices.cols());
    CHECK(welded.edges.size() == torus.edges.size());
    CHECK(welded.triangles.size() == torus.triangles.size());
    CHECK(welded.shell_names == std::vector<std::string>{"torus/0"});
    for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) CHECK(welded.vertices.col(welded.triangles[t][k]) == torus.vertices.col(torus.triangles[t][k]));
    }
    // Order of first occurrence: a vertex is first used after all vertices of smaller index have been.
    int next = 0;
    for (const Triangle& t : welded.triangles) {
        for (const int vertex : t) {
            CHECK(vertex <= next);
            next = std::max(next, vertex + 1);
        }
    }
    const Mesh again = weld_exactly(welded);
    CHECK(again.vertices == welded.vertices);
    CHECK(again.triangles == welded.triangles);
    CHECK(again.edges == welded.edges);
}

TEST_CASE("welding: signed zeros, NaN, one ulp, degenerate triangles, codimensional parts") {
    const double one_up = std::nextafter(1.0, 2.0), nan = std::numeric_limits<double>::quiet_NaN();
    Mesh mesh;
    mesh.name = "m";
    mesh.vertices.resize(3, 9);
    //                 0  1  2     3  4   5       6    7    8
    mesh.vertices << 0, 1, 0, -0., 1, one_up, nan, nan, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, -0., 0, 0, 0, 0, 5;
    mesh.triangles = {{0, 1, 2}, {3, 4, 1}, {3, 4, 5}};
    build_connectivity(mesh, {{2, 4}, {2, 8}, {0, 3}});
    const Mesh welded = weld_exactly(mesh);
    CHECK(welded.vertices.cols() == 7);                                                        // 3 = 0, 4 = 1
    CHECK(welded.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}});                    // the middle one is degenerate by index
    CHECK(welded.edges == std::vector<Edge>{{0, 1}, {1, 2}, {2, 0}, {1, 3}, {3, 0}, {2, 6}});  // 2-4 is an edge of a triangle now
    CHECK(welded.codimensional_points == std::vector<int>{4, 5});                              // both NaN vertices
}

TEST_CASE("copies of a shape are found, other shapes are not") {
    Matrix3X x(3, 4);
    x << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    const std::vector<Triangle> faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const Mesh first = make_mesh("first", x, faces);
    Mesh negative_zero = first, moved = first, turned = first, wire = first;
    negative_zero.name = "another";
    negative_zero.vertices(2, 0) = -0.0;
    moved.vertices(0, 1) = std::nextafter(1.0, 2.0);
    turned.triangles[0] = {2, 1, 0};
    wire.triangles.clear();
    build_connectivity(wire, first.edges);
    const std::vector<std::size_t> found = first_of_shape({&first, &moved, &negative_zero, &turned, &wire, &moved, &first});
    CHECK(found == std::vector<std::size_t>{0, 1, 0, 3, 4, 1, 0});
    CHECK(first_of_shape({}).empty());
}

TEST_CASE("of large shapes a single vertex tells, wherever it is") {
    constexpr int count = 1000;
    Matrix3X x(3, count);
    std::vector<Triangle> faces;
    for (int i = 0; i < count; ++i) x.col(i) = Vector3(i, i % 7, i % 11);
    for (int i = 0; i + 2 < count; ++i) faces.push_back({i, i + 1, i + 2});
    const Mesh first = make_mesh("first", x, faces);
    std::vector<Mesh> others(200, first);
    for (int k = 0; k < 200; k += 2) others[k].vertices(1, 5 * k) += 1e-9;
    std::vector<const Mesh*> meshes{&first};
    std::vector<std::size_t> expected{0};
    for (std::size_t k = 0; k < others.size(); ++k) {
        meshes.push_back(&others[k]);
        expected.push_back(k % 2 == 0 ? k + 1 : 0);
    }
    meshes.push_back(&others[4]);
    expected.push_back(5);
    CHECK(first_of_shape(meshes) == expected);
}

}  // namespace fettle::core::geometry::mesh_test
