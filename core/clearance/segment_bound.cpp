// SPDX-License-Identifier: MIT
#include "core/clearance/segment_bound.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

// Upper bound of max |n.x'''| over the segment.
double third_derivative(const BodySegment& body, const Vector3& n, const Reach& reach) {
    if (body.speed == 0) return 0;
    const double y = body.base_norm * reach.radius;
    const double w = body.speed, k = body.twist;
    const double nw = n.cross(body.path.rotation_vector_step).norm() + 8 * unit_roundoff * w;
    const double along_n = nw * reach.swept + k * ((reach.swept + nw * y) / 4 + k * y / 20);
    return w * std::min(along_n, w * w * y) * rounded_up;
}

}  // namespace

// Lower bound of the cubic on [0, 1], equal to its least value up to rounding: the hull of its coefficients, after a split at the least
// value if that is inside. Where the split lies is of no consequence for the bound's truth.
double least_value(const Coefficients& c, double& dip) {
    if (!std::isfinite(c[0] + c[1] + c[2] + c[3])) return -std::numeric_limits<double>::infinity();  // std::min would lose a NaN
    const double ends = std::min(c[0], c[3]);
    if (c[1] >= ends && c[2] >= ends) return ends;
    // The derivative is 3 times the parabola with coefficients p, q, r; it rises through 0 where the cubic is least.
    const double p = c[1] - c[0], q = c[2] - c[1], r = c[3] - c[2], curvature = p - 2 * q + r;
    const double root = std::sqrt(std::max(0.0, q * q - p * r));
    const double t = q - p + root > 0 ? -p / (q - p + root) : (curvature != 0 ? (p - q + root) / curvature : 0.5);
    if (!(t > 0 && t < 1)) return std::min({ends, c[1], c[2]});
    const auto between = [t](double x, double y) { return x + t * (y - x); };
    const double a0 = between(c[0], c[1]), a1 = between(c[1], c[2]), a2 = between(c[2], c[3]);
    const double b0 = between(a0, a1), b1 = between(a1, a2), value = between(b0, b1);
    const double least = std::min({ends, a0, b0, value, b1, a2});
    if (value < ends) dip = t;
    return least;
}

BodySegment body_segment(const kinematics::PathSegment& path) {
    BodySegment body;
    body.path = path;
    const Vector3& w = path.rotation_vector_step;
    body.speed = w.norm() * rounded_up;
    body.twist = path.rotation_vector_t0.cross(w).norm() * rounded_up + 8 * unit_roundoff * path.rotation_vector_t0.norm() * body.speed;
    // |B|^2 is the largest eigenvalue of B^T B, at most 1 + |B^T B - I|.
    const double excess = (path.base.transpose() * path.base - Matrix3::Identity()).norm();
    body.base_norm = std::sqrt(1 + excess) * rounded_up;
    body.rounding = (160 + 48 * (path.rotation_vector_t0.norm() + body.speed)) * unit_roundoff;
    body.extent = path.position_t0.norm() + path.position_step.norm();
    body.poses[0] = path.rotation_vector_t0.isZero(0) ? kinematics::Pose{path.base, path.position_t0} : kinematics::pose_at(path, 0);
    const bool still = body.speed == 0 && path.position_step == Vector3::Zero();
    body.poses[1] = still ? body.poses[0] : kinematics::pose_at(path, 0.5);
    body.poses[2] = still ? body.poses[0] : kinematics::pose_at(path, 1);
    return body;
}

PairSegment pair_segment(const BodySegment& a, const BodySegment& b, double radius_a, double radius_b) {
    PairSegment pair;
    pair.a = {std::shared_ptr<const BodySegment>{}, &a};  // owns nothing, counts nothing
    pair.b = {std::shared_ptr<const BodySegment>{}, &b};
    const double ra = 2 * radius_a * a.base_norm, rb = 2 * radius_b * b.base_norm;
    const double p = a.extent + b.extent;
    pair.slack = ((a.rounding + 48 * unit_roundoff) * ra + (b.rounding + 48 * unit_roundoff) * rb + 24 * unit_roundoff * p) * rounded_up +
                 std::numeric_limits<double>::min();
    return pair;
}

PairSegment pair_segment(const kinematics::PathSegment& a, const kinematics::PathSegment& b, double radius_a, double radius_b) {
    const auto own_a = std::make_shared<const BodySegment>(body_segment(a)), own_b = std::make_shared<const BodySegment>(body_segment(b));
    PairSegment pair = pair_segment(*own_a, *own_b, radius_a, radius_b);
    pair.a = own_a;
    pair.b = own_b;
    return pair;
}

PairSegment pair_held(const kinematics::Pose& a, const kinematics::Pose& b, double radius_a, double radius_b) {
    kinematics::PathSegment held_a, held_b;
    held_a.base = a.rotation;
    held_a.position_t0 = a.position;
    held_b.base = b.rotation;
    held_b.position_t0 = b.position;
    return pair_segment(held_a, held_b, radius_a, radius_b);
}

PairSegment held_at(const PairSegment& segment, double s, double radius_a, double radius_b) {
    return pair_held(kinematics::pose_at(segment.a->path, s), kinematics::pose_at(segment.b->path, s), radius_a, radius_b);
}

Instant instant_at(const PairSegment& segment, double s) {
    const auto pose = [&](const BodySegment& body) {
        if (s == 0 || s == 0.5 || s == 1) return body.poses[2 * s];
        return kinematics::pose_at(body.path, s);
    };
    const kinematics::Pose a = pose(*segment.a), b = pose(*segment.b);
    return {s, a.rotation, b.rotation, a.position - b.position};
}

Reach corners_reach(const BodySegment& body, const Matrix3& corners) {
    const double radius = std::sqrt(corners.colwise().squaredNorm().maxCoeff()) * rounded_up;
    const Matrix3 sweep = cross_matrix(body.path.rotation_vector_step) * body.path.base;  // |w x base X| = |sweep X|
    const double swept = std::sqrt((sweep * corners).colwise().squaredNorm().maxCoeff());
    return {radius, (swept + 32 * unit_roundoff * body.speed * body.base_norm * radius) * rounded_up};
}

Vector3 unit_direction(const Vector3& v) {
    const double length = v.norm();
    if (!(length > 1e-140)) return Vector3::Zero();  // its square would be subnormal
    return v * ((1 - 8 * unit_roundoff) / length);
}

MovingPlane moving_plane(const Instant& start, const Instant& middle, const Instant& end, const Vector3& n0, const Vector3& n1) {
    MovingPlane plane{n0, n1, {}, {}, {}};
    const Vector3 turn = (1.0 / 3) * (n1 - n0), third0 = (1.0 / 3) * n0, third1 = (1.0 / 3) * n1;
    const auto seen_from = [&](const Matrix3& r0, const Matrix3& rm, const Matrix3& r1, std::array<Vector3, 4>& out) {
        out[0] = r0.transpose() * n0;
        out[3] = r1.transpose() * n1;
        out[1] = r0.transpose() * turn + (4 * rm - r1).transpose() * third0;
        out[2] = (4 * rm - r0).transpose() * third1 - r1.transpose() * turn;
    };
    seen_from(start.rotation_a, middle.rotation_a, end.rotation_a, plane.a);
    seen_from(start.rotation_b, middle.rotation_b, end.rotation_b, plane.b);
    plane.offset = {n0.dot(start.offset), turn.dot(start.offset) + third0.dot(4 * middle.offset - end.offset),
                    third1.dot(4 * middle.offset - start.offset) - turn.dot(end.offset), n1.dot(end.offset)};
    return plane;
}

Coefficients corner_coefficients(const MovingPlane& plane, const Matrix3& a, const Matrix3& b) {
    Coefficients c{};
    for (std::size_t i = 0; i < 4; ++i) {
        const double low = (plane.a[i].transpose() * a).minCoeff();
        const double high = (plane.b[i].transpose() * b).maxCoeff();
        c[i] = plane.offset[i] + (low - high);
    }
    return c;
}

SegmentBound segment_bound(const PairSegment& segment, double h, const MovingPlane& plane, const Coefficients& c, const ReachPair& reach) {
    const auto& [a, b] = reach;
    const double rest_a = std::max(third_derivative(*segment.a, plane.n0, a), third_derivative(*segment.a, plane.n1, a));
    const double rest_b = std::max(third_derivative(*segment.b, plane.n0, b), third_derivative(*segment.b, plane.n1, b));
    const double rest = h * h * h * (rest_a + rest_b) * (rounded_up / 36) + 2 * segment.slack;
    SegmentBound bound;
    bound.at_ends = least_of(c[0], c[3]);
    bound.lower = h > 0 ? least_value({c[0], c[1] - rest, c[2] - rest, c[3]}, bound.dip) : bound.at_ends;
    bound.lower -= segment.slack;
    return bound;
}

}  // namespace fettle::core::clearance
