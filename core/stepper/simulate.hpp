// SPDX-License-Identifier: MIT
/// Runs a model through time. One step: stepper/step.hpp.
///
///     core::stepper::SimulationOptions options;
///     options.steps = 100;  // without it: to the scene's end time
///     const auto simulation = core::stepper::simulate(model, options);
///     std::printf("%s %s\n", core::stepper::to_string(simulation.report.status), simulation.report.message.c_str());
///     const auto& trajectory = simulation.trajectory;
///     for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
///         std::printf("%g s: %g m\n", core::stepper::time_at(trajectory, static_cast<int>(t)), trajectory.poses[t][0].position.z());
#pragma once

#include "core/model/model.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::core::stepper {

/// How many steps that is for a model: those asked for, else those of its end time (scene/step_count.hpp), else 1000.
/// Contract: they can be counted, as check_scene finds.
int step_count(const model::Model& model, const SimulationOptions& options);

/// Deterministic: the same bits for any number of threads, in one run or in several (options.resume; their reports and outputs are joined).
Simulation simulate(const model::Model& model, const SimulationOptions& options = {});

}  // namespace fettle::core::stepper
