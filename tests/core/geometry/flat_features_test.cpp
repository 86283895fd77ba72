// SPDX-License-Identifier: MIT
#include "core/geometry/flat_features.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/test_models.hpp"

namespace fettle::core::geometry::flat_features_test {

namespace {

int flat_edges(const FlatFeatures& flat) { return static_cast<int>(std::count(flat.edge.begin(), flat.edge.end(), 1)); }

// The unit square, n x n cells of two triangles, its middle line raised.
Mesh sheet(int n, double ridge = 0) {
    Matrix3X x(3, (n + 1) * (n + 1));
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) x.col(i * (n + 1) + j) = Vector3(double(i) / n, double(j) / n, 2 * i == n ? ridge : 0.0);
    std::vector<Triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            triangles.push_back({a, b, b + 1});
            triangles.push_back({a, b + 1, a + 1});
        }
    return make_mesh("sheet", x, triangles);
}

}  // namespace

TEST_CASE("the diagonals of a box are flat, turned and rounded to single precision too", "[flat_features]") {
    Mesh box = tests::support::box_mesh(Vector3(0, 0, 0), Vector3(3, 1, 2));
    CHECK(flat_edges(flat_features(box, 0)) == 6);
    CHECK(flat_features(box, 0).height == 0);
    box.vertices = tests::support::make_pose(Vector3(0.3, -1.1, 0.7), Vector3::Zero()).rotation * box.vertices;
    box.vertices = box.vertices.cast<float>().cast<double>();
    CHECK(flat_edges(flat_features(box, 1e-6)) == 6);
    CHECK(flat_edges(flat_features(box, 1e-12)) < 6);
    const FlatFeatures flat = flat_features(box, 1e-6);
    for (std::size_t t = 0; t < box.triangles.size(); ++t) {
        const unsigned bits = flat.of_face(static_cast<int>(t));
        CHECK((bits == 1 || bits == 2 || bits == 4));  // its diagonal, no corner
    }
    CHECK(flat.of_face(12) == 0);
}

TEST_CASE("a sheet's border is not flat, its ridge neither", "[flat_features]") {
    const int n = 4;
    const FlatFeatures even = flat_features(sheet(n), 1e-12);
    CHECK(flat_edges(even) == n * n + 2 * n * (n - 1));
    int corners = 0;
    for (const std::uint8_t bits : even.face) corners += (bits >> 3 & 1) + (bits >> 4 & 1) + (bits >> 5 & 1);
    CHECK(corners == 6 * (n - 1) * (n - 1));  // six triangles round each inner vertex
    const double ridge = 1e-3;
    // Across each edge of the middle line, and of the strips beside it none: they are plane.
    CHECK(flat_edges(flat_features(sheet(n, ridge), 1e-6)) == n * n + 2 * n * (n - 1) - n - 2 * n);
    const FlatFeatures all = flat_features(sheet(n, ridge), 10 * ridge);
    CHECK(flat_edges(all) == n * n + 2 * n * (n - 1));
    CHECK(all.height >= ridge);
    CHECK(all.height <= 10 * ridge);
}

TEST_CASE("a facet keeps to one plane, however finely a surface is curved", "[flat_features]") {
    constexpr int sides = 720;
    const double turn = 2 * std::acos(-1.0) / sides;
    Matrix3X x(3, 2 * sides);
    std::vector<Triangle> triangles;
    for (int k = 0; k < sides; ++k) {
        x.col(2 * k) << std::cos(k * turn), std::sin(k * turn), -1;
        x.col(2 * k + 1) << std::cos(k * turn), std::sin(k * turn), 1;
        const int a = 2 * k, b = 2 * ((k + 1) % sides);
        triangles.push_back({a, b, b + 1});
        triangles.push_back({a, b + 1, a + 1});
    }
    // From edge to edge the tube bends by 8e-5; a facet may leave its plane by 1e-3, which is 0.045 rad.
    const FlatFeatures flat = flat_features(make_mesh("tube", x, triangles), 1e-3);
    CHECK(flat.height <= 1e-3);
    const int bends = sides * 2 - flat_edges(flat);  // diagonals and generators that are no ends are flat
    CHECK(bends >= 2 * std::acos(-1.0) / 0.1);
    CHECK(bends <= 2 * std::acos(-1.0) / 0.02);
}

TEST_CASE("a fold is not flat, nor an edge of three triangles", "[flat_features]") {
    Matrix3X x(3, 5);
    x << 0, 1, 0, 0.2, 0.1, 0, 0, 1, 0.7, -1, 0, 0, 0, 0, 0;
    CHECK_FALSE(flat_features(make_mesh("fold", x.leftCols(4), {{0, 1, 2}, {1, 0, 3}}), 1e-9).any());
    CHECK(flat_features(make_mesh("two", x, {{0, 1, 2}, {1, 0, 4}}), 1e-9).any());
    CHECK_FALSE(flat_features(make_mesh("three", x, {{0, 1, 2}, {1, 0, 4}, {0, 1, 3}}), 1e-9).any());
}

TEST_CASE("edges are plane where all lies on the plane but for the last digits, and nothing is a sliver", "[flat_features]") {
    const auto plane_edges = [](const FlatFeatures& flat) { return std::count(flat.plane_edge.begin(), flat.plane_edge.end(), 1); };
    Mesh box = tests::support::box_mesh(Vector3(0, 0, 0), Vector3(3, 1, 2));
    CHECK(plane_edges(flat_features(box, 1e-5)) == 6);
    box.vertices = tests::support::make_pose(Vector3(0.3, -1.1, 0.7), Vector3::Zero()).rotation * box.vertices;
    const FlatFeatures turned = flat_features(box, 1e-5);
    CHECK(plane_edges(turned) == 6);
    CHECK(turned.plane_height > 0);
    CHECK(turned.plane_height < 2e-14);
    box.vertices = box.vertices.cast<float>().cast<double>();
    const FlatFeatures rounded = flat_features(box, 1e-5);
    CHECK(flat_edges(rounded) == 6);
    CHECK(plane_edges(rounded) == 0);
    CHECK(rounded.height > 1e-9);
    // A corner of the square a little off it, and smaller triangles there: their three edges inside are flat, but not plane.
    Mesh bent = sheet(2);
    bent.vertices.col(8) = Vector3(0.9, 0.9, 1e-8);
    const FlatFeatures flat = flat_features(bent, 1e-5);
    CHECK(flat_edges(flat) == 8);
    CHECK(plane_edges(flat) == 5);
    CHECK(flat.plane_height < 1e-14);
    CHECK(flat.height > 0.99e-8);
    // The middle vertex 1e-12 from another: so wide are the triangles at both.
    Mesh sliver = sheet(2);
    sliver.vertices.col(4) = sliver.vertices.col(3) + Vector3(0, 1e-12, 0);
    CHECK(plane_edges(flat_features(sliver, 1e-5)) < flat_edges(flat_features(sliver, 1e-5)));
}

}  // namespace fettle::core::geometry::flat_features_test
