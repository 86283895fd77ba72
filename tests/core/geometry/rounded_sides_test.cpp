// SPDX-License-Identifier: MIT
#include "core/geometry/rounded_sides.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "core/parts/extrude.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/core/parts/part_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::geometry::rounded_sides_test {

using std::numbers::pi;

namespace {

using Corners = std::array<Vector3, 3>;

Corners columns(const Matrix3X& m) { return {m.col(0), m.col(1), m.col(2)}; }

VectorX as_vector(const RoundedCorner& r) {
    VectorX out(5);
    out << r.centre, r.radius, r.height;
    return out;
}

Corners as_corners(const VectorX& x) { return {x.segment<3>(0), x.segment<3>(3), x.segment<3>(6)}; }

VectorX rounded(const VectorX& x) {
    const Corners p = as_corners(x);
    return as_vector(rounded_corner(p[0], p[1], p[2]));
}

MatrixX jacobian(const VectorX& x) {
    MatrixX out(5, 9);
    for (int k = 0; k < 9; ++k) out.col(k) = as_vector(rounded_corner_tangent(as_corners(x), as_corners(VectorX::Unit(9, k))));
    return out;
}

// The body between z = low and z = high over the polygon's triangles (its sides are the polygon's edges), the walls cut along the height
// into `floors`.
Mesh prism(const std::vector<Vector2>& outline, double low, double high, int floors = 1) {
    const int n = count_of(outline);
    Matrix3X v(3, n * (floors + 1));
    for (int f = 0; f <= floors; ++f)
        for (int k = 0; k < n; ++k) v.col(f * n + k) << outline[k], low + (high - low) * f / floors;
    std::vector<Triangle> triangles;
    for (int f = 0; f < floors; ++f)
        for (int k = 0; k < n; ++k) {
            const int a = f * n + k, b = f * n + (k + 1) % n;
            if ((k + f) % 2 == 0) {
                triangles.push_back({a, b, b + n});
                triangles.push_back({a, b + n, a + n});
            } else {
                triangles.push_back({a, b, a + n});
                triangles.push_back({b, b + n, a + n});
            }
        }
    for (int k = 1; k + 1 < n; ++k) {  // convex, or seen whole from its first corner
        triangles.push_back({0, k + 1, k});
        triangles.push_back({floors * n, floors * n + k, floors * n + k + 1});
    }
    return make_mesh("prism", v, triangles);
}

std::vector<Vector2> regular(int n, double radius) {
    std::vector<Vector2> out;
    for (int k = 0; k < n; ++k) out.emplace_back(radius * std::cos(2 * pi * k / n), radius * std::sin(2 * pi * k / n));
    return out;
}

std::map<CornerKind, int> kinds(const RoundedSide& side) {
    std::map<CornerKind, int> out;
    for (const auto& corner : side.corners) ++out[corner.kind];
    return out;
}

bool is_along(const RoundedSide& side, const Vector3& axis) { return side.axis.cross(axis).norm() < 1e-8; }

std::vector<RoundedSide> along(const RoundedSides& all, const Vector3& axis) {
    std::vector<RoundedSide> out;
    for (const auto& side : all.sides)
        if (is_along(side, axis)) out.push_back(side);
    return out;
}

// What the header says of every result.
void check(const Mesh& mesh, const RoundedSides& found) {
    const double size = (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm(), near = 1e-8 * size;
    const auto at = [&](int v) { return Vector3(mesh.vertices.col(v)); };
    const auto normal = [&](int t) {
        const Triangle& c = mesh.triangles[t];
        return Vector3((at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).normalized());
    };
    REQUIRE(found.of_vertex.size() == static_cast<std::size_t>(mesh.vertices.cols()));
    REQUIRE(found.of_triangle.size() == mesh.triangles.size());
    REQUIRE(found.of_edge.size() == mesh.edges.size());
    double worst = 0;
    int wrong = 0;
    std::map<std::pair<int, int>, Vector3> normal_of;
    for (std::size_t s = 0; s < found.sides.size(); ++s) {
        const RoundedSide& side = found.sides[s];
        const int n = count_of(side.corners);
        CHECK(std::abs(side.axis.norm() - 1) < 1e-14);
        CHECK(n >= (side.closed ? 3 : 2));
        for (int i = 0; i < 3; ++i)
            if (std::abs(side.axis[i]) > 1e-9) {
                CHECK(side.axis[i] > 0);
                break;
            }
        for (int k = 0; k < n; ++k) {
            const auto& corner = side.corners[k];
            for (int end = 0; end < 2; ++end) {
                worst = std::max(worst, std::abs(side.axis.dot(at(corner.rim[end])) - side.ends[end]));
                const auto& places = found.of_vertex[corner.rim[end]];
                wrong += std::none_of(places.begin(), places.end(), [&](auto p) { return p.side == int(s) && p.at == k; });
            }
            const Vector3 line = at(corner.rim[1]) - at(corner.rim[0]);
            worst = std::max(worst, line.cross(side.axis).norm());
            wrong += !(line.dot(side.axis) > 0);
        }
        CHECK(side.ends[1] > side.ends[0]);
        for (int k = 0; k < side.rectangles(); ++k) {
            const Vector3 way = at(side.corners[(k + 1) % n].rim[0]) - at(side.corners[k].rim[0]);
            normal_of[{int(s), k}] = way.cross(side.axis).normalized();
        }
        for (int k = side.closed ? 0 : 1; k < (side.closed ? n : n - 1); ++k) {
            const Vector3 before = normal_of[{int(s), (k + n - 1) % n}], after = normal_of[{int(s), k}];
            const double turn = std::atan2(before.cross(after).dot(side.axis), before.dot(after));
            const bool is_convex = side.corners[k].kind == CornerKind::convex_edge || side.corners[k].kind == CornerKind::convex_round;
            const bool is_round = side.corners[k].kind == CornerKind::convex_round || side.corners[k].kind == CornerKind::concave_round;
            if (side.corners[k].kind == CornerKind::none)
                wrong += !(std::abs(turn) < 2e-6);
            else
                wrong += is_convex != (turn > 0) || is_round != (std::abs(turn) <= largest_smooth_turn);
        }
    }
    CHECK(worst < near);
    CHECK(wrong == 0);
    int bad_triangles = 0, bad_edges = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto place = found.of_triangle[t];
        if (place.side < 0) continue;
        const RoundedSide& side = found.sides[place.side];
        const Vector3 outward = normal_of.at({place.side, place.at});
        const Vector3 on = at(side.corners[place.at].rim[0]);
        bad_triangles += !((normal(int(t)) - outward).norm() < 1e-6 && std::abs(outward.dot(at(mesh.triangles[t][0]) - on)) < near);
    }
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        for (const auto place : found.of_edge[e]) {
            const RoundedSide& side = found.sides[place.side];
            const int k = place.at;
            const bool has_rectangle = k < side.rectangles();
            bool is_on_line = true, is_on_plane = has_rectangle;
            for (const int v : mesh.edges[e]) {
                const Vector3 from = at(v) - at(side.corners[k].rim[0]);
                is_on_line = is_on_line && from.cross(side.axis).norm() < near;
                is_on_plane = is_on_plane && std::abs(normal_of[{place.side, k}].dot(from)) < near;
            }
            bad_edges += !(is_on_line || is_on_plane);
        }
    CHECK(bad_triangles == 0);
    CHECK(bad_edges == 0);
}

RoundedSides checked(const Mesh& mesh) {
    RoundedSides found = rounded_sides(mesh);
    check(mesh, found);
    return found;
}

Mesh drawn(const parts::part_check::PartFunction& part, const parts::Facets& facets = {}) {
    const auto made = parts::part_check::draw(part, {}, facets);
    INFO(parts::part_check::told(made.errors()));
    REQUIRE(made);
    return made->mesh;
}

parts::Point2 point(double x, double y) { return {x, y}; }

std::string spelled(const RoundedSide& side) {
    std::string out;
    for (const auto& corner : side.corners) out += "EeRr-"[static_cast<int>(corner.kind)];
    return out;
}

}  // namespace

TEST_CASE("a rounded corner's circle touches both edges, at one distance from the corner") {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto [a, b, c] = columns(tests::random_matrix(3, random));
        const RoundedCorner r = rounded_corner(a, b, c);
        const Vector3 t1 = (b - a).normalized(), t2 = (c - b).normalized();
        const double tau = std::min((b - a).norm(), (c - b).norm()) / 2;
        CHECK((r.centre - (b - tau * t1)).dot(t1) == Approx(0).margin(1e-12 * r.radius));
        CHECK((r.centre - (b + tau * t2)).dot(t2) == Approx(0).margin(1e-12 * r.radius));
        CHECK((r.centre - (b - tau * t1)).norm() == Approx(r.radius).epsilon(1e-12));
        CHECK((r.centre - (b + tau * t2)).norm() == Approx(r.radius).epsilon(1e-12));
        CHECK((r.centre - b).norm() - r.radius == Approx(r.height).epsilon(1e-10).margin(1e-13 * r.radius));
        CHECK((r.centre - b).dot((b - a).cross(c - b)) == Approx(0).margin(1e-12));
    }
}

TEST_CASE("the corners of a regular polygon are rounded by its inscribed circle, of many corners too") {
    for (const int n : {3, 12, 48, 100000}) {
        const auto at = [&](int k) { return Vector3(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0.5); };
        const RoundedCorner r = rounded_corner(at(n - 1), at(0), at(1));
        const double inscribed = std::cos(pi / n);
        CHECK((r.centre - Vector3(0, 0, 0.5)).norm() < 1e-15 * n * n);
        CHECK(r.radius == Approx(inscribed).epsilon(1e-15 * n * n));
        CHECK(r.height == Approx(2 * std::pow(std::sin(pi / (2 * n)), 2)).epsilon(1e-15 * n * n));
    }
}

TEST_CASE("a rounded corner's tangent is that of differences, and the adjoint its transpose") {
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix3X p = tests::random_matrix(3, random);
        const VectorX x = Eigen::Map<const VectorX>(p.data(), 9);
        CHECK(tests::support::check_jacobian(rounded, x, jacobian(x)).relative_error < 1e-7);
        const double transposed = tests::support::check_transpose(
            [&](const VectorX& v) { return as_vector(rounded_corner_tangent(as_corners(x), as_corners(v))); },
            [&](const VectorX& w) -> VectorX {
                const Corners g = rounded_corner_adjoint(as_corners(x), {w.head<3>(), w[3], w[4]});
                VectorX out(9);
                out << g[0], g[1], g[2];
                return out;
            },
            9, 5);
        CHECK(transposed < 1e-13);
    }
}

TEST_CASE("where both edges are of one length, the derivative is the mean of both sides") {
    VectorX x(9);
    x << std::cos(-0.3), std::sin(-0.3), 0, 1, 0, 0, std::cos(0.3), std::sin(0.3), 0;
    // Central differences over the kink of the smaller length give the mean.
    CHECK(tests::support::check_jacobian(rounded, x, jacobian(x)).relative_error < 1e-6);
    const Corners mirrored = as_corners(jacobian(x).row(3).transpose());
    CHECK((mirrored[0] - Vector3(mirrored[2].x(), -mirrored[2].y(), 0)).norm() < 1e-12);
}

TEST_CASE("a box has a ring of four edges along each of three directions") {
    const Mesh box = tests::box_mesh(Vector3(-1, 0, 2), Vector3(3, 1, 4));
    const RoundedSides found = checked(box);
    REQUIRE(found.sides.size() == 3);
    for (int i = 0; i < 3; ++i) {
        const auto sides = along(found, Vector3::Unit(i));
        REQUIRE(sides.size() == 1);
        CHECK(spelled(sides[0]) == "EEEE");
        CHECK(sides[0].closed);
        CHECK_FALSE(sides[0].is_round());
        CHECK(sides[0].ends[0] == Approx(Vector3(-1, 0, 2)[i]).margin(1e-15));
        CHECK(sides[0].ends[1] == Approx(Vector3(3, 1, 4)[i]));
    }
    for (const auto& places : found.of_vertex) CHECK(places.size() == 3);
    for (const auto& place : found.of_triangle) CHECK(place.side >= 0);
    int on_lines = 0;
    for (const auto& places : found.of_edge) on_lines += places.size() == 3;
    CHECK(on_lines == 12);  // a corner's line in one direction, at an end in the others; diagonals are in two rectangles
}

TEST_CASE("a prism of 24 sides is one ring of round corners, however its walls are cut") {
    for (const int floors : {1, 3}) {
        const Mesh mesh = prism(regular(24, 0.01), -0.002, 0.001, floors);
        const RoundedSides found = checked(mesh);
        REQUIRE(found.sides.size() == 1);
        const RoundedSide& side = found.sides[0];
        CHECK(side.closed);
        CHECK(spelled(side) == std::string(24, 'R'));
        CHECK(side.ends[0] == Approx(-0.002));
        CHECK(side.ends[1] == Approx(0.001));
        for (int k = 0; k < 24; ++k) {
            const auto at = [&](int j) { return Vector3(mesh.vertices.col(side.corners[(k + j) % 24].rim[0])); };
            const RoundedCorner r = rounded_corner(at(23), at(0), at(1));
            CHECK((r.centre - Vector3(0, 0, -0.002)).norm() < 1e-15);
            CHECK(r.radius == Approx(0.01 * std::cos(pi / 24)));
        }
        int of_walls = 0, of_side = 0;
        for (const auto& place : found.of_triangle) of_walls += place.side == 0;
        for (const auto& places : found.of_vertex) of_side += places.size() == 1;
        CHECK(of_walls == 48 * floors);
        CHECK(of_side == 24 * (floors + 1));
        int on_lines = 0, in_rectangles = 0;
        for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
            const Vector3 d = mesh.vertices.col(mesh.edges[e][1]) - mesh.vertices.col(mesh.edges[e][0]);
            const bool is_axial = d.head<2>().norm() < 1e-12;
            for ([[maybe_unused]] const auto& place : found.of_edge[e]) ++(is_axial ? on_lines : in_rectangles);
        }
        CHECK(on_lines == 24 * floors);
        CHECK(in_rectangles == 24 * (2 * floors + 1));  // a diagonal in each floor, the ends, and between the floors
    }
}

TEST_CASE("largest_smooth_turn parts round corners from edges") {
    CHECK(spelled(checked(prism(regular(11, 1), 0, 1)).sides.front()) == std::string(11, 'R'));
    const RoundedSides ten = checked(prism(regular(10, 1), 0, 1));
    const auto sides = along(ten, Vector3::UnitZ());
    REQUIRE(sides.size() == 1);
    CHECK(spelled(sides[0]) == std::string(10, 'E'));
    CHECK(ten.sides.size() == 11);  // each wall is a plane, which stands alone across
}

TEST_CASE("a bored hole is a ring of concave round corners") {
    const Mesh plate = drawn([](parts::Drawing& drawing, const std::vector<parts::Number>&) -> Result<parts::Solid> {
        const auto profile = parts::with_hole(*parts::filled(parts::rectangle(point(-0.02, -0.01), 0.04, 0.02, "plate")),
                                              parts::circle(point(0.003, 0.001), 0.005, "bore"));
        return parts::extruded(drawing, *profile, 0, 0.004);
    });
    const RoundedSides found = checked(plate);
    const auto sides = along(found, Vector3::UnitZ());
    REQUIRE(sides.size() == 2);
    const RoundedSide& bore = sides[sides[0].is_round() ? 0 : 1];
    const RoundedSide& rim = sides[sides[0].is_round() ? 1 : 0];
    CHECK(spelled(bore) == std::string(48, 'r'));
    CHECK(bore.closed);
    CHECK(spelled(rim) == "EEEE");
    CHECK(rim.closed);
    // The end faces are no rectangles: the walls stand alone in the other two directions.
    for (const Vector3& axis : {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitY())})
        for (const auto& side : along(found, axis)) {
            CHECK(spelled(side) == "EE");
            CHECK_FALSE(side.closed);
        }
    CHECK(found.sides.size() == 6);
    const RoundedCorner r = rounded_corner(plate.vertices.col(bore.corners[47].rim[1]), plate.vertices.col(bore.corners[0].rim[1]),
                                           plate.vertices.col(bore.corners[1].rim[1]));
    CHECK((r.centre - Vector3(0.003, 0.001, 0.004)).norm() < 1e-14);
}

TEST_CASE("a pin with a head has a ring for each") {
    const Mesh pin = drawn([](parts::Drawing& drawing, const std::vector<parts::Number>&) {
        return parts::stacked(drawing, {{*parts::filled(parts::circle({}, 0.002, "pin")), 0, 0.01, {}, {}, "foot"},
                                        {*parts::filled(parts::circle({}, 0.004, "head")), 0.01, 0.012, {}, {}, "head"}});
    });
    const RoundedSides found = checked(pin);
    REQUIRE(found.sides.size() == 2);
    for (const auto& side : found.sides) {
        CHECK(side.closed);
        CHECK(spelled(side) == std::string(48, 'R'));
        CHECK(is_along(side, Vector3::UnitZ()));
        const bool is_head = side.ends[0] > 0.005;
        CHECK(side.ends[0] == Approx(is_head ? 0.01 : 0).margin(1e-15));
        CHECK(side.ends[1] == Approx(is_head ? 0.012 : 0.01));
    }
}

TEST_CASE("a link has flanks between round ends, and a slot in it the same seen from within") {
    for (const auto lean : {parts::Lean::cover, parts::Lean::through}) {
        const Mesh link = drawn(
            [](parts::Drawing& drawing, const std::vector<parts::Number>&) -> Result<parts::Solid> {
                const auto profile = parts::with_hole(*parts::filled(parts::slot(point(0, 0), point(0.03, 0), 0.006, "link")),
                                                      parts::slot(point(0.01, 0), point(0.02, 0), 0.003, "slot"));
                return parts::extruded(drawing, *profile, 0, 0.004);
            },
            {0, 24, lean});
        const RoundedSides found = checked(link);
        const auto sides = along(found, Vector3::UnitZ());
        REQUIRE(sides.size() == 2);
        for (const auto& side : sides) {
            CHECK(side.closed);
            CHECK(kinds(side).size() == 1);
            CHECK(side.is_round());
        }
        CHECK(kinds(sides[0]).begin()->first != kinds(sides[1]).begin()->first);
        // The flanks are planes, along x too.
        const auto flanks = along(found, Vector3::UnitX());
        CHECK(flanks.size() == 4);
        for (const auto& side : flanks) CHECK(spelled(side) == "EE");
        CHECK(found.sides.size() == 6);
        // A facet of two directions is of the round side.
        for (const auto& place : found.of_triangle) CHECK((place.side < 0 || found.sides[place.side].is_round()));
    }
}

TEST_CASE("an L has one concave edge, stairs end on concave edges") {
    const std::vector<Vector2> outline{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
    const RoundedSides found = checked(prism(outline, 0, 5));
    const auto sides = along(found, Vector3::UnitZ());
    REQUIRE(sides.size() == 1);
    CHECK(kinds(sides[0]) == std::map<CornerKind, int>{{CornerKind::convex_edge, 5}, {CornerKind::concave_edge, 1}});
    // Across, each wall stands alone: its lines there are those to the L-shaped ends, which are no rectangles.
    int concave_ends = 0;
    for (const auto& side : found.sides) {
        if (side.closed) continue;
        CHECK(side.rectangles() == 1);
        for (const auto& corner : side.corners) concave_ends += corner.kind == CornerKind::concave_edge;
    }
    CHECK(concave_ends == 0);

    const Mesh stairs = drawn([](parts::Drawing& drawing, const std::vector<parts::Number>&) {
        return parts::stacked(drawing, {{*parts::filled(parts::rectangle(point(0, 0), 4, 4, "low")), 0, 1, {}, {}, "low"},
                                        {*parts::filled(parts::rectangle(point(1, 1), 2, 2, "high")), 1, 2, {}, {}, "high"}});
    });
    const RoundedSides stair_sides = checked(stairs);
    CHECK(along(stair_sides, Vector3::UnitZ()).size() == 2);
    for (const auto& side : along(stair_sides, Vector3::UnitX())) {
        // Two risers and the tread between them; of the lower layer two walls and the bottom.
        CHECK(spelled(side) == (side.ends[1] < 3.5 ? "eEEe" : "EEEE"));
        CHECK_FALSE(side.closed);
    }
}

TEST_CASE("spheres and other curved meshes have no sides") {
    CHECK(checked(tests::ellipsoid_mesh(Vector3(1, 1, 1), 12)).sides.empty());
    CHECK(checked(tests::ellipsoid_mesh(Vector3(1, 2, 3), 16)).sides.empty());
    CHECK(checked(tests::torus_mesh(2, 0.5, 24)).sides.empty());
    CHECK(rounded_sides(Mesh()).sides.empty());
}

TEST_CASE("a turned body has the same sides") {
    const Mesh mesh =
        tests::joined(prism(regular(24, 0.01), -0.002, 0.003), tests::box_mesh(Vector3(0.02, 0, 0), Vector3(0.03, 0.02, 0.01)));
    const RoundedSides before = checked(mesh);
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 20; ++trial) {
        Mesh turned = mesh;
        const Vector3 turn = 3 * tests::random_matrix(1, random).col(0);
        const Matrix3 rotation = tests::support::make_pose(turn, Vector3::Zero()).rotation;
        turned.vertices = rotation * mesh.vertices;
        turned.vertices.colwise() += Vector3(0.1, -0.2, 0.05);
        const RoundedSides after = checked(turned);
        REQUIRE(after.sides.size() == before.sides.size());
        for (std::size_t s = 0; s < before.sides.size(); ++s) {
            const RoundedSide &a = before.sides[s], &b = after.sides[s];
            CHECK(is_along(b, rotation * a.axis));
            CHECK(a.closed == b.closed);
            CHECK(kinds(a) == kinds(b));
            CHECK(b.ends[1] - b.ends[0] == Approx(a.ends[1] - a.ends[0]));
            std::set<std::set<int>> lines[2];
            for (const auto& corner : a.corners) lines[0].insert({corner.rim[0], corner.rim[1]});
            for (const auto& corner : b.corners) lines[1].insert({corner.rim[0], corner.rim[1]});
            CHECK(lines[0] == lines[1]);
        }
        for (std::size_t e = 0; e < mesh.edges.size(); ++e) REQUIRE(before.of_edge[e].size() == after.of_edge[e].size());
    }
}

TEST_CASE("a side is open where a facet of it is no rectangle") {
    // A corner of one wall of a prism is cut off: the wall and its neighbours stay, the cut one goes.
    Mesh mesh = prism(regular(24, 1), 0, 1);
    const RoundedSides whole = checked(mesh);
    const Triangle cut = mesh.triangles[0];  // lower two corners of a wall, and an upper one
    Matrix3X v(3, mesh.vertices.cols() + 1);
    v << mesh.vertices, (mesh.vertices.col(cut[0]) + mesh.vertices.col(cut[1]) + mesh.vertices.col(cut[2])) / 3 * 0.99;
    const int middle = static_cast<int>(mesh.vertices.cols());
    std::vector<Triangle> triangles(mesh.triangles.begin() + 1, mesh.triangles.end());
    for (int k = 0; k < 3; ++k) triangles.push_back({cut[k], cut[(k + 1) % 3], middle});
    const RoundedSides found = checked(make_mesh("dented", v, triangles));
    REQUIRE(found.sides.size() == 1);
    CHECK_FALSE(found.sides[0].closed);
    CHECK(spelled(found.sides[0]) == "E" + std::string(22, 'R') + "E");
    CHECK(found.sides[0].rectangles() == 23);
}

TEST_CASE("rectangles with more vertices on their borders, and in one plane, are found") {
    // A wall of the box is cut along the axis: one rectangle still; then bent by 5e-7 rad: two, with no corner between them.
    for (const double bend : {0.0, 2.5e-7, 1e-3}) {
        const std::vector<Vector2> outline{{0, 0}, {1, -bend}, {2, 0}, {2, 1}, {0, 1}};
        const RoundedSides found = checked(prism(outline, 0, 1, 2));
        const auto sides = along(found, Vector3::UnitZ());
        REQUIRE(sides.size() == 1);
        const auto of_kind = kinds(sides[0]);
        CHECK(of_kind.at(CornerKind::convex_edge) == 4);
        CHECK(of_kind.count(CornerKind::none) == (bend == 2.5e-7 ? 1 : 0));
        CHECK(of_kind.count(CornerKind::convex_round) == (bend == 1e-3 ? 1 : 0));
    }
}

TEST_CASE("a cam of a law is a ring of round corners") {
    const Mesh cam = drawn([](parts::Drawing& drawing, const std::vector<parts::Number>&) -> Result<parts::Solid> {
        const auto radius = [](const auto& t) { return 0.02 + 0.003 * cos(2 * t) + 0.001 * sin(3 * t); };
        const parts::Law law([radius](const auto& t) { return std::array{radius(t) * cos(t), radius(t) * sin(t)}; });
        const auto loop = parts::Path(point(0.023, 0), "cam").along(parts::law_curve(law, 0, 2 * pi)).closed();
        if (!loop) return loop.errors();
        const auto profile = parts::with_hole(*parts::filled(*loop), parts::circle({}, 0.004, "bore"));
        return parts::extruded(drawing, *profile, 0, 0.005);
    });
    const RoundedSides found = checked(cam);
    REQUIRE(found.sides.size() == 2);
    const RoundedSide& rim = found.sides[found.sides[0].corners.size() > found.sides[1].corners.size() ? 0 : 1];
    CHECK(rim.closed);
    int round = 0;
    for (const auto& corner : rim.corners) round += corner.kind == CornerKind::convex_round || corner.kind == CornerKind::concave_round;
    CHECK(round == count_of(rim.corners));
    CHECK(round > 48);
    for (const auto& side : found.sides)
        if (&side != &rim) CHECK(spelled(side) == std::string(48, 'r'));
}

TEST_CASE("large meshes, round and extruded ones") {
    CHECK(rounded_sides(tests::ellipsoid_mesh(Vector3(1, 2, 3), 160)).sides.empty());
    CHECK(rounded_sides(prism(regular(2000, 1), 0, 1, 24)).sides.size() == 1);
    CHECK(rounded_sides(prism(regular(25000, 1), 0, 1)).sides.size() == 1);
}

}  // namespace fettle::core::geometry::rounded_sides_test
