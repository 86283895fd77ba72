// SPDX-License-Identifier: MIT
/// A rigid body's 6 x 6 mass matrix in (dq, phi): accelerations take it, and the inertia's Hessian is made of it.
/// docs/method/energy.md#integrators.
#pragma once

#include "core/base/types.hpp"

namespace fettle::core::kinematics {

/// J^T (M (x) I) J in (dq, phi): positive semi-definite for a true moment matrix.
///   [ m I, -[R s] ; [R s], tr(J_w) I - J_w ],  s first moments, J_w = R J R^T second moments.
Matrix6 mass_matrix(const Matrix3& rotation, const Matrix4& moments);

}  // namespace fettle::core::kinematics
