// SPDX-License-Identifier: MIT
/// Springs, dampers, stops, friction of joints, forces along measures (core/energy/measure_terms.hpp). A term's gradient along a motion v
/// is
///   r(v) = g'(m) (dm . v)
/// with g' linear in the coefficient and, of a force, in the curve's values, and a function of m - reference or m - m_slip, so that
/// dg'/d(reference) = -g''; m_slip is m(P0), of BDF2 (4 m(P0) - m(P_-1))/3, of Newmark m(P0) + G . (P_slip - P0), G = (dm/dP)(P0). The
/// frames' placement moves m, m_slip and dm . v.
#pragma once

#include "adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint measure_terms_adjoint;

}  // namespace fettle::adjoint::energy
