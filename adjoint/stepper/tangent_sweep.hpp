// SPDX-License-Identifier: MIT
/// Forward (tangent) mode of a whole simulation: exact, one linear solve per step and direction; the adjoint's check.
#pragma once

#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// Changes of what belongs to the steps, [step]: the counterpart of TrajectoryGradient but for its poses.
struct StepTangents {
    std::vector<VectorX> multipliers;               ///< of the step's rows
    std::vector<std::vector<Matrix34>> velocities;  ///< [step][body], V at its end
    std::vector<std::vector<Matrix34>> lags;        ///< [step][body], dP of where friction of the last round was taken from
};

/// The residual is differentiated as the contraction of dE/dP (3x4 per body) with dP/dy: no torque, no left Jacobian and no Hessian over
/// prescribed coordinates enters, so that agreement with reverse_sweep checks those.
/// Errors: as reverse_sweep.
/// @param within  optional: what changes with the poses
/// @return [t][body]: (position, left rotation) tangent of each pose, t = 0 .. steps.
Result<std::vector<std::vector<Vector6>>> tangent_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                        const ModelTangent& direction, StepTangents* within = nullptr);

}  // namespace fettle::adjoint::stepper
