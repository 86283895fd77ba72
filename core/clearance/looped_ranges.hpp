// SPDX-License-Identifier: MIT
/// A model's joints as a linkage (joint_ranges.hpp) where they close loops: the tree that is left without the joints that close them, and
/// what follows from what.
///   driver      of each loop, one coordinate: that of the joint that a motor drives; where none does, of the only one with limits
///   dependents  the other coordinates of its joints, as many as the closing joints have independent conditions where the loop starts
/// Loops that share a coordinate other than a driver's are one. The limits of dependents have no effect.
#pragma once

#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/clearance/joint_ranges.hpp"

namespace fettle::core::clearance {

struct ClosedLoop {
    std::vector<int> closing;  ///< places in the mechanism's joints
    int driver = 0;            ///< coordinate
    std::vector<int> unknowns;
    std::vector<int> rows;  ///< independent conditions: 6 * place in `closing` + x, y, z of the points, x, y, z of the axes
};

struct LoopedRanges {
    JointRanges ranges;  ///< of the tree; dependents stand at their start
    std::vector<ClosedLoop> loops;
};

/// Do joints close loops? Static bodies are one with the world.
bool closes_loops(const model::Model& model);

/// Trees have no loops. @param is_pinned  As assembled: all coordinates stand at their start, and need no limits.
/// Errors: those of joint_ranges, but loops; loops that another joint than a revolute one closes, that nothing drives, or more than one
/// coordinate, or whose conditions do not determine the others where they start.
base::Result<LoopedRanges> looped_ranges(const model::Model& model, bool is_pinned = false);

}  // namespace fettle::core::clearance
