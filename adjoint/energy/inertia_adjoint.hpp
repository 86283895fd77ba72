// SPDX-License-Identifier: MIT
/// Derivatives of the inertia's gradient (core/energy/inertia.hpp) in what a step holds constant: pose_hat and the moments.
/// Along a motion v = dP (3x4) of the body the gradient is
///   r(v) = <(P - P_hat) M, v>,   <A, B> = sum_ij A_ij B_ij,
/// linear in P_hat and in M, so that the maps are a product each.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

/// dr/dP_hat = - v M.
inline Matrix34 inertia_pose_hat_adjoint(const Matrix34& v, const Matrix4& moments) { return -v * moments; }

/// dr/dM, its symmetric part: sym(v^T (P - P_hat)).
inline Matrix4 inertia_moments_adjoint(const Matrix34& v, const Matrix34& pose_minus_hat) {
    const Matrix4 m = v.transpose() * pose_minus_hat;
    return 0.5 * (m + m.transpose());
}

/// Change of the pose gradient (P - P_hat) M along (P_dot, P_hat_dot, M_dot).
inline Matrix34 inertia_gradient_tangent(const Matrix34& pose_minus_hat, const Matrix4& moments, const Matrix34& pose_minus_hat_dot,
                                         const Matrix4& moments_dot) {
    return pose_minus_hat_dot * moments + pose_minus_hat * moments_dot;
}

/// In the moments themselves; how they follow from vertices and density is adjoint/model/body_mass_adjoint.hpp.
extern const TermAdjoint inertia_term_adjoint;

}  // namespace fettle::adjoint::energy
