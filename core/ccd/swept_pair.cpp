// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/swept_pair.hpp"

#include <cmath>
#include <limits>

#include "fettle/core/base/four.hpp"
#include "fettle/core/ccd/chord_deviation.hpp"

namespace fettle::core::ccd {
namespace {

using base::Four;

void set_axis(const SweptBody& a, const SweptBody& b, const Vector3& n, std::size_t axis, std::array<SweptAxes, 2>& axes) {
    for (std::size_t e = 0; e < 2; ++e) {
        const Vector3 in_a = a.ends[e].rotation.transpose() * n, in_b = b.ends[e].rotation.transpose() * n;
        for (std::size_t k = 0; k < 3; ++k) {
            axes[e].a[k][axis] = in_a[static_cast<int>(k)];
            axes[e].b[k][axis] = in_b[static_cast<int>(k)];
            axes[e].abs_a[k][axis] = std::abs(in_a[static_cast<int>(k)]);
            axes[e].abs_b[k][axis] = std::abs(in_b[static_cast<int>(k)]);
        }
        axes[e].offset[axis] = n.dot(b.ends[e].position - a.ends[e].position);
    }
}

// Of two boxes along four of the directions: from the middle of a's to that of b's, and how far both reach.
[[gnu::always_inline]] inline void place_boxes(const SweptAxes& axes, std::size_t first, const geometry::HierarchyNode& a,
                                               const geometry::HierarchyNode& b, Four& way, Four& reach) {
    base::load(axes.offset.data() + first, way);
    reach = Four{0, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto of_body = [&](const SweptAxes::Numbers& n, const SweptAxes::Numbers& size, const geometry::HierarchyNode& node,
                                 double sign) {
            Four along, magnitude;
            base::load(n.data() + first, along);
            base::load(size.data() + first, magnitude);
            way += along * (sign * node.center[static_cast<int>(k)]);
            reach += magnitude * node.half_extent[static_cast<int>(k)];
        };
        of_body(axes.b[k], axes.abs_b[k], b, 1);
        of_body(axes.a[k], axes.abs_a[k], a, -1);
    }
}

// True only if the boxes stay farther apart than the margin.
[[gnu::always_inline]] inline bool are_separated(const SweptPair& pair, const geometry::HierarchyNode& a,
                                                 const geometry::HierarchyNode& b) {
    const double bound = pair.margin + pair.deviation(a.radius, b.radius) +
                         search_rounding * (pair.reach + 4 * (a.radius + b.radius + a.half_extent.sum() + b.half_extent.sum()));
    const auto any = [](const auto& which) { return (which[0] | which[1] | which[2] | which[3]) != 0; };
    for (std::size_t first = 0; first < 8; first += base::lanes) {
        Four way, reach;
        place_boxes(pair.axes[0], first, a, b, way, reach);
        const auto is_after = way - reach > bound, is_before = -way - reach > bound;
        if (!any(is_after | is_before)) continue;
        place_boxes(pair.axes[1], first, a, b, way, reach);
        if (any((is_after & (way - reach > bound)) | (is_before & (-way - reach > bound)))) return true;
    }
    return false;
}

[[gnu::always_inline]] inline void descend(const SweptPair& pair, NodePair from, std::size_t most, std::vector<NodePair>& leaves) {
    const auto& nodes_a = pair.a->body->hierarchy->nodes();
    const auto& nodes_b = pair.b->body->hierarchy->nodes();
    std::vector<NodePair> stack{from};
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
}
FETTLE_WIDE void descend_wide(const SweptPair& pair, NodePair from, std::size_t most, std::vector<NodePair>& leaves) {
    descend(pair, from, most, leaves);
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
        set_axis(a, b, a.ends[0].rotation.col(k), static_cast<std::size_t>(k), pair.axes);
        set_axis(a, b, b.ends[0].rotation.col(k), static_cast<std::size_t>(k) + 3, pair.axes);
    }
    for (const int k : {1, 2}) set_axis(a, b, b.ends[0].rotation.col(k), static_cast<std::size_t>(k) + 5, pair.axes);
    for (int e = 0; e < 2; ++e) {
        pair.reach += (b.ends[e].position - a.ends[e].position).norm();
        pair.world_size += a.ends[e].position.norm() + b.ends[e].position.norm();
    }
    return pair;
}

std::vector<NodePair> close_nodes(const SweptPair& pair, NodePair from, std::size_t most) {
    std::vector<NodePair> leaves;
    base::has_wide_instructions() ? descend_wide(pair, from, most, leaves) : descend(pair, from, most, leaves);
    return leaves;
}

}  // namespace fettle::core::ccd
