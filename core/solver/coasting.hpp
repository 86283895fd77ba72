// SPDX-License-Identifier: MIT
/// Where a step of sliding bodies begins to be solved (newton.hpp).
#pragma once

#include <vector>

#include "core/energy/step_problem.hpp"
#include "core/linear/free_dofs.hpp"

namespace fettle::core::solver {

/// Where bodies get to in the step if nothing acts on them, in the chart of the step: free coordinates go on as they went (pose_hat without
/// gravity's share, its rotation the nearest about the axis of its skew part), prescribed ones to their targets.
/// @return empty where a body would turn by more than half a radian
std::vector<kinematics::ChartPoint> coasted(const energy::StepProblem& problem, const std::vector<Vector6>& targets,
                                            const linear::FreeDofs& dofs);

}  // namespace fettle::core::solver
