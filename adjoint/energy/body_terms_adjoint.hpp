// SPDX-License-Identifier: MIT
/// The terms of single bodies (core/energy/body_terms.hpp), in what a step holds constant. Along a motion v = dP (3x4) of the body the
/// gradients are, with <A, B> = sum_ij A_ij B_ij,
///   inertia   <(P - P_hat) M, v>: linear in P_hat and in M, so that the maps are a product each
///   damping   damping_weight <(P - P_slip) C, v>: likewise in P_slip and C, and C follows from M:
///             dC = angular dM + (linear - angular) (dm4 m4^T + m4 dm4^T - m4 m4^T dm/m)/m,   m4 = M e4, m = M_44
///   loads     - weight f . dq, linear in f; a quasi-static step's gravity, which its inertia leaves out: - weight a . (v M e4)
/// The rates of damping are not differentiated. Torques are the chart's, and the sweeps' own business (adjoint/stepper).
#pragma once

#include "adjoint/energy/term_adjoint.hpp"

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

/// dC along dM.
Matrix4 damping_moments_tangent(const core::model::Body& body, const Matrix4& moments_dot);

/// M_bar of a symmetric C_bar: the transpose of the above, symmetric.
Matrix4 damping_moments_adjoint(const core::model::Body& body, const Matrix4& damping_bar);

extern const TermAdjoint damping_term_adjoint;

extern const TermAdjoint loads_term_adjoint;

}  // namespace fettle::adjoint::energy
