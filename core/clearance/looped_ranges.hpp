// SPDX-License-Identifier: MIT
/// A model's joints as a linkage (joint_ranges.hpp) where they close loops: the tree that is left without the joints that close them, and
/// which coordinate follows from which.
///   driver      of each loop, one coordinate: that of the joint that a motor drives; where none does, of the only one with limits
///   dependents  the other coordinates of its joints, as many as the closing joints have independent conditions where the loop starts
/// Loops that share a coordinate other than a driver's are one. The limits of dependents have no effect.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/clearance/joint_ranges.hpp"
#include "core/scene/curve.hpp"

namespace fettle::core::clearance {

struct ClosedLoop {
    std::vector<int> closing;  ///< places in the mechanism's joints
    int driver = 0;            ///< coordinate
    std::vector<int> unknowns;
    std::vector<int> rows;  ///< independent conditions: 6 * place in `closing` + x, y, z of the points, x, y, z of the axes
};

/// A source of a prescribed motion (driven_ranges.hpp): a motor's joint or a body's coordinates, which move by themselves, and what it
/// moves.
struct DrivenSource {
    std::string name;
    int motor = -1;                             ///< a place in the scene's motors; -1: a script's
    int body = -1, dof = -1;                    ///< of a script: whose, and which one moves; -1: several do
    scene::Curve curve;                         ///< as designed
    int coordinate = 0;                         ///< whose range, or time, it decides
    double units = 1;                           ///< of the coordinate, per unit of the curve
    std::vector<std::pair<int, int>> screws{};  ///< bodies, and which of their screws
};

struct LoopedRanges {
    enum class Of { joints, start, motion };
    Of of = Of::joints;  ///< what the ranges are: the joints' own, their start alone, where a prescribed motion has them
    JointRanges ranges;  ///< of the tree; dependents stand at their start
    std::vector<ClosedLoop> loops;
    std::vector<DrivenSource> driven{};  ///< of a motion; more than one share the time
    double duration = 0;                 ///< of a motion [s]
};

/// Do joints close loops? Static bodies are one with the world.
bool closes_loops(const model::Model& model);

/// Trees have no loops. @param is_pinned  As assembled: all coordinates stand at their start, and need no limits.
/// Errors: those of joint_ranges, but loops; loops that another joint than a revolute one closes, that nothing drives, or more than one
/// coordinate, or whose conditions do not determine the others where they start.
base::Result<LoopedRanges> looped_ranges(const model::Model& model, bool is_pinned = false);

}  // namespace fettle::core::clearance
