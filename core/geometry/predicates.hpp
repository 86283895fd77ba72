// SPDX-License-Identifier: MIT
/// Exact predicates on points in the plane and in space: signs of determinants, and the intersections built on them.
/// Each sign is that of the exact value for the given doubles: a floating-point evaluation decides when its error bound allows, exact
/// integer arithmetic does otherwise. Right for every finite double, subnormal and huge ones included; needs strict IEEE arithmetic
/// (no -ffast-math). Contract: finite coordinates (a NaN or infinity throws ContractError when the exact stage is reached).
///
/// Used by solids/ and by tests. Distances are distance.hpp.
/// By hand: CGAL's exact kernel brings GMP and MPFR, and is the judge of these in the tests; Shewchuk's are wrong where numbers underflow
/// or overflow.
#pragma once

#include <array>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Sign (-1, 0, 1) of (b - a) x (c - a): 1 if a, b, c turn counter-clockwise.
int orient2d(const Vector2& a, const Vector2& b, const Vector2& c);

/// Sign (-1, 0, 1) of ((b - a) x (c - a)) . (d - a): 1 if d lies on the side to which the normal of the triangle a b c
/// (counter-clockwise) points, 0 if the four are coplanar. Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997, has the opposite
/// sign.
int orient3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Sign of the sum over triangles of det(a, b, c): of the volume that a closed mesh encloses. Contract: indices in range.
int volume_sign(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// v without its coordinate `axis` (0, 1, 2), the others in cyclic order, so that a triangle that is counter-clockwise
/// seen from +axis stays counter-clockwise.
inline Vector2 projected(const Vector3& v, int axis) { return {v((axis + 1) % 3), v((axis + 2) % 3)}; }

/// An axis along which the projection of a, b, c has an area; -1 if the three are collinear (exactly).
int projection_axis(const Vector3& a, const Vector3& b, const Vector3& c);

/// Three collinear points, or fewer distinct ones.
inline bool is_degenerate(const std::array<Vector3, 3>& triangle) { return projection_axis(triangle[0], triangle[1], triangle[2]) < 0; }

/// Do the closed segments p0 p1 and q0 q1 have a common point? Touching counts; a segment may be a point.
bool segments_intersect(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1);

/// Do the closed segment p0 p1 and the closed triangle have a common point? Touching counts; a segment may be a point; a triangle
/// of zero area is the segment that its corners span.
bool segment_intersects_triangle(const Vector3& p0, const Vector3& p1, const std::array<Vector3, 3>& triangle);

}  // namespace fettle::core::geometry
