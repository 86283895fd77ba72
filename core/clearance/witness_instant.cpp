// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/witness_instant.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace fettle::core::clearance {
namespace {

Vector3 angular_rate(const kinematics::PathSegment& path, double s) {
    return kinematics::left_jacobian(path.rotation_vector_t0 + s * path.rotation_vector_step) * path.rotation_vector_step;
}

}  // namespace

TrianglePairDistance placed_distance(const Instant& at, const Matrix3& corners_a, const Matrix3& corners_b) {
    return triangle_pair_distance((at.rotation_a * corners_a).colwise() + at.offset, at.rotation_b * corners_b);
}

double distance_rate(const PairSegment& segment, const Matrix3& corners_a, const Matrix3& corners_b, double s) {
    const Instant at = instant_at(segment, s);
    const TrianglePairDistance pair = placed_distance(at, corners_a, corners_b);
    if (!(pair.distance > 0)) return 0;
    const Vector3 arm_a = pair.point_a - at.offset, arm_b = pair.point_b;
    const Vector3 velocity = angular_rate(segment.a.path, s).cross(arm_a) - angular_rate(segment.b.path, s).cross(arm_b) +
                             (segment.a.path.position_step - segment.b.path.position_step);
    return velocity.dot(pair.difference) / pair.distance;
}

double least_distance_near(const PairSegment& segment, const Matrix3& corners_a, const Matrix3& corners_b, double s) {
    const auto rate = [&](double at) { return distance_rate(segment, corners_a, corners_b, at); };
    const double here = rate(s);
    if (here == 0) return s;
    // Downhill in growing steps until the rate changes sign.
    const double direction = here > 0 ? -1 : 1;
    double inside = s, beyond = s;
    for (double step = 0x1p-24;; step *= 4) {
        beyond = std::clamp(s + direction * step, 0.0, 1.0);
        if (rate(beyond) * here <= 0) break;
        if (beyond == 0 || beyond == 1) return beyond;
        inside = beyond;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + beyond);
        if (middle == inside || middle == beyond) break;
        (rate(middle) * here > 0 ? inside : beyond) = middle;
    }
    return 0.5 * (inside + beyond);
}

}  // namespace fettle::core::clearance
