// SPDX-License-Identifier: MIT
/// The resultant force of contact on a body at each step's end (core/energy/term.hpp), friction included, and its derivatives:
///   F = - sum_i (f_i + a g_i + t_i) / weight   over the body's vertices in contact,
/// f_i = d(barrier)/dx_i, a g_i the damping's, t_i the friction's of the step's last round. For a direction n, F . n is minus the contacts'
/// part of the step's residual along the translation n of the body, over the weight, so that its derivative in poses is the contacts'
/// Hessian along it, and that in the shapes what the sweeps use (adjoint/contact). Friction's depends on P_slip too, and on where the round
/// before ended (TrajectoryGradient::lag_bar). Likewise the torque about a point R X + q of the body: T . n is that along the turn n about
/// it, the motion (R X x n, n), whose own change with R adds, with G = dE/dP of the contacts, - <[n]^T G_R, dR> - (n x G e4) . dR X over
/// the weight. Friction acts on each of two bodies at a point of its own.
#pragma once

#include <optional>
#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

struct ContactForceOf {
    int body = 0;              ///< what the force acts on
    std::optional<int> other;  ///< what presses; nullopt: all bodies
    /// Not the force, but the torque about this point, in the body's frame (relative to its reference point) [m].
    std::optional<Vector3> about{};
};

/// Per step, world [N], [N m]. Contract: with friction the trajectory holds where its rounds ended (simulated for_gradient).
std::vector<Vector3> contact_forces(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const ContactForceOf& of);

/// Adds the seeds of sum_t weights[t] . F_t. Contract: as above; no equal areas of edges in an area-weighted barrier (the sweeps refuse
/// those).
void add_contact_force_seeds(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const ContactForceOf& of,
                             const std::vector<Vector3>& weights, Seeds& seeds);

/// A direction, and how the poses change along it: what tangent_sweep returns.
struct TangentMotion {
    const ModelTangent& direction;
    const std::vector<std::vector<Vector6>>& poses_dot;
};
/// Per step, how F changes: of dE/dP and its change alone, without Hessians in (q, phi). Contract: no friction between these bodies.
std::vector<Vector3> contact_force_tangents(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                            const ContactForceOf& of, const TangentMotion& motion);

}  // namespace fettle::adjoint::stepper
