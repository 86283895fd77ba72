// SPDX-License-Identifier: MIT
/// The certificate checker's own mathematics: rigid motion and the bound of a leaf in interval arithmetic. Used by
/// certificate_checker.cpp alone; nothing here is used by the search.
///
/// Motion. R(s) = exp([theta]) B, theta = theta0 + s w, B the stored base as it is. R' = [omega] R with
///   omega = w + b k + c theta x k,   k = theta x w = theta0 x w,   b = (1 - cos x)/x^2 = sinc(x/2)^2/2,  c = (x - sin x)/x^3,  x =
///   |theta|.
/// As omega is the mean of e^{a [theta]} w over 0 <= a <= 1, |omega'| <= |w||k|/6; and |R^(j) Y| <= |w|^j |Y| (method.md section 7).
///
/// A leaf. Let the interval's middle be m, its half length e, v = (s - m)/e in [-1, 1], N = (n0 + n1)/2, N' = (n1 - n0)/2. By Taylor at m,
///   n.x = sum of v^k (g_k.y + r_k) + rest,   y = R(m) X,
///   g_0 = N,  g_1 = N' + e N x omega,  g_2 = e N' x omega + e^2/2 (N x omega) x omega,  g_3 = e^2/2 (N' x omega) x omega,
///   r_0 = N.q(m),  r_1 = N'.q(m) + e N.q',  r_2 = e N'.q',  r_3 = 0,   |rest| <= |n| |B X| (e^3 |w|^3/6 + e^2 |w||k|/12).
/// In Bernstein form over v each coefficient is linear in X; the least value over a piece of A and the largest over one of B (over the
/// corners of small pieces, over a box otherwise) give a polynomial below n.(x_a - x_b) for all their points. If that, less the rests, is
/// nowhere below lower M, M >= |n0|, |n1|, M > 0, the leaf's claim is proven: dist >= n.(x_a - x_b)/|n| >= lower.
#pragma once

#include <array>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/core/clearance/certificate.hpp"
#include "fettle/core/geometry/interval.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::clearance::checker {

using geometry::Interval;
using geometry::Interval3;
using IntervalMatrix = std::array<Interval3, 3>;  ///< rows

/// One body on one path segment, the stored numbers as they are.
struct BodyPath {
    Matrix3 base = Matrix3::Identity();
    Interval3 theta, step;                            ///< theta0, w
    Interval3 place, drift;                           ///< q at 0, q'
    Interval3 twist;                                  ///< k
    double speed = 0, twist_norm = 0, base_norm = 1;  ///< upper bounds of |w|, |k|, |B|
};

/// Step -1: the start pose, held.
BodyPath body_path(const stepper::Trajectory& trajectory, int step, int segment, int body);

struct IntervalPose {
    IntervalMatrix rotation;  ///< with the base
    Interval3 place;
    Interval3 omega;
};
IntervalPose pose_at(const BodyPath& path, double s);

/// What is bounded, in the body's frame: a box, or (if there are any) some points; `radius` >= |X| of each.
struct Region {
    Vector3 low = Vector3::Zero(), high = Vector3::Zero();
    std::vector<Vector3> points;
    double radius = 0;
};

struct Span {
    double start = 0, end = 1;
};

/// Is n(u).(x_a - x_b) >= lower |n(u)| > 0 proven for all of the span and the regions? `halvings`: how often it may be halved.
bool prove_leaf(const BodyPath& a, const BodyPath& b, const Region& region_a, const Region& region_b, const Span& span,
                const LeafPlane& plane, double lower, int halvings);

/// Interval of the distance at s of two points: sums of weight x corner over the sum of weights.
Interval distance_at(const BodyPath& a, const BodyPath& b, const Interval3& X_a, const Interval3& X_b, double s);

}  // namespace fettle::core::clearance::checker
