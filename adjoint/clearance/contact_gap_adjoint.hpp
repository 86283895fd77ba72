// SPDX-License-Identifier: MIT
/// Derivative of the gap that contact measures (core/clearance/contact_gap.hpp) with respect to poses and shapes. With the contact's points
/// x_i = R X_i + q, their weights w_i, the unit normal n and the side sigma of round surfaces (1 of facets),
///   d gap = sigma (sum_i w_i n . dx_i - dR),   R the sum of the two reaches, 0 of facets.
#pragma once

#include "adjoint/model_gradient.hpp"
#include "core/clearance/contact_gap.hpp"

namespace fettle::adjoint::clearance {

/// Adds scale * d gap.
/// @param poses     At which the gap was found.
/// @param pose_bar  [body]; as clearance_adjoint's: G = [[tau] R / 2, f].
void contact_gap_adjoint(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses,
                         const core::clearance::ContactGap& gap, double scale, std::vector<Matrix34>& pose_bar, ModelGradient& model_bar);

}  // namespace fettle::adjoint::clearance
