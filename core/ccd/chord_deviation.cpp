// SPDX-License-Identifier: MIT
#include "core/ccd/chord_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/rounding.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::core::ccd {

using geometry::Interval;
using geometry::Interval3;
using kinematics::rotation;

namespace {

constexpr double raised = 1 + 32 * unit_roundoff;

Interval3 exact(const Vector3& v) { return {Interval(v.x()), Interval(v.y()), Interval(v.z())}; }

/// R(theta) Y = Y + sinc(x) theta x Y + 1/2 sinc(x/2)^2 theta x (theta x Y).
Interval3 rotated(const IntervalTurn& turn, const Interval3& Y) {
    const Interval3 once = cross(turn.theta, Y), twice = cross(turn.theta, once);
    Interval3 r;
    for (std::size_t k = 0; k < 3; ++k) r[k] = Y[k] + turn.a * once[k] + turn.b * twice[k];
    return r;
}

IntervalTurn turn_by(const Interval3& theta) {
    const Interval x = sqrt(square(theta[0]) + square(theta[1]) + square(theta[2]));
    return {theta, sinc(x), Interval(0.5) * square(sinc(Interval(0.5) * x))};
}

}  // namespace

double rotated_rounding(double theta_norm, double w_norm, double s_end, double radius) {
    return unit_roundoff * radius * (80 + 4 * theta_norm + 6 * s_end * w_norm);
}

double arc_deviation(const Vector3& theta, const Vector3& w, const Vector3& Y) {
    const double speed = w.norm(), arm = Y.norm();
    const double across = w.cross(Y).norm() + 8 * unit_roundoff * speed * arm;
    const double tilting = theta.cross(w).norm() + 8 * unit_roundoff * theta.norm() * speed;
    return 0.125 * speed * std::min(speed * arm, across + tilting * arm / 3) * raised;
}

double arc_deviation_cubic(const Vector3& theta, const Vector3& w, const Vector3& Y) {
    const double speed = w.norm(), arm = Y.norm();
    const Vector3 start = rotation(theta) * Y, middle = rotation(theta + 0.5 * w) * Y, end = rotation(theta + w) * Y;
    // Three evaluations, of weights 1, 1/2, 1/2; their sums cancel to no more than 4u of the arm.
    const double rounding = 2 * rotated_rounding(theta.norm(), speed, 1, arm) + 4 * unit_roundoff * arm;
    return ((middle - 0.5 * (start + end)).norm() + speed * speed * speed * arm / (72 * 1.7320508075688772)) * raised + rounding;
}

IntervalArc::IntervalArc(const Vector3& theta, const Vector3& w) {
    const Interval3 start = exact(theta);
    Interval3 end, during;
    for (std::size_t k = 0; k < 3; ++k) {
        end[k] = start[k] + Interval(w[k]);
        during[k] = hull(start[k], end[k]);
    }
    start_ = turn_by(start);
    end_ = turn_by(end);
    during_ = turn_by(during);
}

double IntervalArc::deviation(const Vector3& Y) const {
    const Interval3 arm = exact(Y);
    const Interval3 arc = rotated(during_, arm), at_start = rotated(start_, arm), at_end = rotated(end_, arm);
    Interval3 difference;
    for (std::size_t k = 0; k < 3; ++k) difference[k] = arc[k] - hull(at_start[k], at_end[k]);
    const double bound = norm_bound(difference);
    return std::isnan(bound) ? INFINITY : bound;
}

double arc_deviation_interval(const Vector3& theta, const Vector3& w, const Vector3& Y) { return IntervalArc(theta, w).deviation(Y); }

double chord_deviation(const kinematics::PathSegment& segment, const Vector3& X, DeviationBound bound) {
    const Vector3 Y = segment.base * X;
    const Vector3 &theta = segment.rotation_vector_t0, &w = segment.rotation_vector_step;
    // Deviation is linear in the arm, and Y is off by at most 6u |X|: charge what an arm of that length can deviate (B0, or its path).
    const double rounding = 6 * unit_roundoff * X.norm() * std::min(2.0, 0.125 * w.squaredNorm()) * raised;
    if (bound == DeviationBound::interval) return (arc_deviation_interval(theta, w, Y) + rounding) * raised;
    return (std::min(arc_deviation(theta, w, Y), arc_deviation_cubic(theta, w, Y)) + rounding) * raised;
}

}  // namespace fettle::core::ccd
