// SPDX-License-Identifier: MIT
/// What acts on single bodies, as terms of the incremental potential. docs/method/energy.md.
///   inertia   E_d(P) = 1/2 tr((P - P_hat) M (P - P_hat)^T), Gauss-Newton Hessian: kinematics/mass_matrix.hpp. Gravity is in P_hat
///             (time_integration.hpp). Reports kinetic energy and momenta.
///   damping   resistance in proportion to mass. With the end velocity V = (P - P_slip)/slip_time of the integrator in use and C of
///             damping_moments.hpp, slip_time/2 tr(V C V^T), times the weight damping_weight/2 tr((P - P_slip) C (P - P_slip)^T).
///   loads     constant forces and torques, - weight (f . (q - q_t0) + tau . theta); tau is the constant gradient in the chart's theta that
///             acts as the body's torque. Reports their energy, and gravity's. In a quasi-static step gravity is a load, and its potential
///             stands here: - weight a . ((P - P_t0) M e4).
/// A quasi-static step has a proximal term in place of inertia (docs/method/energy.md#quasi-static-steps).
#pragma once

#include <vector>

#include "core/energy/damping_moments.hpp"
#include "core/energy/term.hpp"

namespace fettle::core::energy {

/// E_d [kg m^2].
double inertia_potential(const Matrix34& pose, const Matrix34& pose_hat, const Matrix4& moments);

/// Adds dE_d/dP as force and arm.
void add_inertia_gradient(const kinematics::Pose& pose, const Matrix34& pose_hat, const Matrix4& moments,
                          kinematics::PoseGradient& gradient);

/// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m^2/s] of a body with Pdot = velocity.
Vector6 momenta(const kinematics::Pose& pose, const Matrix34& velocity, const Matrix4& moments);

/// Inertia of the bodies that are solved for.
extern const BodyTerm inertia_term;

/// Resistance of the bodies that are damped (damping_moments.hpp).
extern const BodyTerm damping_term;

/// Adds dE/dP of gravity as a load; nothing where the inertia has it.
void add_gravity_gradient(const StepProblem& problem, std::size_t body, const kinematics::Pose& pose, kinematics::PoseGradient& gradient);

extern const BodyTerm loads_term;

/// Per body, of where a quasi-static step ended: |force| + |torque| / r of the proximal term, over its free coordinates in the step's
/// chart, over the body's reference load (model::reference_loads); r the body's radius, at least dhat. 0 of bodies that are prescribed
/// altogether, and of all in a scene without loads, where nothing can be pushed off. Above model::allowed_proximal_share a body is not
/// held.
std::vector<double> proximal_shares(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                    const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::energy
