// SPDX-License-Identifier: MIT
/// The damping of single bodies (core/energy/damping.hpp). With k = damping_weight its gradient along a motion v is
///   r(v) = k <(P - P_slip) C, v>,
/// linear in P_slip and in C as the inertia's is in P_hat and M (inertia_adjoint.hpp), and C follows from M:
///   dC = angular dM + (linear - angular) (dm4 m4^T + m4 dm4^T - m4 m4^T dm/m)/m,   m4 = M e4, m = M_44.
/// The rates themselves are not differentiated.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

/// dC along dM.
Matrix4 damping_moments_tangent(const core::model::Body& body, const Matrix4& moments_dot);

/// M_bar of a symmetric C_bar: the transpose of the above, symmetric.
Matrix4 damping_moments_adjoint(const core::model::Body& body, const Matrix4& damping_bar);

extern const TermAdjoint damping_term_adjoint;

}  // namespace fettle::adjoint::energy
