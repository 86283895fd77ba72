// SPDX-License-Identifier: MIT
/// Damping of contacts (core/energy/contact_damping.hpp) in the step's start and in the shapes' vertices: adjoint/contact does the work.
/// The damping time is not differentiated.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint contact_damping_term_adjoint;

}  // namespace fettle::adjoint::energy
