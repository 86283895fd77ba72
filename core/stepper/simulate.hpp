// SPDX-License-Identifier: MIT
/// Runs a model through time. One step: stepper/step.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

enum class SimulationStatus {
    ok,
    blocked,        ///< a prescribed body cannot follow its script: something is in the way
    not_converged,  ///< a step's equations could not be solved
    interrupted     ///< `should_stop` said so; the trajectory up to there is usable
};
const char* to_string(SimulationStatus status);

struct Progress {
    int step = 0;   ///< steps done
    int steps = 0;  ///< of how many
};

struct SimulationOptions {
    int steps = -1;                                ///< negative: the model's end_time (1000 steps if that is not given)
    bool for_gradient = false;                     ///< solve each step to rounding level with the true Hessian (what the adjoint needs)
    std::function<void(const Progress&)> on_step;  ///< optional
    std::function<bool()> should_stop;             ///< optional, asked after each Newton iteration
};

struct StepReport {
    int newton_iterations = 0;
    int contacts = 0;             ///< active pairs at the end of the step
    double minimum_distance = 0;  ///< of the active pairs at the end of the step [m]; infinity if there are none
    double residual = 0;          ///< norm of the gradient of the incremental potential over the free DOFs, scaled (see newton.hpp)
};

struct SimulationReport {
    SimulationStatus status = SimulationStatus::ok;
    std::string message;  ///< names step, bodies, closest pair and cause when not ok
    std::vector<StepReport> steps;
    int newton_iterations = 0;
    double wall_seconds = 0;
};

struct Simulation {
    Trajectory trajectory;
    SimulationReport report;
};

/// Deterministic: the same bits for any number of threads.
Simulation simulate(const model::Model& model, const SimulationOptions& options = {});

}  // namespace fettle::core::stepper
