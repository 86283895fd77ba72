// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/swept_pair.hpp"

#include <cmath>
#include <limits>

#include "fettle/core/ccd/chord_deviation.hpp"

namespace fettle::core::ccd {
namespace {

SweptAxis swept_axis(const SweptBody& a, const SweptBody& b, const Vector3& n) {
    SweptAxis axis;
    for (int e = 0; e < 2; ++e) {
        axis.a[e] = a.ends[e].rotation.transpose() * n;
        axis.b[e] = b.ends[e].rotation.transpose() * n;
        axis.abs_a[e] = axis.a[e].cwiseAbs();
        axis.abs_b[e] = axis.b[e].cwiseAbs();
        axis.offset[e] = n.dot(b.ends[e].position - a.ends[e].position);
    }
    return axis;
}

// True only if the boxes stay farther apart than the margin.
bool are_separated(const SweptPair& pair, const geometry::HierarchyNode& a, const geometry::HierarchyNode& b) {
    const double bound = pair.margin + pair.deviation(a.radius, b.radius) +
                         search_rounding * (pair.reach + 4 * (a.radius + b.radius + a.half_extent.sum() + b.half_extent.sum()));
    for (const SweptAxis& n : pair.axes) {
        const double t0 = n.offset[0] + n.b[0].dot(b.center) - n.a[0].dot(a.center);
        const double e0 = n.abs_a[0].dot(a.half_extent) + n.abs_b[0].dot(b.half_extent);
        if (std::abs(t0) - e0 <= bound) continue;
        const double t1 = n.offset[1] + n.b[1].dot(b.center) - n.a[1].dot(a.center);
        const double e1 = n.abs_a[1].dot(a.half_extent) + n.abs_b[1].dot(b.half_extent);
        if (std::copysign(1.0, t0) * t1 - e1 > bound) return true;
    }
    return false;
}

}  // namespace

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment) {
    const double turn = segment.rotation_vector_step.norm();
    SweptBody s{&body, {pose_at(segment, 0), pose_at(segment, 1)}, 0, turn == 0 && segment.position_step.isZero(0)};
    // At the ends and in between.
    s.loss = 0.125 * turn * turn * (1 + 1e-12) + 2 * rotated_rounding(segment.rotation_vector_t0.norm(), turn, 1, 1);
    double all = s.loss;
    for (const kinematics::Pose& pose : s.ends) all += pose.rotation.sum() + pose.position.sum();
    if (!std::isfinite(all)) s.loss = std::numeric_limits<double>::infinity();
    return s;
}

SweptPair swept_pair(const SweptBody& a, const SweptBody& b, double margin) {
    SweptPair pair{&a, &b, margin, {}, 0, a.body->radius + b.body->radius};
    for (int k = 0; k < 3; ++k) {
        pair.axes[k] = swept_axis(a, b, a.ends[0].rotation.col(k));
        pair.axes[k + 3] = swept_axis(a, b, b.ends[0].rotation.col(k));
    }
    for (int e = 0; e < 2; ++e) {
        pair.reach += (b.ends[e].position - a.ends[e].position).norm();
        pair.world_size += a.ends[e].position.norm() + b.ends[e].position.norm();
    }
    return pair;
}

std::vector<NodePair> close_nodes(const SweptPair& pair, NodePair from, std::size_t most) {
    const auto& nodes_a = pair.a->body->hierarchy->nodes();
    const auto& nodes_b = pair.b->body->hierarchy->nodes();
    std::vector<NodePair> stack{from}, leaves;
    while (!stack.empty() && (most == 0 || stack.size() + leaves.size() < most)) {
        const auto [i, j] = stack.back();
        stack.pop_back();
        const geometry::HierarchyNode &a = nodes_a[i], &b = nodes_b[j];
        if (are_separated(pair, a, b)) continue;
        if (a.is_leaf() && b.is_leaf()) {
            leaves.push_back({i, j});
        } else if (b.is_leaf() || (!a.is_leaf() && a.half_extent.sum() >= b.half_extent.sum())) {
            stack.push_back({a.right, j});
            stack.push_back({a.left, j});
        } else {
            stack.push_back({i, b.right});
            stack.push_back({i, b.left});
        }
    }
    leaves.insert(leaves.end(), stack.begin(), stack.end());
    return leaves;
}

}  // namespace fettle::core::ccd
