// SPDX-License-Identifier: MIT
/// Constant forces (core/energy/loads.hpp): their gradient along a motion is - weight f . dq, linear in f; that of a
/// quasi-static step's gravity, which its inertia leaves out, - weight a . (v M e4), linear in a and in M. Torques are the
/// chart's, and the sweeps' own business (adjoint/stepper).
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint loads_term_adjoint;

}  // namespace fettle::adjoint::energy
