// SPDX-License-Identifier: MIT
/// Rows (core/constraint/row.hpp) in what a step holds constant: the frames' placement and the curves. A step solves
///   dE + sum_i multiplier_i dc_i = 0,   c_i = row_i - target_i = 0;
/// with lambda the adjoint variable of the first and mu that of the second, backwards
///   p_bar -= sum_i (multiplier_i d(dc_i . lambda)/dp + mu_i dc_i/dp).
#pragma once

#include "adjoint/contact/contact_set_adjoint.hpp"
#include "adjoint/model_gradient.hpp"
#include "core/energy/step_problem.hpp"

namespace fettle::adjoint::constraint {

/// Where a step ended.
struct RowsAtEnd {
    const core::energy::StepProblem& problem;
    const std::vector<core::kinematics::Pose>& poses;
    const VectorX& multipliers;
};

/// @param motion  [seed][body]: (dq, phi) of lambda.
/// @param mu      per seed.
void subtract_rows_reverse(const RowsAtEnd& at, const std::vector<std::vector<Vector6>>& motion, const std::vector<VectorX>& mu,
                           std::vector<ModelGradient>& model_bar);

/// Adds sum_i multiplier_i dc_i/dP (3 x 4 per body) and its change to those of the energy; returns the change of each c_i.
VectorX add_rows_tangent(const RowsAtEnd& at, const std::vector<Matrix34>& poses_dot, const ModelTangent& direction,
                         contact::PoseGradientTangent& out);

}  // namespace fettle::adjoint::constraint
