// SPDX-License-Identifier: MIT
/// Builds closed triangle meshes on a generic scalar (double or Dual), so that vertices carry their derivatives. Connectivity
/// depends on the number of segments alone. Which shapes there are: shape_generator.hpp.
///
/// Orientation. Rings run counter-clockwise about their axis, starting at the first of its two cross axes. `strip(a, b)` looks
/// along (ring direction) x (from a to b): an outer surface is a chain of strips whose rings are listed along its profile from
/// the lower end of the axis to the upper end, whatever the radii do in between; the wall of a hole goes the other way.
/// Faces are given by the side they look to: along the axis' positive direction, or against it.
/// No T-junctions: faces meet in whole edges, since rectangles keep to their four corners and circles to their N points.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/geometry/mesh.hpp"
#include "fettle/design/shapes/unit_circle.hpp"

namespace fettle::design::shapes {

enum class Axis { x, z };                 ///< x: cross axes y, z; z: cross axes x, y
enum class Facing { forward, backward };  ///< outward normal along the axis, or against it

using Ring = std::vector<int>;                ///< vertex indices
using RectangleCorners = std::array<int, 4>;  ///< vertex indices in the quadrants (+,+) (-,+) (-,-) (+,-) of the cross axes

template <class Scalar>
class MeshBuilder {
public:
    using Point = std::array<Scalar, 3>;
    using Triangle = core::geometry::Triangle;

    /// @param segments  Segments of a full circle. Contract: a positive multiple of 4.
    explicit MeshBuilder(int segments) : circle_(unit_circle(segments)) {}

    int segments() const { return count_of(circle_); }
    const std::vector<Point>& vertices() const { return vertices_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// The point at `along` on the axis and (u, v) on its cross axes.
    static Point point(Axis axis, const Scalar& along, const Scalar& u, const Scalar& v) {
        return axis == Axis::z ? Point{u, v, along} : Point{along, u, v};
    }

    int add_vertex(const Point& position) {
        vertices_.push_back(position);
        return count_of(vertices_) - 1;
    }

    void add_triangle(int a, int b, int c, Facing facing = Facing::forward) {
        triangles_.push_back(facing == Facing::forward ? Triangle{a, b, c} : Triangle{a, c, b});
    }

    /// Plane quadrilateral a b c d, counter-clockwise from outside (forward).
    void add_quadrilateral(int a, int b, int c, int d, Facing facing = Facing::forward) {
        add_triangle(a, b, c, facing);
        add_triangle(a, c, d, facing);
    }

    struct Circle {
        Axis axis = Axis::z;
        Scalar along = 0;     ///< plane of the circle [m]
        Scalar radius = 0;    ///< of the vertices [m]
        Scalar centre_u = 0;  ///< on the cross axes [m]
        Scalar centre_v = 0;
    };

    /// Points `first` to `last` of the circle's N, both included; last may exceed N.
    Ring add_arc(const Circle& circle, int first, int last) {
        Ring arc;
        for (int i = first; i <= last; ++i) {
            const auto& unit = circle_[i % segments()];
            arc.push_back(add_vertex(
                point(circle.axis, circle.along, circle.centre_u + circle.radius * unit[0], circle.centre_v + circle.radius * unit[1])));
        }
        return arc;
    }
    Ring add_ring(const Circle& circle) { return add_arc(circle, 0, segments() - 1); }

    RectangleCorners add_rectangle(Axis axis, const Scalar& along, const std::array<Scalar, 2>& u, const std::array<Scalar, 2>& v) {
        return {add_vertex(point(axis, along, u[1], v[1])), add_vertex(point(axis, along, u[0], v[1])),
                add_vertex(point(axis, along, u[0], v[0])), add_vertex(point(axis, along, u[1], v[0]))};
    }

    /// Band between two rings of equal count, point to point (see Orientation above). Rings may be eccentric.
    void add_strip(const Ring& a, const Ring& b) {
        add_open_strip(a, b);
        add_quadrilateral(a.back(), a.front(), b.front(), b.back());
    }

    /// The same between two arcs.
    void add_open_strip(const Ring& a, const Ring& b) {
        FETTLE_ASSERT(a.size() == b.size(), "a strip joins rings of equal count");
        for (std::size_t i = 0; i + 1 < a.size(); ++i) add_quadrilateral(a[i], a[i + 1], b[i + 1], b[i]);
    }

    /// Disc: a fan about `centre`, a vertex in the ring's plane.
    void add_cap(int centre, const Ring& ring, Facing facing) {
        for (std::size_t i = 0; i < ring.size(); ++i) add_triangle(centre, ring[i], ring[(i + 1) % ring.size()], facing);
    }

    /// Quadrant `quadrant` (0 to 3) of the ring fanned to a vertex outside the circle that sees all of it.
    void add_quadrant_outside(int corner, const Ring& ring, int quadrant, Facing facing) {
        const int count = segments() / 4;
        for (int i = quadrant * count; i < (quadrant + 1) * count; ++i) add_triangle(corner, at(ring, i + 1), at(ring, i), facing);
    }

    /// Rectangle with a circular hole: each quadrant of the hole is fanned to its corner. Valid for a circle inside the rectangle.
    void add_rectangle_with_hole(const RectangleCorners& corners, const Ring& hole, Facing facing) {
        for (int quadrant = 0; quadrant < 4; ++quadrant) {
            const int corner = corners[quadrant];
            add_quadrant_outside(corner, hole, quadrant, facing);
            add_triangle(corner, corners[(quadrant + 1) % 4], at(hole, (quadrant + 1) * segments() / 4), facing);
        }
    }

    /// Disc with a rectangular hole, the reverse: each quadrant of the rim is fanned to its corner. Valid for corners inside the
    /// polygon of the rim, in whichever quadrants they lie.
    void add_disc_with_rectangle(const Ring& rim, const RectangleCorners& corners, Facing facing) {
        const int count = segments() / 4;
        for (int quadrant = 0; quadrant < 4; ++quadrant) {
            const int corner = corners[quadrant];
            for (int i = quadrant * count; i < (quadrant + 1) * count; ++i) add_triangle(corner, at(rim, i), at(rim, i + 1), facing);
            add_triangle(corners[(quadrant + 1) % 4], corner, at(rim, (quadrant + 1) * count), facing);
        }
    }

private:
    int at(const Ring& ring, int i) const { return ring[static_cast<std::size_t>(i) % ring.size()]; }

    std::vector<std::array<double, 2>> circle_;
    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;
};

}  // namespace fettle::design::shapes
