// SPDX-License-Identifier: MIT
/// Adjoint of a whole simulation: one linear solve with each step's true Hessian, backwards in time. method.md section 10.
/// Contract: the trajectory was simulated from this model with for_gradient = true.
#pragma once

#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::adjoint {

/// One ModelGradient per seed; all seeds share each step's assembly and factorisation.
/// Errors: a step whose Hessian is singular (names the step).
Result<std::vector<ModelGradient>> reverse_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                 const std::vector<TrajectoryGradient>& seeds);

}  // namespace fettle::adjoint
