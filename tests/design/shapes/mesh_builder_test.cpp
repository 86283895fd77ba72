// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/mesh_builder.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "fettle/core/base/types.hpp"

namespace fettle::design::shapes::mesh_builder_test {

namespace {

using Builder = MeshBuilder<double>;

Vector3 vector_area(const Builder& builder, std::size_t triangle) {
    const auto at = [&](int k) {
        const auto& p = builder.vertices()[builder.triangles()[triangle][k]];
        return Vector3(p[0], p[1], p[2]);
    };
    return (at(1) - at(0)).cross(at(2) - at(0)) / 2;
}

// Area of a plane face along `normal`; no triangle may be turned over or degenerate.
double face_area(const Builder& builder, const Vector3& normal) {
    double area = 0;
    for (std::size_t i = 0; i < builder.triangles().size(); ++i) {
        const double part = vector_area(builder, i).dot(normal);
        CHECK(part > 0);
        area += part;
    }
    return area;
}

double polygon_area(int n, double radius) { return n / 2.0 * std::sin(2 * std::numbers::pi / n) * radius * radius; }

TEST_CASE("mesh builder: a rectangle with a hole covers it once, on either axis and side") {
    for (Axis axis : {Axis::x, Axis::z}) {
        for (Facing facing : {Facing::forward, Facing::backward}) {
            Builder builder(24);
            const auto corners = builder.add_rectangle(axis, 0.3, {-1.1, 4.0}, {-2.0, 1.2});
            const Ring hole = builder.add_ring({.axis = axis, .along = 0.3, .radius = 1.0});
            builder.add_rectangle_with_hole(corners, hole, facing);
            const Vector3 normal = (axis == Axis::x ? Vector3::UnitX() : Vector3::UnitZ()) * (facing == Facing::forward ? 1 : -1);
            CHECK(face_area(builder, normal) == Approx(5.1 * 3.2 - polygon_area(24, 1.0)).epsilon(1e-13));
        }
    }
}

TEST_CASE("mesh builder: a disc with a rectangular hole, wherever the rectangle lies") {
    for (const auto& v : {std::array<double, 2>{-1.0, 1.5}, std::array<double, 2>{-2.2, -0.4}, std::array<double, 2>{0.2, 2.5}}) {
        Builder builder(16);
        const auto corners = builder.add_rectangle(Axis::x, 0, {-1.0, 1.0}, v);
        const Ring rim = builder.add_ring({.axis = Axis::x, .radius = 3.0});
        builder.add_disc_with_rectangle(rim, corners, Facing::backward);
        CHECK(face_area(builder, -Vector3::UnitX()) == Approx(polygon_area(16, 3.0) - 2 * (v[1] - v[0])).epsilon(1e-13));
    }
}

TEST_CASE("mesh builder: an eccentric strip covers the ring between its circles once") {
    Builder builder(24);
    const Ring outer = builder.add_ring({.radius = 2.1});
    const Ring inner = builder.add_ring({.radius = 0.4, .centre_u = 1.5, .centre_v = -0.5});
    builder.add_strip(outer, inner);
    CHECK(face_area(builder, Vector3::UnitZ()) == Approx(polygon_area(24, 2.1) - polygon_area(24, 0.4)).epsilon(1e-13));
}

TEST_CASE("mesh builder: a strip along the axis looks outwards") {
    for (Axis axis : {Axis::x, Axis::z}) {
        Builder builder(8);
        builder.add_strip(builder.add_ring({.axis = axis, .along = -1, .radius = 2}),
                          builder.add_ring({.axis = axis, .along = 1, .radius = 2}));
        const Vector3 along = axis == Axis::x ? Vector3::UnitX() : Vector3::UnitZ();
        for (std::size_t i = 0; i < builder.triangles().size(); ++i) {
            const auto& p = builder.vertices()[builder.triangles()[i][0]];
            const Vector3 position(p[0], p[1], p[2]);
            CHECK(vector_area(builder, i).dot(position - along * along.dot(position)) > 0);
        }
    }
}

}  // namespace

}  // namespace fettle::design::shapes::mesh_builder_test
