// SPDX-License-Identifier: MIT
/// Adjoint of a whole simulation: one linear solve with each step's true Hessian, backwards in time. docs/method/adjoint.md.
/// Contract: the trajectory was simulated from this model with for_gradient = true. The result is as exact as the steps' residuals are
/// small.
///
/// One step, from P = P[t] to P' = P[t+1] = [exp([theta]) R, q'], unknowns y = (q', theta), residual g = dE/dy over the free ones:
///   y_bar = (dP'/dy)^T P'_bar,   H_ff lambda = y_bar_f,   lambda = 0 where prescribed,   v = (dP'/dy) lambda  (3x4 per body),
///   increment_bar_k = (y_bar - H lambda)_k                  prescribed; for positions P_bar gets the same, as y_k = q_k + increment,
///   P_hat_bar = v M,   M_bar -= sym(v^T (P' - P_hat)),   force_bar += h^2 lambda_q,   vertices: contact/contact_set_adjoint.hpp,
///   P_hat = 2 P[t] - P[t-1] + h^2 [0|gravity]               (at t = 0: P[0] + h velocity_start + h^2 [0|gravity]).
/// That is implicit Euler. For BDF2, with tau = 2h/3 (from the second step on),
///   P_slip = (4 P[t] - P[t-1])/3,   P_hat = P_slip + tau (4 V[t] - V[t-1])/3 + tau^2 [0|gravity],   V[t+1] = (P' - P_slip)/tau,
/// and V_bar goes the same way back as P_bar. In a quasi-static step the weight is W in h^2's place, P_hat = P[t], and gravity is a load
/// (loads_adjoint.hpp). The chart is based at R: with theta held, a rotation [delta] R turns the end by delta' = exp([theta]) delta. What
/// this does to J and to the residual cancels where all three rotations of a body are free (lambda solves just that). Where one or two are
/// prescribed, with the left Jacobian J_l of theta, phi = J_l lambda_theta, and the torque tau = J_l^-T g_theta that holds the prescribed
/// ones,
///   delta'_bar = J_l^-T (increment_bar_theta + C lambda_theta) + 1/2 phi x tau,   C_ab = <1/2 [tau], d2R/dtheta_a dtheta_b R^T>,
/// because the derivative of the torque along a rotation psi is the symmetric tangent Hessian plus 1/2 psi x tau.
///
///     core::stepper::SimulationOptions options;
///     options.for_gradient = true;
///     const auto simulation = core::stepper::simulate(model, options);
///     const int steps = count_of(simulation.trajectory.steps);
///     auto seed = adjoint::zero_trajectory_gradient(steps, count_of(model.bodies));
///     seed.pose_bar[steps][1](2, 3) = 1;  // J is the height of body 1 at the end
///     const auto gradients = adjoint::stepper::reverse_sweep(model, simulation.trajectory, {seed});
///     if (gradients) std::printf("dJ/d(density of body 1) = %g\n", gradients->front().bodies[1].density_bar);
#pragma once

#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

struct SweepCounts;  // step_linearisation.hpp

/// One ModelGradient per seed; all seeds share each step's assembly and factorisation.
/// Errors: what check_differentiable refuses, and a step whose Hessian is singular (names the step).
/// @param counts  optional: what the sweep took
Result<std::vector<ModelGradient>> reverse_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                 const std::vector<TrajectoryGradient>& seeds, SweepCounts* counts = nullptr);

}  // namespace fettle::adjoint::stepper
