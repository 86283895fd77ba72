// SPDX-License-Identifier: MIT
/// Which of some hundreds or thousands of boxes come near each other: by a sweep along the axis on which they lie farthest apart, each box
/// against those that begin before it ends, four at a time. For boxes that are spread out, such as bodies; O(n^2) where all overlap along
/// that axis. Trees of boxes: overlapping_boxes.hpp, body_hierarchy.hpp.
#pragma once

#include <utility>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

struct Box {
    Vector3 low, high;

    /// Touching counts.
    bool overlaps(const Box& other) const { return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all(); }
    bool contains(const Vector3& x) const { return (low.array() <= x.array()).all() && (x.array() <= high.array()).all(); }
};

class BoxSweep {
public:
    using Pairs = std::vector<std::pair<int, int>>;

    /// A sweep over these of the boxes. Contract: no end is a NaN.
    BoxSweep(const std::vector<Box>& boxes, std::vector<int> some);

    /// Adds the pairs (i, j), i < j, of boxes whose gap along no axis is at least `reach`, as far as they are found from those that are
    /// `begin` to `end` - 1 in the sweep; each pair is found from one of them. In an order that the boxes alone determine.
    void find(int begin, int end, double reach, Pairs& out) const;

private:
    struct Ends;

    std::vector<int> order_;
    std::vector<double> ends_;  // low ends along the axis of the sweep and the two others, then high ends; each in the sweep's order
    std::size_t length_ = 0;    // of each
};

}  // namespace fettle::core::geometry
