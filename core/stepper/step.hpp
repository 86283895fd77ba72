// SPDX-License-Identifier: MIT
/// One time step: from poses and velocities at t to poses at t + h and the intersection-free path between them.
#pragma once

#include <vector>

#include "fettle/core/solver/newton.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

/// What is carried from step to step.
struct StepState {
    double time = 0;  ///< at the start of the step [s]
    std::vector<kinematics::Pose> poses;
    std::vector<Matrix34> velocities;  ///< Pdot
};
StepState start_state(const model::Model& model);

struct StepResult {
    SimulationStatus status = SimulationStatus::ok;
    std::string message;
    TrajectoryStep path;
    StepState state;  ///< at the end; the start's when not ok
    StepReport report;
};

StepResult step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace, const SimulationOptions& options);

/// Chart coordinates of the prescribed DOFs at the end of a step that starts at `time` from `poses`.
std::vector<Vector6> prescribed_targets(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time);

}  // namespace fettle::core::stepper
