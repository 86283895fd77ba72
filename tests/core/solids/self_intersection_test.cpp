// SPDX-License-Identifier: MIT
#include "core/solids/self_intersection.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/base/parallel.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/simple_fan.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::solids::self_intersection_test {

namespace {

/// Do two triangles cross, taken alone? Those that share a vertex make no fan then, so that they are compared corner by corner.
bool cross(const geometry::Mesh& mesh, int t, int u) {
    geometry::Mesh two;
    two.vertices = mesh.vertices;
    two.triangles = {mesh.triangles[t], mesh.triangles[u]};
    return !self_intersections(two, 2).empty();
}

std::vector<std::pair<int, int>> by_brute_force(const geometry::Mesh& mesh) {
    std::vector<std::pair<int, int>> pairs;
    const int count = count_of(mesh.triangles);
    for (int t = 0; t < count; ++t)
        for (int u = t + 1; u < count; ++u)
            if (cross(mesh, t, u)) pairs.emplace_back(t, u);
    return pairs;
}

/// Shaken, and put on a grid: on a coarse one much is coplanar, collinear, without area or in one place.
geometry::Mesh shaken(geometry::Mesh mesh, double size, double grid, std::mt19937_64& random) {
    mesh.vertices += size * tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
    if (grid > 0) mesh.vertices = (mesh.vertices / grid).array().round().matrix() * grid;
    return mesh;
}

/// Vertex 0 in the middle, the others round it, `turns` times; heights and distances vary.
geometry::Mesh fan(int count, int turns, double steepness) {
    Matrix3X x(3, count + 1);
    x.col(0).setZero();
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * turns * i / count, radius = 1 + 0.1 * (i % 3);
        x.col(i + 1) << radius * std::cos(angle), radius * std::sin(angle), steepness * (i % 2 == 0 ? 1 : -1) - 0.3;
        triangles.push_back({0, i + 1, (i + 1) % count + 1});
    }
    return geometry::make_mesh("fan", x, triangles);
}

bool is_simple_at(const geometry::Mesh& mesh, int vertex) {
    const VertexCorners corners(mesh);
    return FanCheck(mesh, corners).is_simple(vertex);
}

}  // namespace

TEST_CASE("self-intersections are those of all pairs, one by one") {
    std::mt19937_64 random(2);
    std::size_t found = 0, meshes = 0;
    for (const double size : {0.0, 0.02, 0.1, 0.4}) {
        for (const double grid : {0.0, 0.05, 0.25}) {
            for (const geometry::Mesh& sound : {tests::torus_mesh(1, 0.4, 8), tests::ellipsoid_mesh({1, 0.7, 0.3}, 6)}) {
                const geometry::Mesh mesh = shaken(sound, size, grid, random);
                const auto expected = by_brute_force(mesh);
                CHECK(self_intersections(mesh, 1'000'000) == expected);
                found += expected.size();
                ++meshes;
            }
        }
    }
    CHECK(meshes == 24);
    CHECK(found > 500);
}

TEST_CASE("a list of self-intersections that is cut is the same for any number of threads") {
    std::mt19937_64 random(3);
    const geometry::Mesh mesh = shaken(tests::torus_mesh(1, 0.4, 40), 0.05, 0, random);
    const auto all = self_intersections(mesh, 1'000'000);
    REQUIRE(all.size() > 100);
    const auto count = count_of(all);
    for (const int most : {1, 7, count - 1, count, count + 1}) {
        const auto some = self_intersections(mesh, most);
        CHECK(count_of(some) == std::min(most, count));
        CHECK(std::includes(all.begin(), all.end(), some.begin(), some.end()));
        const base::ThreadLimit one(1);
        CHECK(self_intersections(mesh, most) == some);
    }
}

TEST_CASE("triangles without area are those with their corners on a line") {
    std::mt19937_64 random(4);
    const geometry::Mesh mesh = shaken(tests::torus_mesh(1, 0.4, 20), 0.1, 0.25, random);
    const std::vector<char> without = triangles_without_area(mesh);
    std::size_t count = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const geometry::Triangle& v = mesh.triangles[t];
        const bool degenerate = geometry::is_degenerate({mesh.vertices.col(v[0]), mesh.vertices.col(v[1]), mesh.vertices.col(v[2])});
        CHECK((without[t] != 0) == degenerate);
        count += degenerate ? 1 : 0;
    }
    CHECK(count > 10);
}

TEST_CASE("fans that close once are simple: of smooth and sharp solids, however many triangles they have") {
    const geometry::Mesh torus = tests::torus_mesh(1, 0.4, 20), box = tests::box_mesh({0, 0, 0}, {1, 2, 3});
    const VertexCorners of_torus(torus), of_box(box);
    FanCheck on_torus(torus, of_torus), on_box(box, of_box);
    for (int v = 0; v < torus.vertices.cols(); ++v) CHECK(on_torus.is_simple(v));
    for (int v = 0; v < box.vertices.cols(); ++v) CHECK(on_box.is_simple(v));
    for (const int count : {3, 5, 16, 17, 1000}) CHECK(is_simple_at(fan(count, 1, 0.2), 0));
}

TEST_CASE("fans that do not close, turn twice or fold over are not simple") {
    CHECK(!is_simple_at(fan(7, 2, 0.2), 0));
    CHECK(!is_simple_at(fan(50, 3, 0), 0));
    geometry::Mesh open = fan(8, 1, 0.1);
    open.triangles.pop_back();
    CHECK(!is_simple_at(open, 0));
    CHECK(!is_simple_at(open, 3));  // on the boundary
    geometry::Mesh two = fan(8, 1, 0.1);
    const auto more = two.triangles;
    two.triangles.insert(two.triangles.end(), more.begin(), more.end());
    CHECK(!is_simple_at(two, 0));
    geometry::Mesh folded = fan(8, 1, 0);
    folded.vertices.col(3) = 0.5 * folded.vertices.col(1) + 0.01 * Vector3::UnitZ();
    CHECK(!is_simple_at(folded, 0));
    geometry::Mesh flat = fan(8, 1, 0);
    flat.vertices.col(2) = 0.5 * flat.vertices.col(1);  // no area
    CHECK(!is_simple_at(flat, 0));
}

TEST_CASE("no two triangles of a simple fan cross") {
    std::mt19937_64 random(5);
    int simple = 0, other = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const geometry::Mesh mesh = shaken(fan(7, 1, 0.3), 0.1 * (trial % 12), trial % 3 == 0 ? 0.125 : 0, random);
        if (!is_simple_at(mesh, 0)) {
            ++other;
            continue;
        }
        ++simple;
        CHECK(by_brute_force(mesh).empty());
    }
    CHECK(simple > 10);
    CHECK(other > 10);
}

}  // namespace fettle::core::solids::self_intersection_test
