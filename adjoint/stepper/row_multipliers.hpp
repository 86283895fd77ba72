// SPDX-License-Identifier: MIT
/// What the rows of joints and motors carried in each step of a simulated motion, found anew from its configurations.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// [step][number of the row], 0 of rows that follow from others where the step ends: the multipliers m of C^T m = -g over what is free, g
/// the gradient of the potential times its weight at the step's end. A row's force along its measure is -m / weight. Empty where the model
/// has no rows. Contract: the trajectory is the model's, simulated for_gradient; as exact as its steps' residuals are small.
/// @param weights  optional: [step], the potential's weight, which is BDF2's own in its first step.
std::vector<VectorX> row_multipliers(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                     std::vector<double>* weights = nullptr);

}  // namespace fettle::adjoint::stepper
