// SPDX-License-Identifier: MIT
#include "core/ccd/swept_pair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ccd/chord_deviation.hpp"

namespace fettle::core::ccd {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// y(s) = R_t(s)^T (R_o(s) X + q_o(s) - q_t(s)), |X| <= r, has
//   |y''| <= |w_t|^2 (d + r) + 2 |w_t| (|w_o| r + |dq|) + |w_o|^2 r = |w_t|^2 d + 2 |w_t| |dq| + (|w_t| + |w_o|)^2 r
// with d the largest |q_o - q_t|, at an end, and dq how much it changes. So y is within an eighth of that of its chord.
SeenMotion seen_motion(const SweptBody& of, const SweptBody& to, double margin, double world_size) {
    SeenMotion out;
    std::array<Vector3, 2> offset;
    for (std::size_t e = 0; e < 2; ++e) {
        const Matrix3 back = to.ends[e].rotation.transpose();
        offset[e] = of.ends[e].position - to.ends[e].position;
        out.rotation[e] = back * of.ends[e].rotation;
        out.offset[e] = back * offset[e];
    }
    const double away = std::max(offset[0].norm(), offset[1].norm()), shift = (offset[1] - offset[0]).norm();
    const double both = to.turn + of.turn, eighth = 0.125 * (1 + to.stretch) * (1 + of.stretch) * (1 + 1e-12);
    // Where the axes are not quite orthonormal, its own points are not quite at X, and distances along an axis are not quite distances.
    const double skew = to.stretch * (margin + to.body->radius);
    out.loss_constant = eighth * to.turn * (to.turn * away + 2 * shift) + skew + 2 * to.rounding * away +
                        search_rounding * (world_size + 2 * away + 8 * to.body->radius);
    out.loss_rate = eighth * both * both + 2 * (to.rounding + of.rounding) + 16 * search_rounding;
    if (!std::isfinite(out.loss_constant + out.loss_rate + of.loss + to.loss)) {
        out.loss_constant = unbounded;
        out.loss_rate = 0;
    }
    return out;
}

}  // namespace

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment) {
    SweptBody s{&body, {pose_at(segment, 0), pose_at(segment, 1)}};
    s.turn = segment.rotation_vector_step.norm();
    s.rounding = rotated_rounding(segment.rotation_vector_t0.norm(), s.turn, 1, 1);
    s.stretch = (s.ends[0].rotation.transpose() * s.ends[0].rotation - Matrix3::Identity()).norm() + 4 * s.rounding;
    s.loss = 0.125 * s.turn * s.turn * (1 + 1e-12) + 2 * s.rounding;  // at the ends and in between
    double all = s.loss;
    for (const kinematics::Pose& pose : s.ends) all += pose.rotation.sum() + pose.position.sum();
    if (!std::isfinite(all)) s.loss = unbounded;
    return s;
}

SweptPair swept_pair(const SweptBody& a, const SweptBody& b, double margin) {
    SweptPair pair;
    pair.a = &a;
    pair.b = &b;
    pair.margin = margin;
    pair.reach = a.body->radius + b.body->radius;
    for (std::size_t e = 0; e < 2; ++e) {
        pair.reach += (b.ends[e].position - a.ends[e].position).norm();
        pair.world_size += a.ends[e].position.norm() + b.ends[e].position.norm();
    }
    pair.a_seen_from_b = seen_motion(a, b, margin, pair.world_size);
    pair.b_seen_from_a = seen_motion(b, a, margin, pair.world_size);
    return pair;
}

}  // namespace fettle::core::ccd
