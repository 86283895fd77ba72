// SPDX-License-Identifier: MIT
/// Friction (core/energy/friction.hpp): refused where a coefficient is above 0 between two bodies that may touch; elsewhere it is zero.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint friction_term_adjoint;

}  // namespace fettle::adjoint::energy
