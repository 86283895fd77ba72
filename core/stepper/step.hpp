// SPDX-License-Identifier: MIT
/// One time step: from poses and velocities at t to poses at t + h and the intersection-free path between them.
#pragma once

#include <vector>

#include "fettle/core/solver/newton.hpp"
#include "fettle/core/stepper/simulation.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

StepState start_state(const model::Model& model);

struct StepResult {
    SimulationStatus status = SimulationStatus::ok;
    std::string message;
    TrajectoryStep path;
    StepState state;  ///< at the end; the start's when not ok
    StepReport report;
    StepOutputs outputs;  ///< if asked for
};

StepResult step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace, const SimulationOptions& options);

/// Chart coordinates of the prescribed DOFs at the end of a step that starts at `time` from `poses`: by the curves' increments, or where
/// the script has the body (and, after its end, on with the curves' increments).
std::vector<Vector6> prescribed_targets(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time);

}  // namespace fettle::core::stepper
