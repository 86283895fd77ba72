// SPDX-License-Identifier: MIT
/// All pairs of overlapping boxes among many, by one bounding volume tree that is thrown away after use: what mesh checks need. Or by a
/// sweep (box_sweep.hpp): what few boxes need, again and again.
/// Trees of moving bodies are geometry/body_hierarchy.hpp.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/box_sweep.hpp"

namespace fettle::core::geometry {

/// Calls visit(i, j), i < j, once for every overlapping pair, until it returns false. The order of the calls depends on the boxes alone.
/// O(n log n + pairs) for the boxes of a usual mesh. Contract: finite boxes with low <= high.
void visit_overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& visit);

/// Overlapping pairs (i, j), i < j, for which wanted(i, j) is true, sorted; on all threads, on which `wanted` is called. By a sweep.
/// Contract: as above.
std::vector<std::pair<int, int>> overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& wanted);

}  // namespace fettle::core::geometry
