// SPDX-License-Identifier: MIT
/// Where prescribed coordinates go within one time step: by the curves' increments, or where the script has the body (and, after its end,
/// on with the curves' increments); through every entry of a script and every change of a curve (of its table, its stop) that lies inside
/// the step. Only a step that has such an entry has more than one node.
///
/// Between two nodes the path is straight in the step's chart. A curve is exactly that. A script's stretch is straight in a chart of its
/// own, which is the same where it is the step's first or turns about the axis of what was turned before; elsewhere further nodes keep the
/// rotation to 1e-4 rad of it. Rotation vectors are those that the path leads to: a whole turn within the step ends at 2 pi, not at 0.
/// Entries within 1e-9 of a step's length of its ends count as at the ends.
#pragma once

#include <vector>

#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::core::stepper {

struct PrescribedNode {
    double fraction = 1;           ///< of the step's time
    std::vector<Vector6> targets;  ///< per body: chart coordinates (q, theta) of its prescribed DOFs; of the free ones nothing is said
};

/// The nodes after the start of a step that starts at `time` from `poses`, in order; the last is the step's end.
std::vector<PrescribedNode> prescribed_path(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time);

}  // namespace fettle::core::stepper
