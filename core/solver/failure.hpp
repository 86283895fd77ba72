// SPDX-License-Identifier: MIT
/// The message about a step that could not be solved: which body is held, by which others, how close, and what stiffness would do.
#pragma once

#include <string>
#include <vector>

#include "core/ccd/safe_step.hpp"
#include "core/energy/incremental_potential.hpp"
#include "core/solver/row_system.hpp"

namespace fettle::core::solver {

struct FailedStep {
    const energy::StepProblem& problem;
    const contact::ContactSet& contacts;    ///< where the solver gave up
    const std::vector<Vector6>& remaining;  ///< of the prescribed coordinates, per body
    const ccd::SafeStep& limiting;          ///< of the last search
    double residual = 0;                    ///< NewtonResult::residual
    const std::string& cause;
    const RowSystem* rows = nullptr;                              ///< of a model with joints; then the next two as well
    const std::vector<kinematics::ChartPoint>* points = nullptr;  ///< where the solver gave up
    const std::vector<kinematics::Pose>* poses = nullptr;
};

std::string describe_failure(const FailedStep& step);

}  // namespace fettle::core::solver
