// SPDX-License-Identifier: MIT
/// Sides of a body that run along one straight direction, as an extrusion's do: rectangles side by side, each standing for a piece of a
/// smooth surface or for a plane. And the smooth surface: its section is the polygon of the rectangles with the corners between them
/// rounded.
///
/// A corner P1 between P0 and P2, with e1 = P1 - P0, e2 = P2 - P1, t = e/|e| and c = t1 . t2 = cos(phi), is rounded by the circle that
/// touches both edges at the distance tau = min(|e1|, |e2|)/2 from it:
///   centre = P1 + tau/(1 - c) (t2 - t1),   radius = tau sqrt((1 + c)/(1 - c)),   height = tau tan(phi/4),
/// height being how far the corner sticks out of (convex) or the circle lies before it (concave). Edges of one length, as a circle's, leave
/// no plane pieces between the circles, and of a regular polygon all circles are its inscribed one. The result is a curve without corners
/// that touches each edge where the true curve's direction is that of the edge, but for O(phi^2); the edges themselves are off by O(phi).
#pragma once

#include <array>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

struct RoundedCorner {
    Vector3 centre = Vector3::Zero();
    double radius = 0, height = 0;
};

/// Contract: the three are apart and 0 < phi < pi.
RoundedCorner rounded_corner(const Vector3& p0, const Vector3& p1, const Vector3& p2);
/// Its change along a change of the three. Where both edges are of one length (to 1e-12 of it), tau's is the mean of both sides':
/// symmetric.
RoundedCorner rounded_corner_tangent(const std::array<Vector3, 3>& p, const std::array<Vector3, 3>& p_dot);
/// The gradient in the three of what has the gradient `bar` in centre, radius and height.
std::array<Vector3, 3> rounded_corner_adjoint(const std::array<Vector3, 3>& p, const RoundedCorner& bar);

/// Turns up to this are taken for a smooth surface's, at least 11 segments to the circle [rad].
inline constexpr double largest_smooth_turn = 0.6;

/// What stands at a corner between two rectangles, seen from outside.
enum class CornerKind : unsigned char {
    convex_edge,   ///< turns by more than largest_smooth_turn; also an open side's first and last, by any angle
    concave_edge,  ///< the same where the body turns inward; an open side's first and last: along the whole of its line
    convex_round,
    concave_round,
    none  ///< straight on: turns by 1e-6 rad at most. Rectangles of one plane are one, if they make one
};

/// Rectangles side by side. Seen against `axis` (from its tip) the body is to the left of the way from corner to corner, so that
/// (next - this) x axis points outward.
struct RoundedSide {
    struct Corner {
        std::array<int, 2> rim{};  ///< vertices at the side's lower and upper end: upper - lower is along the axis
        CornerKind kind = CornerKind::none;
    };
    Vector3 axis = Vector3::UnitZ();  ///< unit; its first component that is not 0 (to 1e-9) is positive
    bool closed = false;              ///< a rectangle leads from the last corner to the first
    std::vector<Corner> corners;      ///< 2 or more; rectangle k is between corners k and k + 1
    std::array<double, 2> ends{};     ///< lower, upper along the axis, of the mesh's coordinates [m]

    int rectangles() const { return static_cast<int>(corners.size()) - (closed ? 0 : 1); }
    bool is_round() const;  ///< has a corner that is
};

struct RoundedSides {
    std::vector<RoundedSide> sides;
    /// By primitive: {side, corner or rectangle}; -1: of none. A vertex may belong to several sides, of several directions and heights.
    struct Place {
        int side = -1, at = -1;
    };
    /// [vertex]: a rim of that corner; of further vertices in a rectangle or on its border, a corner of the rectangle.
    std::vector<std::vector<Place>> of_vertex;
    std::vector<Place> of_triangle;  ///< [triangle]: part of that rectangle; of a side that is round if there is one
    /// [edge of the mesh]: along the axis and not within a plane facet: that corner's line or a part of it; any other: in that rectangle
    /// (its border at an end, or within).
    std::vector<std::vector<Place>> of_edge;
};

/// The sides of a mesh. A side ends where the next face is no rectangle of the same direction and ends. Rectangles may be cut into any
/// number of triangles, and may have further vertices on their border; a facet that covers rectangles of several heights is none, and a
/// facet may be one of two directions. Sides of no round corner are kept too, for they meet round ones, unless all their rectangles stand
/// for curved surfaces of another direction (less than 2/3 of the width between circles stays plane): a cylinder's facets are no sides
/// across. Within 1e-9 of the mesh's size: coordinates in single precision are too coarse. In the order of the mesh's triangles. Contract:
/// connectivity built.
RoundedSides rounded_sides(const Mesh& mesh);

}  // namespace fettle::core::geometry
