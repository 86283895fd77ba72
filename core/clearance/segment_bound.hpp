// SPDX-License-Identifier: MIT
/// Lower bounds of the distance of two moving convex pieces (boxes of a hierarchy, or elements) over an interval of one path segment.
/// The search that uses them: pair_search.hpp.
///
/// The moving plane. Let the interval be s0 <= s <= s1, u = (s - s0)/(s1 - s0), h = s1 - s0. For any vectors |n0|, |n1| <= 1 put
/// n(u) = (1 - u) n0 + u n1, so |n(u)| <= 1 and dist(A, B) >= n(u).(x_a - x_b) for the closest points x_a, x_b, that is
///   dist >= min over points a of A, b of B of f_ab(u),   f_ab(u) = n(u).(x_a(u) - x_b(u)).
/// A point's curve is the parabola through its places at u = 0, 1/2, 1 plus a rest e(u): with d = x_a - x_b at these places f_ab is a
/// cubic in Bernstein form plus n(u).(e_a - e_b), with D = 2 d(1/2) - (d(0) + d(1))/2:
///   c0 = n0.d(0),  c1 = (n1.d(0) + 2 n0.D)/3,  c2 = (n0.d(1) + 2 n1.D)/3,  c3 = n1.d(1).
/// Each coefficient is linear in (X_a, X_b): its least value over two convex pieces is a difference of support functions. Bernstein
/// polynomials are not negative, so the least coefficients bound every f_ab. By the error of interpolation
///   |n.e(u)| <= |u (u - 1/2)(u - 1)|/6 h^3 M <= u (1 - u) h^3 M / 12,   M = max |n.x'''| over the interval,
/// and u (1 - u) has the coefficients 0, 1/3, 1/3, 0. Hence with exact arithmetic, M = M_a + M_b,
///   dist >= min over u of the cubic with coefficients c0, c1 - h^3 M/36, c2 - h^3 M/36, c3.
/// With n0, n1 the directions of the closest points at the ends, c0 and c3 are the distances there, and the loss in between is third order
/// in h for faces that slide and tilt, and the distance times the squared angle of n0 and n1 over 8: where the distance is monotone
/// the bound is its value at an end.
///
/// The third derivative along n. With phi = theta0 + s w, R''' is the mean of e^{a phi}[w] e^{b phi}[w] e^{c phi}[w] e^{d phi} over the
/// simplex a + b + c + d = 1, a, b, c, d >= 0 (Duhamel), where the means of a and d are 1/4 and that of a d is 1/20. As
/// |e^{a phi} w - w| <= a k, k = |theta0 x w|, |[w] e^{-a phi} n| <= |n x w| + a k and |[w] e^{d phi} Y| <= |w x Y| + d k |Y|. So
///   |n.x'''| <= |w| (|n x w||w x Y| + k(|w x Y| + |n x w||Y|)/4 + k^2 |Y|/20),   and   |n.x'''| <= |w|^3 |Y|,   Y = base X.
/// Both are convex in n: the larger of their values at n0 and n1 holds for n(u). A base that is a rotation up to rounding only is no
/// exception: Y is what the rotations act on.
///
/// Rounding (u = 2^-53; norms; r = twice the body's radius, which bounds the corners of its boxes; P = sum of |q_t0| + |q_step| of both
/// bodies):
///   pose: phi = theta0 + s w is off by <= 3u(|theta0| + |w|); rotation() by (90 + 38|phi|)u (half-angle sine and cosine to an ulp, x =
///   |phi| to 2.5 ulp, three terms an entry, nine entries); the product with the base by 9u; in all (160 + 48(|theta0| + |w|))u on R, and
///   4uP on q_a - q_b;
///   functionals R^T n and their dot products with X, supports of boxes and pucks: 24u r a body; with q_a - q_b: 4uP; sums of coefficients
///   and the least value of the cubic: 16u(r_a + r_b + P).
/// PairSegment::slack is the sum of all that, and of the like terms of a distance evaluated from rounded vertices. It is charged to every
/// bound, and twice more to c1 and c2: |D| and its error are three times those of a place, |d(0)|/3 + 2|D|/3 at most 7/3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "core/clearance/piece_tree.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::clearance {

/// A body on one path segment, with what its bounds need.
struct BodySegment {
    kinematics::PathSegment path;
    std::array<kinematics::Pose, 3> poses;  ///< at s = 0, 1/2, 1
    double speed = 0;                       ///< |w|, rounded up
    double twist = 0;                       ///< k = |theta0 x w|, rounded up
    double base_norm = 1;                   ///< >= the norm of the stored base, which is a rotation up to rounding only
    double rounding = 0;                    ///< how far a computed rotation may be off, by norm: see the top of the file
    double extent = 0;                      ///< |q_t0| + |q_step| [m]
};

/// A pair of bodies on one path segment.
struct PairSegment {
    int step = -1, segment = 0;  ///< -1: the start pose, held
    std::shared_ptr<const BodySegment> a, b;
    double slack = 0;  ///< [m] see the top of the file
};

/// Both bodies at one parameter, relative to body b's reference point.
struct Instant {
    double s = 0;
    Matrix3 rotation_a, rotation_b;
    Vector3 offset;  ///< q_a - q_b
};

BodySegment body_segment(const kinematics::PathSegment& path);
/// Refers to both bodies' segments, which must outlive it: a body's is shared by all its pairs.
PairSegment pair_segment(const BodySegment& a, const BodySegment& b, double radius_a, double radius_b);
/// Keeps what it is made of.
PairSegment pair_segment(const kinematics::PathSegment& a, const kinematics::PathSegment& b, double radius_a, double radius_b);
/// Both bodies at rest.
PairSegment pair_held(const kinematics::Pose& a, const kinematics::Pose& b, double radius_a, double radius_b);
/// Both bodies at rest where they are at parameter `s`.
PairSegment held_at(const PairSegment& segment, double s, double radius_a, double radius_b);
Instant instant_at(const PairSegment& segment, double s);

/// How far a piece reaches: |X| <= radius and |w x base X| <= swept for its points.
struct Reach {
    double radius = 0, swept = 0;
};
Reach corners_reach(const BodySegment& body, const Matrix3& corners);

/// n0 and n1 seen from both bodies: coefficient i of the cubic is offset[i] + min over A of a[i].X - max over B of b[i].X.
struct MovingPlane {
    Vector3 n0, n1;
    std::array<Vector3, 4> a, b;
    std::array<double, 4> offset{};
};

/// Contract: |n0|, |n1| <= 1 (see unit_direction); the instants are those at u = 0, 1/2 and 1.
MovingPlane moving_plane(const Instant& start, const Instant& middle, const Instant& end, const Vector3& n0, const Vector3& n1);

/// v / |v|, of length at most 1 in spite of rounding; zero (a plane that bounds nothing) if v is too short to have a direction.
Vector3 unit_direction(const Vector3& v);

using Coefficients = std::array<double, 4>;
Coefficients corner_coefficients(const MovingPlane& plane, const Matrix3& a, const Matrix3& b);

/// The lesser of two bounds; NaN if one is, as std::min is not.
inline double least_of(double x, double y) { return std::isunordered(x, y) ? std::numeric_limits<double>::quiet_NaN() : std::min(x, y); }

/// Least value on [0, 1] of the cubic with these Bernstein coefficients, from below, equal up to rounding; `dip` is set to its place if
/// that is inside. Minus infinity if a coefficient is not finite.
double least_value(const Coefficients& c, double& dip);

/// A lower bound, and its value if the distance were monotone: the difference is what halving the interval can win.
struct SegmentBound {
    double lower = 0;    ///< may be negative: no information but the order of a search
    double at_ends = 0;  ///< min(c0, c3)
    double dip = -1;     ///< u where the cubic is least, if that is inside
};

struct ReachPair {
    Reach a, b;
};

/// `h`: length of the interval.
SegmentBound segment_bound(const PairSegment& segment, double h, const MovingPlane& plane, const Coefficients& c, const ReachPair& reach);

}  // namespace fettle::core::clearance
