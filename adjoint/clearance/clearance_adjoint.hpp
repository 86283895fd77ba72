// SPDX-License-Identifier: MIT
/// Derivative of a certified clearance's upper bound at its witness (envelope theorem): witness time and points held, path and
/// shapes moved.
///
/// The bound is d = n.(sum of w_i x_i) with the closest points' weights w_i and their unit direction n from b to a, x_i = R(s) X_i + q(s).
/// So d(d) = n.(w_i dx_i): R^T n w_i on the vertices, force f = sum w_i n and torque tau = sum R X_i x w_i n on each body's pose at the
/// witness.
///
/// Path: R(s) = exp(s theta) R_t, q(s) = (1 - s) q_t + s q_{t+1}, theta = the step's rotation vector (that of its last node), R_{t+1} =
/// exp(theta) R_t. With dR = [phi] R and the left Jacobian J:
///   phi(s) = exp(s theta) phi_t + s J(s theta) dtheta,   dtheta = J(theta)^{-1} (phi_{t+1} - exp(theta) phi_t).
/// Steps with intermediate nodes (segments k of n) are differentiated as if straight, at s -> (k + s)/n: such nodes are accepted points of
/// a line search and have no derivative of their own.
#pragma once

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/clearance/clearance.hpp"

namespace fettle::adjoint {

/// Adds scale * d(upper)/d(configurations) to `trajectory_bar`, and the explicit dependence on vertices to `model_bar`.
/// A witness as assembled (step -1) moves with poses[0] alone.
/// @param trajectory_bar  entries G of pose_bar are those of the 3x4 matrix with <G, [[phi] R, dq]> = tau.phi + f.dq: defined for motions
/// of a
///                        rigid body only, G = [[tau] R / 2, f].
/// A pair at distance 0 has no direction and adds nothing. Contract: |theta| is not a multiple of 2 pi other than 0 (there the end pose
/// does not determine the path).
void clearance_adjoint(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                       const core::clearance::PairClearance& pair, double scale, TrajectoryGradient& trajectory_bar,
                       ModelGradient& model_bar);

}  // namespace fettle::adjoint
