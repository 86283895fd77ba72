// SPDX-License-Identifier: MIT
#include "core/parts/common_part.hpp"

#include <catch2/catch.hpp>

#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::parts::common_part_test {

using tests::box_mesh;

namespace {

// A prism over a polygon that is seen whole from its first corner.
geometry::Mesh upright(const std::vector<Vector2>& corners, double low, double high) {
    const int n = count_of(corners);
    Matrix3X vertices(3, 2 * n);
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        vertices.col(i) << corners[i], low;
        vertices.col(n + i) << corners[i], high;
        const int next = (i + 1) % n;
        triangles.push_back({i, next, n + next});
        triangles.push_back({i, n + next, n + i});
        if (i < 1 || next == 0) continue;
        triangles.push_back({0, next, i});
        triangles.push_back({n, n + i, n + next});
    }
    return geometry::make_mesh("upright", vertices, triangles);
}

}  // namespace

TEST_CASE("What two boxes have in common is a box, by its volume and area", "[parts]") {
    if (!can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const auto a = box_mesh({0, 0, 0}, {1, 1, 1});
    const auto common = common_part(a, box_mesh({0.75, 0.5, -1}, {2, 3, 0.25}));
    REQUIRE(common);
    CHECK(common->volume() == Approx(0.25 * 0.5 * 0.25).epsilon(1e-14));
    CHECK(common->area() == Approx(2 * (0.25 * 0.5 + 0.5 * 0.25 + 0.25 * 0.25)).epsilon(1e-14));
    CHECK(common->moved == 0);
    Vector3 closed = Vector3::Zero();
    for (const CutTriangle& t : common->triangles) closed += common->area_of(t);
    CHECK(closed.norm() < 1e-15);
    // Flush faces, one within the other, nothing in common, faces that lie on each other.
    CHECK(common_part(a, box_mesh({0.9, 0, 0}, {2, 1, 1}))->volume() == Approx(0.1).epsilon(1e-14));
    CHECK(common_part(a, box_mesh({0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}))->volume() == Approx(1e-3).epsilon(1e-12));
    CHECK(common_part(a, box_mesh({2, 0, 0}, {3, 1, 1}))->volume() == 0);
    CHECK(common_part(a, box_mesh({1, 0, 0}, {2, 1, 1}))->volume() < 1e-8);
}

TEST_CASE("What hangs together is one piece", "[parts]") {
    if (!can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const auto two = tests::joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({2, 0, 0}, {3, 1, 1}));
    const auto common = common_part(two, box_mesh({0.5, 0.5, 0.5}, {2.25, 4, 4}));
    REQUIRE(common);
    const auto pieces = pieces_of(*common);
    REQUIRE(pieces.size() == 2);
    CHECK(pieces[0].points.size() + pieces[1].points.size() == common->points.size());
    CHECK(pieces[0].volume() + pieces[1].volume() == Approx(0.125 + 0.0625).epsilon(1e-14));
}

TEST_CASE("Where what they share touches itself along an edge, one is moved by a billionth", "[parts]") {
    if (!can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    // An L, and a wedge whose long face goes through the edge in its corner.
    const auto angle = upright({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1);
    const auto wedge = upright({{2.5, -0.5}, {3, 3}, {-0.5, 2.5}}, 0.25, 0.75);
    const auto common = common_part(angle, wedge);
    REQUIRE(common);
    CHECK(common->moved > 0);
    CHECK(common->moved < 1e-8);
    CHECK(common->volume() == Approx(0.5).epsilon(1e-7));
}

TEST_CASE("What is no solid has no common part", "[parts]") {
    auto open = box_mesh({0, 0, 0}, {1, 1, 1});
    open.triangles.pop_back();
    core::geometry::build_connectivity(open);
    CHECK(!common_part(open, box_mesh({0.5, 0, 0}, {2, 1, 1})));
    CHECK(!common_part(box_mesh({0.5, 0, 0}, {2, 1, 1}), open));
    CHECK(!common_part(tests::inside_out(box_mesh({0, 0, 0}, {1, 1, 1})), box_mesh({0.5, 0, 0}, {2, 1, 1})));
}

}  // namespace fettle::core::parts::common_part_test
