// SPDX-License-Identifier: MIT
/// Forward (tangent) mode of a whole simulation: exact, one linear solve per step and direction; the adjoint's check.
#pragma once

#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// The residual is differentiated as the contraction of dE/dP (3x4 per body) with dP/dy: no torque, no left Jacobian and no Hessian over
/// prescribed coordinates enters, so that agreement with reverse_sweep checks those.
/// Errors: as reverse_sweep.
/// @param multipliers  optional: [step], how the multipliers of each step's rows change.
/// @return [t][body]: (position, left rotation) tangent of each pose, t = 0 .. steps.
Result<std::vector<std::vector<Vector6>>> tangent_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                        const ModelTangent& direction, std::vector<VectorX>* multipliers = nullptr);

}  // namespace fettle::adjoint::stepper
