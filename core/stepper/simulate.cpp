// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/simulate.hpp"

#include <chrono>
#include <cmath>
#include <sstream>

#include "fettle/core/stepper/step.hpp"

namespace fettle::core::stepper {
namespace {

constexpr int default_steps = 1000;

int step_count(const model::Model& model, const SimulationOptions& options) {
    if (options.steps >= 0) return options.steps;
    // A hair below an integer is that integer: end_time = 100 h must give 100 steps.
    if (model.end_time >= 0) return static_cast<int>(std::ceil(model.end_time / model.timestep - 1e-9));
    return default_steps;
}

}  // namespace

const char* to_string(SimulationStatus status) {
    switch (status) {
        case SimulationStatus::ok:
            return "ok";
        case SimulationStatus::blocked:
            return "blocked";
        case SimulationStatus::not_converged:
            return "not_converged";
        case SimulationStatus::interrupted:
            return "interrupted";
    }
    return "unknown";
}

Simulation simulate(const model::Model& model, const SimulationOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    Simulation out;
    out.trajectory.timestep = model.timestep;
    for (const model::Body& body : model.bodies) out.trajectory.body_names.push_back(body.name);
    StepState state = start_state(model);
    solver::NewtonWorkspace workspace(model);
    out.trajectory.poses.push_back(state.poses);
    const int steps = step_count(model, options);
    for (int t = 0; t < steps; ++t) {
        state.time = t * model.timestep;  // not accumulated: no drift over many steps
        StepResult result = step(model, state, workspace, options);
        out.report.newton_iterations += result.report.newton_iterations;
        if (result.status != SimulationStatus::ok) {
            std::ostringstream message;
            message << "step " << t + 1 << " (t = " << state.time << " s to " << state.time + model.timestep << " s): " << result.message;
            out.report.status = result.status;
            out.report.message = message.str();
            break;
        }
        out.report.steps.push_back(result.report);
        out.trajectory.steps.push_back(std::move(result.path));
        state = std::move(result.state);
        out.trajectory.poses.push_back(state.poses);
        if (options.on_step) options.on_step({t + 1, steps});
    }
    out.report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace fettle::core::stepper
