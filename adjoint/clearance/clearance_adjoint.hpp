// SPDX-License-Identifier: MIT
/// Derivative of a certified clearance's upper bound at its witness (envelope theorem): witness time and points held, path and
/// shapes moved.
#pragma once

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/clearance/clearance.hpp"

namespace fettle::adjoint {

/// Adds scale * d(upper)/d(configurations) to `trajectory_bar`, and the explicit dependence on vertices to `model_bar`.
void clearance_adjoint(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                       const core::clearance::PairClearance& pair, double scale, TrajectoryGradient& trajectory_bar,
                       ModelGradient& model_bar);

}  // namespace fettle::adjoint
