// SPDX-License-Identifier: MIT
/// From what quantities hand in, derivatives in the configurations and in the model, to the whole derivative in the model.
#pragma once

#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// Per seed its model_bar plus the reverse sweep of its trajectory_bar; all through one sweep, and none if no seed reaches past the start:
/// a seed on the start configuration alone is the start pose's derivative as it is, for the sweep is linear and maps what is zero to zero.
/// Contract and errors: as reverse_sweep; and what a seed refuses.
Result<std::vector<ModelGradient>> seeded_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                std::vector<Seeds> seeds);

}  // namespace fettle::adjoint::stepper
