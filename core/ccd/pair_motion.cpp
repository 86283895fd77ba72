// SPDX-License-Identifier: MIT
#include "core/ccd/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ccd/swept_pair.hpp"

namespace fettle::core::ccd {
namespace {

using kinematics::PathSegment;
using kinematics::Pose;

constexpr double slack = 1 + 1e-12;  // of sums of a few products

// |R1 - R2|_F / sqrt 2 bounds |(R1 - R2) X| / |X|.
double turn(const Matrix3& r1, const Matrix3& r2) { return (r1 - r2).norm() * std::sqrt(0.5); }

// Where two bodies are to one another, in one chart: differences of two such points are linear along segments, and the sum of the norms of
// such a difference's parts bounds how much nearer their points are.
struct PairPoint {
    Vector3 offset, arc_a, arc_b;  // [m]
    double norm() const { return offset.norm() + arc_a.norm() + arc_b.norm(); }
    double dot(const PairPoint& o) const { return offset.dot(o.offset) + arc_a.dot(o.arc_a) + arc_b.dot(o.arc_b); }
};

PairPoint difference(const PairPoint& x, const PairPoint& y, double share = 1) {
    return {x.offset - share * y.offset, x.arc_a - share * y.arc_a, x.arc_b - share * y.arc_b};
}

PairPoint pair_point(const PathSegment& a, const PathSegment& b, double t, double radius_a, double radius_b) {
    return {a.position_t0 - b.position_t0 + t * (a.position_step - b.position_step),
            radius_a * (a.rotation_vector_t0 + t * a.rotation_vector_step), radius_b * (b.rotation_vector_t0 + t * b.rotation_vector_step)};
}

// The point of the segments that is about nearest to where two bodies are.
double nearest_fraction(const std::array<PathSegment, 2>& along, const Pose& a, const Pose& b, double radius_a, double radius_b) {
    // For small turns the rotation vector from one to the other.
    const auto turned = [](const Pose& pose, const PathSegment& s) {
        const Matrix3 way = pose.rotation * (kinematics::rotation(s.rotation_vector_t0) * s.base).transpose();
        return Vector3(0.5 * Vector3(way(2, 1) - way(1, 2), way(0, 2) - way(2, 0), way(1, 0) - way(0, 1)));
    };
    const PairPoint start = pair_point(along[0], along[1], 0, radius_a, radius_b);
    const PairPoint step = difference(pair_point(along[0], along[1], 1, radius_a, radius_b), start);
    const PairPoint off{a.position - b.position - start.offset, radius_a * turned(a, along[0]), radius_b * turned(b, along[1])};
    const double square = step.dot(step);
    return square > 0 ? std::clamp(off.dot(step) / square, 0.0, 1.0) : 0.0;
}

// How far two bodies are from where the segments have them at t.
double distance_from(const std::array<PathSegment, 2>& along, double t, const Pose& a, const Pose& b, double radius_a, double radius_b) {
    const Pose at_a = pose_at(along[0], t), at_b = pose_at(along[1], t);
    return slack * ((a.position - b.position - (at_a.position - at_b.position)).norm() + turn(a.rotation, at_a.rotation) * radius_a +
                    turn(b.rotation, at_b.rotation) * radius_b) +
           rounding_of(a, b, radius_a, radius_b) + rounding_of(at_a, at_b, radius_a, radius_b);
}

}  // namespace

// Bound of how far points of two bodies move relative to one another along their segments.
double most_relative_motion(const PathSegment& a, const PathSegment& b, double radius_a, double radius_b) {
    return slack * ((a.position_step - b.position_step).norm() + a.rotation_vector_step.norm() * radius_a +
                    b.rotation_vector_step.norm() * radius_b);
}

// The same between two pairs of poses: distances of points do not change when both bodies move alike, so the least of what is seen from
// the world and from each body holds.
double most_relative_motion(const Pose& a1, const Pose& b1, const Pose& a2, const Pose& b2, double radius_a, double radius_b) {
    const Vector3 offset1 = b1.position - a1.position, offset2 = b2.position - a2.position;
    double least = (offset2 - offset1).norm() + turn(a1.rotation, a2.rotation) * radius_a + turn(b1.rotation, b2.rotation) * radius_b;
    const Matrix3 relative1 = a1.rotation.transpose() * b1.rotation, relative2 = a2.rotation.transpose() * b2.rotation;
    const double turned = turn(relative1, relative2);
    least = std::min(least, (a2.rotation.transpose() * offset2 - a1.rotation.transpose() * offset1).norm() + turned * radius_b);
    least = std::min(least, (b2.rotation.transpose() * offset2 - b1.rotation.transpose() * offset1).norm() + turned * radius_a);
    return slack * least;
}

// Distances are taken at rounded vertices.
double rounding_of(const Pose& a, const Pose& b, double radius_a, double radius_b) {
    return search_rounding * (a.position.norm() + b.position.norm() + radius_a + radius_b);
}

// How far two bodies on the segments a and b are from where they were somewhere along `from`, in the same chart. Each end is held against
// the point that is about nearest, and the way between against the way between those: their difference is convex, largest at an end.
double deviation_in_chart(const std::array<PathSegment, 2>& from, const PathSegment& a, const PathSegment& b, double radius_a,
                          double radius_b) {
    if (from[0].base != a.base || from[1].base != b.base) return std::numeric_limits<double>::infinity();
    const PairPoint start = pair_point(from[0], from[1], 0, radius_a, radius_b);
    const PairPoint step = difference(pair_point(from[0], from[1], 1, radius_a, radius_b), start);
    const double square = step.dot(step);
    double largest = 0;
    for (const double t : {0.0, 1.0}) {
        const PairPoint off = difference(pair_point(a, b, t, radius_a, radius_b), start);
        const double nearest = square > 0 ? std::clamp(off.dot(step) / square, 0.0, 1.0) : 0.0;
        const double distance = difference(off, step, nearest).norm();
        if (!(distance <= largest)) largest = distance;
        if (std::isnan(largest)) break;
    }
    return slack * largest;
}

// As deviation(), whatever the charts: in space turning arms leave their chords, on either way.
double deviation_in_space(const std::array<PathSegment, 2>& from, const PathSegment& a, const PathSegment& b, double radius_a,
                          double radius_b) {
    std::array<double, 2> nearest;
    double largest = 0;
    for (std::size_t e = 0; e < 2; ++e) {
        const auto s = static_cast<double>(e);
        const Pose at_a = pose_at(a, s), at_b = pose_at(b, s);
        nearest[e] = nearest_fraction(from, at_a, at_b, radius_a, radius_b);
        const double distance = distance_from(from, nearest[e], at_a, at_b, radius_a, radius_b);
        if (!(distance <= largest)) largest = distance;
        if (std::isnan(largest)) return largest;
    }
    const double share = (nearest[1] - nearest[0]) * (nearest[1] - nearest[0]);
    const auto bend = [&](const PathSegment& own, const PathSegment& other) {
        constexpr double skew = 1 + 1e-5;  // of axes that are not quite orthonormal
        return skew * 0.125 * (own.rotation_vector_step.squaredNorm() + share * other.rotation_vector_step.squaredNorm());
    };
    return largest + bend(a, from[0]) * radius_a + bend(b, from[1]) * radius_b;
}

}  // namespace fettle::core::ccd
