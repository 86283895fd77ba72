// SPDX-License-Identifier: MIT
/// Lower bounds of the distance of two moving convex pieces (boxes of a hierarchy, or triangles) over an interval of one path segment.
/// The search that uses them: pair_search.hpp.
///
/// The moving plane. Let the interval be s0 <= s <= s1, u = (s - s0)/(s1 - s0), h = s1 - s0. For any vectors |n0|, |n1| <= 1 put
/// n(u) = (1 - u) n0 + u n1, so |n(u)| <= 1 and dist(A, B) >= n(u).(x_a - x_b) for the closest points x_a, x_b, that is
///   dist >= min over points a of A, b of B of f_ab(u),   f_ab(u) = n(u).(x_a(u) - x_b(u)).
/// A point's curve is its chord (linear in u) plus a deviation e(u), so f_ab is a quadratic in Bernstein form plus n(u).(e_a - e_b):
///   c0 = n0.d(0),  c1 = (n0.d(1) + n1.d(0))/2,  c2 = n1.d(1),  d = x_a - x_b at the interval's ends.
/// Each coefficient is linear in (X_a, X_b): its least value over two convex pieces is a difference of support functions. Bernstein
/// polynomials are not negative, so the least coefficients bound every f_ab. On [0, 1] |e(u)| <= 4u(1-u) D with D = h^2/8 max|x''|,
/// and n.e likewise, which is 2D on c1. Hence with exact arithmetic
///   dist >= min over u of (1-u)^2 c0 + 2u(1-u) (c1 - 2 D_a - 2 D_b) + u^2 c2.
/// With n0, n1 the directions of the closest points at the ends, c0 and c2 are the distances there and c1 differs from their mean by
/// (n1 - n0).(d(1) - d(0))/2 = O(h^2): no first-order loss, faces that slide and tilt included; where the distance is monotone the
/// bound is its value at an end.
///
/// Deviation along n. With phi = theta0 + s w, R'' is the mean of e^{a phi}[w] e^{b phi}[w] e^{c phi} over the triangle a + b + c = 1,
/// a, b, c >= 0 (Duhamel), where the means of a and c are 1/3 and that of a c is 1/12. As |e^{a phi} w - w| <= a k, k = |theta0 x w|,
/// |[w] e^{-a phi} n| <= |n x w| + a k and |[w] e^{c phi} Y| <= |w x Y| + c k |Y|. So
///   |n.x''| <= |n x w||w x Y| + k(|w x Y| + |n x w||Y|)/3 + k^2 |Y|/12,   and   |n.x''| <= |w|^2 |Y|,   Y = base X.
///
/// Rounding (u = 2^-53; norms; r = twice the body's radius, which bounds the corners of its boxes; P = sum of |q_t0| + |q_step| of both
/// bodies):
///   pose: phi = theta0 + s w is off by <= 3u(|theta0| + |w|); rotation() by (90 + 38|phi|)u (half-angle sine and cosine to an ulp, x =
///   |phi| to
///     2.5 ulp, three terms an entry, nine entries); the product with the base by 9u; in all (160 + 48(|theta0| + |w|))u on R, and 4uP on
///     q_a - q_b;
///   functionals R^T n and their dot products with X: 16u r a body; with q_a - q_b: 4uP; sums of coefficients and the least value of the
///     quadratic: 16u(r_a + r_b + P).
/// PairSegment::slack is the sum of all that, and of the like terms of a distance evaluated from rounded vertices.
#pragma once

#include <array>

#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/kinematics/path.hpp"

namespace fettle::core::clearance {

/// A body on one path segment, with what its bounds need.
struct BodySegment {
    kinematics::PathSegment path;
    Matrix3 sweep = Matrix3::Zero();          ///< [w] base: |w x base X| = |sweep X|
    Vector3 sweep_columns = Vector3::Zero();  ///< norms of its columns
    double speed = 0;                         ///< |w|, rounded up
    double twist = 0;                         ///< k = |theta0 x w|, rounded up
    double base_norm = 1;                     ///< >= the norm of the stored base, which is a rotation up to rounding only
};

/// A pair of bodies on one path segment.
struct PairSegment {
    int step = -1, segment = 0;  ///< -1: the start pose, held
    BodySegment a, b;
    double slack = 0;  ///< [m] see the top of the file
};

/// Both bodies at one parameter, relative to body b's reference point.
struct Instant {
    double s = 0;
    Matrix3 rotation_a, rotation_b;
    Matrix3 relative_rotation;  ///< rotation_a^T rotation_b
    Vector3 offset;             ///< q_a - q_b
};

PairSegment pair_segment(const kinematics::PathSegment& a, const kinematics::PathSegment& b, double radius_a, double radius_b);
Instant instant_at(const PairSegment& segment, double s);

/// How far a piece reaches: |X| <= radius and |w x base X| <= swept for its points.
struct Reach {
    double radius = 0, swept = 0;
};
Reach box_reach(const BodySegment& body, const contact::HierarchyNode& box);
Reach corners_reach(const BodySegment& body, const Matrix3& corners);

/// n0 and n1 seen from both bodies: coefficient i of the quadratic is offset[i] + min over A of a[i].X - max over B of b[i].X.
struct MovingPlane {
    Vector3 n0, n1;
    std::array<Vector3, 3> a, b;
    std::array<double, 3> offset{};
};

/// Contract: |n0|, |n1| <= 1 (see unit_direction).
MovingPlane moving_plane(const Instant& start, const Instant& end, const Vector3& n0, const Vector3& n1);

/// v / |v|, of length at most 1 in spite of rounding; zero (a plane that bounds nothing) if v is too short to have a direction.
Vector3 unit_direction(const Vector3& v);

using Coefficients = std::array<double, 3>;
Coefficients box_coefficients(const MovingPlane& plane, const contact::HierarchyNode& a, const contact::HierarchyNode& b);
Coefficients corner_coefficients(const MovingPlane& plane, const Matrix3& a, const Matrix3& b);

/// A lower bound, and its value if the bodies' curves were straight and the plane parallel to itself: the difference is what halving
/// the interval can win.
struct SegmentBound {
    double lower = 0;    ///< may be negative: no information but the order of a search
    double at_ends = 0;  ///< min(c0, c2)
};

/// `h`: length of the interval. `deviation_scale` is 1 but in tests that show that a bound without deviation is found out.
SegmentBound segment_bound(const PairSegment& segment, double h, const MovingPlane& plane, const Coefficients& c, const Reach& a,
                           const Reach& b, double deviation_scale = 1);

}  // namespace fettle::core::clearance
