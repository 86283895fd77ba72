// SPDX-License-Identifier: MIT
/// Constant forces (core/energy/loads.hpp): their gradient along a motion is - weight f . dq, linear in f. Torques are refused.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint loads_term_adjoint;

}  // namespace fettle::adjoint::energy
