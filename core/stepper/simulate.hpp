// SPDX-License-Identifier: MIT
/// Runs a model through time. One step: stepper/step.hpp.
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
