// SPDX-License-Identifier: MIT
/// Inertia: of one body, and as a term of the incremental potential. docs/method/energy.md.
///   E_d(P) = 1/2 tr((P - P_hat) M (P - P_hat)^T),   Gauss-Newton Hessian: mass_matrix.hpp
/// Gravity is in P_hat (time_integration.hpp). Reports kinetic energy and momenta.
#pragma once

#include "fettle/core/energy/term.hpp"

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

}  // namespace fettle::core::energy
