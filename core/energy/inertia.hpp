// SPDX-License-Identifier: MIT
/// Inertia and loads of one body in the incremental potential. docs/method.md section 3.
///   E_d(P) = 1/2 tr((P - P_hat) M (P - P_hat)^T),   load: - weight f . (q - q_t0)
#pragma once

#include "fettle/core/kinematics/path.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"

namespace fettle::core::energy {

/// E_d [kg m^2].
double inertia_potential(const Matrix34& pose, const Matrix34& pose_hat, const Matrix4& moments);

/// Adds dE_d/dP as force and arm.
void add_inertia_gradient(const kinematics::Pose& pose, const Matrix34& pose_hat, const Matrix4& moments,
                          kinematics::PoseGradient& gradient);

/// Gauss-Newton part J^T (M (x) I) J in (dq, phi): positive semi-definite for a true moment matrix.
///   [ m I, -[R s] ; [R s], tr(J_w) I - J_w ],  s first moments, J_w = R J R^T second moments.
Matrix6 inertia_hessian(const Matrix3& rotation, const Matrix4& moments);

/// P_hat of implicit Euler: P_t0 + h Pdot_t0 + h^2 [0 | a].
Matrix34 implicit_euler_pose_hat(const Matrix34& pose_t0, const Matrix34& velocity_t0, const Vector3& acceleration, double h);

}  // namespace fettle::core::energy
