// SPDX-License-Identifier: MIT
/// All pairs of overlapping boxes among many, by one bounding volume tree that is thrown away after use: what mesh checks need.
/// Trees of moving bodies are geometry/body_hierarchy.hpp.
#pragma once

#include <functional>
#include <vector>

#include "fettle/core/base/types.hpp"

namespace fettle::core::geometry {

struct Box {
    Vector3 low, high;

    /// Touching counts.
    bool overlaps(const Box& other) const { return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all(); }
    bool contains(const Vector3& x) const { return (low.array() <= x.array()).all() && (x.array() <= high.array()).all(); }
};

/// Calls visit(i, j), i < j, once for every overlapping pair, until it returns false. The order of the calls depends on the boxes alone.
/// O(n log n + pairs) for the boxes of a usual mesh. Contract: finite boxes with low <= high.
void visit_overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& visit);

}  // namespace fettle::core::geometry
