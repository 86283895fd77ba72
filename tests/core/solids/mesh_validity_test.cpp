// SPDX-License-Identifier: MIT
#include "core/solids/mesh_validity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::solids::mesh_validity_test {

namespace {

using Integer = boost::multiprecision::checked_int1024_t;
using IntegerVector = std::array<Integer, 3>;
using IntegerPolygon = std::vector<IntegerVector>;

IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
IntegerVector minus(const IntegerVector& a, const IntegerVector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Integer dot(const IntegerVector& a, const IntegerVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

bool separates(const IntegerVector& axis, const IntegerPolygon& a, const IntegerPolygon& b) {
    const auto range = [&](const IntegerPolygon& x) {
        std::array<Integer, 2> r{dot(axis, x[0]), dot(axis, x[0])};
        for (const auto& v : x) r = {std::min(r[0], dot(axis, v)), std::max(r[1], dot(axis, v))};
        return r;
    };
    const auto ra = range(a), rb = range(b);
    return ra[1] < rb[0] || rb[1] < ra[0];
}

/// Convex flat polygons in exact arithmetic by separating axes: normals, products of edges, and edge normals within each plane.
/// An oracle that shares nothing with the predicates under test.
bool polygons_intersect(const IntegerPolygon& a, const IntegerPolygon& b) {
    const auto edges = [](const IntegerPolygon& x) {
        std::vector<IntegerVector> result;
        for (std::size_t i = 0; i < x.size(); ++i) result.push_back(minus(x[(i + 1) % x.size()], x[i]));
        return result;
    };
    const auto ea = edges(a), eb = edges(b);
    const IntegerVector na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
    if (separates(na, a, b) || separates(nb, a, b)) return false;
    for (const auto& u : ea) {
        if (separates(cross(na, u), a, b)) return false;
        for (const auto& v : eb) {
            if (separates(cross(u, v), a, b)) return false;
        }
    }
    return std::none_of(eb.begin(), eb.end(), [&](const IntegerVector& v) { return separates(cross(nb, v), a, b); });
}

IntegerVector integer(const Vector3& x) {  // any value k / 2^30
    IntegerVector result;
    for (int i = 0; i < 3; ++i) result[i] = static_cast<long long>(std::ldexp(x(i), 30));
    return result;
}

std::array<Vector3, 3> random_triangle(std::mt19937_64& random, int kind) {
    std::uniform_int_distribution<int> grid(0, 3);
    std::uniform_real_distribution<double> uniform(0, 3);
    std::array<Vector3, 3> t;
    do {
        for (Vector3& v : t) {
            for (int i = 0; i < 3; ++i) v(i) = kind ? std::ldexp(std::floor(std::ldexp(uniform(random), 30)), -30) : grid(random);
            if (kind == 2) v(2) = 1;  // coplanar
        }
    } while (geometry::is_degenerate(t));
    return t;
}

bool mentions(const Errors& errors, const std::string& text) {
    return std::any_of(errors.begin(), errors.end(),
                       [&](const Error& e) { return (e.where + " " + e.message).find(text) != std::string::npos; });
}

geometry::Mesh without_triangle(geometry::Mesh mesh, int index) {
    mesh.triangles.erase(mesh.triangles.begin() + index);
    geometry::build_connectivity(mesh);
    return mesh;
}

const MeshRequirements strict;

}  // namespace

TEST_CASE("overlapping boxes: every pair once, as by brute force") {
    std::mt19937_64 random(1);
    std::vector<geometry::Box> boxes;
    for (int i = 0; i < 300; ++i) {
        const Matrix3X x = tests::random_matrix(2, random);
        const Vector3 half = 0.15 * x.col(1).cwiseAbs();
        boxes.push_back({x.col(0) - half, x.col(0) + half});
    }
    boxes.push_back(boxes[7]);
    std::vector<std::pair<int, int>> found, expected;
    geometry::visit_overlapping_pairs(boxes, [&](int i, int j) {
        found.emplace_back(i, j);
        return true;
    });
    for (int i = 0; i < 301; ++i) {
        for (int j = i + 1; j < 301; ++j) {
            if (boxes[i].overlaps(boxes[j])) expected.emplace_back(i, j);
        }
    }
    std::sort(found.begin(), found.end());
    CHECK(expected.size() > 100);
    CHECK(found == expected);
    int calls = 0;
    geometry::visit_overlapping_pairs(boxes, [&](int, int) { return ++calls < 3; });
    CHECK(calls == 3);
    geometry::visit_overlapping_pairs({}, [&](int, int) { return ++calls < 3; });
    CHECK(calls == 3);
}

TEST_CASE("triangles against separating axes in exact arithmetic") {
    std::mt19937_64 random(2);
    for (const int kind : {0, 1, 2}) {
        int hits = 0, wrong = 0;
        for (int i = 0; i < 1500; ++i) {
            const auto a = random_triangle(random, kind), b = random_triangle(random, kind);
            const bool expected =
                polygons_intersect({integer(a[0]), integer(a[1]), integer(a[2])}, {integer(b[0]), integer(b[1]), integer(b[2])});
            hits += expected;
            wrong += triangles_intersect(a, b) != expected || triangles_intersect({b[2], b[0], b[1]}, {a[1], a[0], a[2]}) != expected;
        }
        INFO("kind " << kind << ", " << hits << " of 1500 intersect");
        CHECK(wrong == 0);
        CHECK(hits > 100);
        CHECK(hits < 1400);
    }
}

TEST_CASE("triangles that touch intersect, one ulp apart they do not") {
    const double up = std::nextafter(0.1, 1.0);
    const std::array<Vector3, 3> a{Vector3(0, 0, 0.1), Vector3(1, 0, 0.1), Vector3(0, 1, 0.1)};
    CHECK(triangles_intersect(a, {Vector3(0.2, 0.2, 0.1), Vector3(0.2, 0.2, 1), Vector3(0.5, 0.2, 1)}));
    CHECK_FALSE(triangles_intersect(a, {Vector3(0.2, 0.2, up), Vector3(0.2, 0.2, 1), Vector3(0.5, 0.2, 1)}));
    CHECK(triangles_intersect(a, {Vector3(0.1, 0.1, 0.1), Vector3(0.2, 0.1, 0.1), Vector3(0.1, 0.2, 0.1)}));  // within, coplanar
    CHECK_FALSE(triangles_intersect(a, {Vector3(0, 0, up), Vector3(1, 0, up), Vector3(0, 1, up)}));
    CHECK(triangles_intersect(a, a));
}

TEST_CASE("triangles with a shared vertex: only what lies beyond it counts") {
    // Oracle: cut both triangles short of the shared vertex v = corner 0 at 2^-20 of their size, and ask the separating axes.
    std::mt19937_64 random(3);
    int hits = 0, wrong = 0, count = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto a = random_triangle(random, 0);
        auto b = random_triangle(random, i % 3 == 0 ? 2 : 0);
        b[0] = a[0];
        if (geometry::is_degenerate(b)) continue;
        ++count;
        const auto cut = [](const std::array<Vector3, 3>& t) {
            const Vector3 near1 = t[0] + 0x1p-20 * (t[1] - t[0]), near2 = t[0] + 0x1p-20 * (t[2] - t[0]);
            return IntegerPolygon{integer(near1), integer(t[1]), integer(t[2]), integer(near2)};
        };
        const bool expected = polygons_intersect(cut(a), cut(b));
        Matrix3X v(3, 5);
        v << a[0], a[1], a[2], b[1], b[2];
        const geometry::Mesh mesh = geometry::make_mesh("pair", v, {{1, 2, 0}, {3, 0, 4}});
        hits += expected;
        wrong += (self_intersections(mesh, 10).size() == 1) != expected;
    }
    INFO(hits << " of " << count);
    CHECK(wrong == 0);
    CHECK(hits > 100);
    CHECK(count - hits > 100);
}

TEST_CASE("triangles with a shared edge intersect only when folded onto each other") {
    const auto folded = [](const Vector3& apex) {
        Matrix3X v(3, 4);
        v << Vector3(0, 0, 0), Vector3(1, 0.5, 0.25), Vector3(0, 1, 0), apex;
        return self_intersections(geometry::make_mesh("fold", v, {{0, 1, 2}, {3, 1, 0}}), 10).size();
    };
    CHECK(folded({0.5, 0.25, 1}) == 0);
    CHECK(folded({1, -0.5, 0.25}) == 0);  // coplanar, on the other side
    CHECK(folded({1, 1.5, 0.25}) == 1);   // coplanar, on the same side
    CHECK(folded({1, 1.5, std::nextafter(0.25, 1.0)}) == 0);
    CHECK(folded({0, 1, 0}) == 1);  // the same triangle with an unwelded apex
    Matrix3X v(3, 3);
    v << 0, 1, 0, 0, 0, 1, 0, 0, 0;
    CHECK(self_intersections(geometry::make_mesh("twice", v, {{0, 1, 2}, {2, 1, 0}}), 10).size() == 1);
}

TEST_CASE("self-intersections of a mesh as by brute force over all pairs") {
    std::mt19937_64 random(4);
    geometry::Mesh mesh = tests::torus_mesh(1, 0.4, 8);
    mesh.vertices += 0.3 * tests::random_matrix(64, random);
    const auto pairs = self_intersections(mesh, 100000);
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < 128; ++i) {
        for (int j = i + 1; j < 128; ++j) {
            geometry::Mesh two = mesh;
            two.triangles = {mesh.triangles[i], mesh.triangles[j]};
            if (!self_intersections(two, 1).empty()) expected.emplace_back(i, j);
        }
    }
    CHECK(pairs == expected);
    CHECK(pairs.size() > 20);
    CHECK(self_intersections(mesh, 7).size() == 7);
    CHECK(self_intersections(mesh, 0).empty());
}

TEST_CASE("valid solids have no faults") {
    CHECK(validate_mesh(tests::box_mesh({0, 0, 0}, {1, 1, 1}), strict).empty());
    CHECK(validate_mesh(tests::torus_mesh(1, 0.3, 12), strict).empty());
    CHECK(validate_mesh(tests::ellipsoid_mesh({1, 2, 3}, 6), strict).empty());
    CHECK(is_closed(tests::torus_mesh(1, 0.3, 12)));
    CHECK_FALSE(is_closed(geometry::Mesh{}));
}

TEST_CASE("open, inconsistently oriented and non-manifold edges") {
    const geometry::Mesh box = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    const geometry::Mesh open = without_triangle(box, 5);
    CHECK_FALSE(is_closed(open));
    const Errors open_errors = validate_mesh(open, strict);
    CHECK(open_errors.size() == 3);
    CHECK(mentions(open_errors, "the surface is open"));
    CHECK(open_errors[0].where.substr(0, 14) == "box: triangle ");
    CHECK(validate_mesh(open, {false, true}).empty());

    geometry::Mesh turned = box;
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    geometry::build_connectivity(turned);
    CHECK_FALSE(is_closed(turned));
    CHECK(mentions(validate_mesh(turned, strict), "is turned over"));

    // Two boxes that touch in an edge: that edge has four triangles.
    const geometry::Mesh touching = geometry::weld_exactly(tests::joined(box, tests::box_mesh({1, 1, 0}, {2, 2, 1})));
    CHECK_FALSE(is_closed(touching));
    CHECK(mentions(validate_mesh(touching, strict), "is shared with 3 triangles"));

    CHECK(mentions(validate_mesh(geometry::make_mesh("none", Matrix3X(3, 0), {}), strict), "has no triangles"));
    geometry::Mesh loose = box;
    loose.vertices.conservativeResize(3, 10);
    loose.vertices.rightCols(2) << 5, 6, 5, 5, 5, 5;
    geometry::build_connectivity(loose, {{0, 8}});
    CHECK(mentions(validate_mesh(loose, strict), "edge 18 from (0, 0, 0) mm to (5000, 5000, 5000) mm belongs to no triangle"));
    CHECK(mentions(validate_mesh(loose, strict), "vertex 9 at (6000, 5000, 5000) mm belongs to no triangle"));
    CHECK(validate_mesh(loose, {false, true}).empty());
}

TEST_CASE("inside-out solids, cavities, solids within solids") {
    const geometry::Mesh outer = tests::box_mesh({0, 0, 0}, {5, 5, 5}), inner = tests::box_mesh({1, 1, 1}, {4, 4, 4}),
                         core = tests::box_mesh({2, 2, 2}, {3, 3, 3}), apart = tests::box_mesh({7, 7, 7}, {8, 8, 8});
    CHECK(mentions(validate_mesh(tests::inside_out(outer), strict), "is inside out"));
    CHECK(mentions(validate_mesh(tests::inside_out(outer), {true, false}), "not positive"));
    CHECK(validate_mesh(tests::joined(outer, tests::inside_out(inner)), strict).empty());
    CHECK(validate_mesh(tests::joined(tests::joined(outer, tests::inside_out(inner)), core), strict).empty());
    CHECK(validate_mesh(tests::joined(outer, apart), strict).empty());
    const Errors alone = validate_mesh(tests::joined(outer, tests::inside_out(apart)), strict);
    REQUIRE(alone.size() == 1);
    CHECK(mentions(alone, "shell \"joined/1\" is inside out"));
    CHECK(mentions(validate_mesh(tests::joined(outer, inner), strict), "is a solid inside the solid \"joined/0\""));
    CHECK(mentions(validate_mesh(tests::joined(tests::inside_out(outer), inner), strict), "shell \"joined/0\" is inside out"));
}

TEST_CASE("numbers that are no numbers, indices out of range, triangles without area") {
    geometry::Mesh mesh = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    mesh.vertices(1, 3) = std::numeric_limits<double>::quiet_NaN();
    mesh.vertices(0, 5) = std::numeric_limits<double>::infinity();
    const Errors not_finite = validate_mesh(mesh, strict);
    CHECK(not_finite.size() == 2);
    CHECK(not_finite[0].code == ErrorCode::not_finite);
    CHECK(not_finite[0].where == "box: vertex 3");

    mesh = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    mesh.triangles[2][1] = 8;
    mesh.triangles[7][0] = -1;
    const Errors range = validate_mesh(mesh, strict);
    CHECK(mentions(range, "triangle 2 vertex indices"));
    CHECK(mentions(range, "must be in 0 to 7"));
    CHECK_FALSE(is_closed(mesh));

    // A vertex in the middle of an edge, joined by a triangle without area: closed, but not sound. (Across the flat triangle the neighbours
    // touch, which is reported as well when asked for.)
    mesh = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    mesh.vertices.conservativeResize(3, 9);
    mesh.vertices.col(8) << 0.5, 0, 0;
    mesh.triangles[1] = {8, 3, 1};
    mesh.triangles.push_back({0, 3, 8});
    mesh.triangles.push_back({0, 8, 1});
    geometry::build_connectivity(mesh);
    CHECK(is_closed(mesh));
    CHECK(validate_mesh(mesh, strict).size() == 3);
    const Errors flat = validate_mesh(mesh, {true, false});
    REQUIRE(flat.size() == 1);
    CHECK(flat[0].where == "box: triangle 13");
    CHECK(mentions(flat, "has no area"));
}

TEST_CASE("self-intersection is reported with both triangles and the place, long lists are cut") {
    const geometry::Mesh cross = tests::joined(tests::box_mesh({-2, -1, -1}, {2, 1, 1}), tests::box_mesh({-1, -2, -0.5}, {1, 2, 0.5}));
    const Errors errors = validate_mesh(cross, strict, 3);
    REQUIRE(errors.size() == 4);
    CHECK(errors[0].code == ErrorCode::mesh_invalid);
    CHECK(mentions(errors, "intersects triangle"));
    CHECK(mentions(errors, "more pairs of intersecting triangles"));
    CHECK(validate_mesh(cross, {true, false}).empty());
    geometry::Mesh soup;
    soup.name = "soup";
    soup.vertices = Matrix3X::Random(3, 60);
    for (int i = 0; i < 20; ++i) soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    geometry::build_connectivity(soup);
    CHECK(mentions(validate_mesh(soup, strict, 4), "and 56 more edges"));
}

TEST_CASE("point in solid: rays through vertices, edges and coplanar faces") {
    // Grid points against a box and a torus-like frame whose coordinates are on the same grid: every ray is degenerate.
    const geometry::Mesh box = tests::box_mesh({1, 1, 1}, {3, 3, 3});
    const geometry::Mesh shell = tests::joined(tests::box_mesh({0, 0, 0}, {4, 4, 4}), tests::inside_out(box));
    for (int i = -2; i <= 10; ++i) {
        for (int j = -2; j <= 10; ++j) {
            for (int k = -2; k <= 10; ++k) {
                const Vector3 x(i / 2.0, j / 2.0, k / 2.0);
                const bool in_box = x.minCoeff() > 1 && x.maxCoeff() < 3;
                const bool in_cavity = x.minCoeff() >= 1 && x.maxCoeff() <= 3, in_outer = x.minCoeff() > 0 && x.maxCoeff() < 4;
                if (point_in_solid(x, box.vertices, box.triangles) != in_box ||
                    point_in_solid(x, shell.vertices, shell.triangles) != (in_outer && !in_cavity)) {
                    FAIL_CHECK("wrong at " << x.transpose());
                }
            }
        }
    }
    CHECK_FALSE(point_in_solid({std::nextafter(1.0, 0.0), 2, 2}, box.vertices, box.triangles));
    CHECK(point_in_solid({std::nextafter(1.0, 2.0), 2, 2}, box.vertices, box.triangles));
}

TEST_CASE("point in solid agrees with the winding angle") {
    std::mt19937_64 random(5);
    geometry::Mesh torus = tests::torus_mesh(1, 0.4, 9);
    torus.vertices += 0.05 * tests::random_matrix(81, random);
    int inside_count = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vector3 p = 1.4 * tests::random_matrix(1, random).col(0).cwiseProduct(Vector3(1, 1, 0.4));
        double angle = 0;  // solid angle after van Oosterom and Strackee
        for (const geometry::Triangle& t : torus.triangles) {
            const Vector3 a = torus.vertices.col(t[0]) - p, b = torus.vertices.col(t[1]) - p, c = torus.vertices.col(t[2]) - p;
            angle += 2 * std::atan2(a.dot(b.cross(c)),
                                    a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm());
        }
        const bool inside = angle > 2 * M_PI;
        inside_count += inside;
        CHECK(point_in_solid(p, torus.vertices, torus.triangles) == inside);
    }
    CHECK(inside_count > 500);
}

TEST_CASE("validity of fifty thousand triangles", "[slow]") {
    const geometry::Mesh sphere = tests::ellipsoid_mesh({1, 1, 2}, 112);
    REQUIRE(sphere.triangles.size() > 49000);
    CHECK(validate_mesh(sphere, strict).empty());
}

}  // namespace fettle::core::solids::mesh_validity_test
