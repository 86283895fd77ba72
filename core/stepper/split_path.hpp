// SPDX-License-Identifier: MIT
/// Nodes for a stored path between which joints part by no more than is allowed. A step's path is straight in each body's chart, so that a
/// joint that bodies turn about parts between nodes (joint_outputs.hpp) by up to |w|^2 |X|/8 of each, however well the step's end meets it.
/// Here segments are halved: the bodies at a segment's middle are moved onto their joints, least by mass (constraint/assembly.hpp), and
/// stand there as a node. Motors' rows are left out: between two ends of a step they say nothing. Ends of steps stay what they are, bit for
/// bit; so does a path that needs no node. The new path has to be proven free of contact, as any path of a trajectory.
#pragma once

#include <string>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

struct PathGap {
    double gap = 0;  ///< bound on how far the joint's points part between nodes [m]
    int joint = -1;  ///< of model::Mechanism::joints; -1: there is none
    int step = -1;   ///< from 0
};

/// The largest over the joints that hold a point, and over the path.
PathGap largest_path_gap(const model::Model& model, const Trajectory& trajectory);

struct SplitPath {
    PathGap left;         ///< afterwards
    int added = 0;        ///< nodes
    std::string refusal;  ///< joint, step and why it could not be brought below; empty: it is
};

/// Contract: the trajectory is the model's; allowed > 0 [m].
SplitPath split_at_joints(const model::Model& model, double allowed, Trajectory& trajectory);

}  // namespace fettle::core::stepper
