// SPDX-License-Identifier: MIT
/// One time step: from poses and velocities at t to poses at t + h and the intersection-free path between them.
///
/// Where a script or table has entries inside the step, its coordinates are driven through them in order (prescribed_path.hpp), each
/// stretch a minimisation of its own that starts where the one before ended, so that line search, CCD and the stored path see the way as it
/// is. The last one is the implicit step's, whose end knows nothing of the way; those before have its inertia aim at the share of the way
/// that has passed. (Friction is lagged from where the last stretch starts.)
#pragma once

#include "core/solver/newton.hpp"
#include "core/stepper/simulation.hpp"
#include "core/stepper/trajectory.hpp"

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

}  // namespace fettle::core::stepper
