// SPDX-License-Identifier: MIT
/// Springs, dampers, stops, friction of joints, forces along measures (core/energy/measure_terms.hpp). A term's gradient along a motion v
/// is
///   r(v) = g'(m) (dm . v)
/// with g' linear in the coefficient and, of a force, in the curve's values, and a function of m - reference or m - m_slip, so that
/// dg'/d(reference) = -g''; m_slip is m at the step's start (implicit Euler, quasi-static). The frames' placement moves m and dm . v.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint measure_terms_adjoint;

}  // namespace fettle::adjoint::energy
