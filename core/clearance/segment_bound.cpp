// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/segment_bound.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::clearance {
namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double rounded_up = 1 + 64 * unit_roundoff;  // covers the few dozen operations of any formula below

BodySegment body_segment(const kinematics::PathSegment& path) {
    BodySegment body;
    body.path = path;
    const Vector3& w = path.rotation_vector_step;
    body.sweep = cross_matrix(w) * path.base;
    body.sweep_columns = body.sweep.colwise().norm();
    body.speed = w.norm() * rounded_up;
    body.twist = path.rotation_vector_t0.cross(w).norm() * rounded_up + 8 * unit_roundoff * path.rotation_vector_t0.norm() * body.speed;
    // |B|^2 is the largest eigenvalue of B^T B, at most 1 + |B^T B - I|.
    const double excess = (path.base.transpose() * path.base - Matrix3::Identity()).norm();
    body.base_norm = std::sqrt(1 + excess) * rounded_up;
    return body;
}

// Upper bound of max |n.x''| / 8 over the segment.
double bending(const BodySegment& body, const Vector3& n, const Reach& reach) {
    if (body.speed == 0) return 0;
    const double y = body.base_norm * reach.radius;
    const double w = body.speed, k = body.twist;
    const double nw = n.cross(body.path.rotation_vector_step).norm() + 8 * unit_roundoff * w;
    const double along_n = nw * reach.swept + k * ((reach.swept + nw * y) / 3 + k * y / 12);
    return std::min(along_n, w * w * y) / 8 * rounded_up;
}

double pose_error(const BodySegment& body) {
    const double angle = body.path.rotation_vector_t0.norm() + body.speed;
    return (160 + 48 * angle) * unit_roundoff;
}

}  // namespace

PairSegment pair_segment(const kinematics::PathSegment& a, const kinematics::PathSegment& b, double radius_a, double radius_b) {
    PairSegment pair;
    pair.a = body_segment(a);
    pair.b = body_segment(b);
    const double ra = 2 * radius_a * pair.a.base_norm, rb = 2 * radius_b * pair.b.base_norm;
    const double p = a.position_t0.norm() + a.position_step.norm() + b.position_t0.norm() + b.position_step.norm();
    pair.slack =
        ((pose_error(pair.a) + 32 * unit_roundoff) * ra + (pose_error(pair.b) + 32 * unit_roundoff) * rb + 24 * unit_roundoff * p) *
            rounded_up +
        std::numeric_limits<double>::min();
    return pair;
}

Instant instant_at(const PairSegment& segment, double s) {
    const kinematics::Pose a = kinematics::pose_at(segment.a.path, s), b = kinematics::pose_at(segment.b.path, s);
    return {s, a.rotation, b.rotation, a.rotation.transpose() * b.rotation, a.position - b.position};
}

Reach box_reach(const BodySegment& body, const contact::HierarchyNode& box) {
    const double swept = (body.sweep * box.center).norm() + body.sweep_columns.dot(box.half_extent);
    return {box.radius, (swept + 32 * unit_roundoff * body.speed * body.base_norm * 2 * box.radius) * rounded_up};
}

Reach corners_reach(const BodySegment& body, const Matrix3& corners) {
    const double radius = std::sqrt(corners.colwise().squaredNorm().maxCoeff()) * rounded_up;
    const double swept = std::sqrt((body.sweep * corners).colwise().squaredNorm().maxCoeff());
    return {radius, (swept + 32 * unit_roundoff * body.speed * body.base_norm * radius) * rounded_up};
}

Vector3 unit_direction(const Vector3& v) {
    const double length = v.norm();
    if (!(length > 1e-140)) return Vector3::Zero();  // its square would be subnormal
    return v * ((1 - 8 * unit_roundoff) / length);
}

MovingPlane moving_plane(const Instant& start, const Instant& end, const Vector3& n0, const Vector3& n1) {
    MovingPlane plane{n0, n1, {}, {}, {}};
    plane.a[0] = start.rotation_a.transpose() * n0;
    plane.b[0] = start.rotation_b.transpose() * n0;
    plane.a[2] = end.rotation_a.transpose() * n1;
    plane.b[2] = end.rotation_b.transpose() * n1;
    plane.a[1] = 0.5 * (end.rotation_a.transpose() * n0 + start.rotation_a.transpose() * n1);
    plane.b[1] = 0.5 * (end.rotation_b.transpose() * n0 + start.rotation_b.transpose() * n1);
    plane.offset = {n0.dot(start.offset), 0.5 * (n0.dot(end.offset) + n1.dot(start.offset)), n1.dot(end.offset)};
    return plane;
}

Coefficients box_coefficients(const MovingPlane& plane, const contact::HierarchyNode& a, const contact::HierarchyNode& b) {
    Coefficients c{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double low = plane.a[i].dot(a.center) - plane.a[i].cwiseAbs().dot(a.half_extent);
        const double high = plane.b[i].dot(b.center) + plane.b[i].cwiseAbs().dot(b.half_extent);
        c[i] = plane.offset[i] + (low - high);
    }
    return c;
}

Coefficients corner_coefficients(const MovingPlane& plane, const Matrix3& a, const Matrix3& b) {
    Coefficients c{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double low = (plane.a[i].transpose() * a).minCoeff();
        const double high = (plane.b[i].transpose() * b).maxCoeff();
        c[i] = plane.offset[i] + (low - high);
    }
    return c;
}

SegmentBound segment_bound(const PairSegment& segment, double h, const MovingPlane& plane, const Coefficients& c, const Reach& a,
                           const Reach& b, double deviation_scale) {
    const double bend_a = std::max(bending(segment.a, plane.n0, a), bending(segment.a, plane.n1, a));
    const double bend_b = std::max(bending(segment.b, plane.n0, b), bending(segment.b, plane.n1, b));
    const double deviation = deviation_scale * h * h * (bend_a + bend_b);
    const double middle = c[1] - 2 * deviation;
    SegmentBound bound;
    bound.at_ends = std::min(c[0], c[2]);
    bound.lower = bound.at_ends;
    const double e = c[0] - middle, f = c[2] - middle;
    // Least value of the quadratic: inside only if it falls at both ends.
    if (h > 0 && e > 0 && f > 0) bound.lower = middle + e * (f / (e + f));
    bound.lower -= segment.slack;
    return bound;
}

}  // namespace fettle::core::clearance
