// SPDX-License-Identifier: MIT
/// The barrier (core/energy/barrier.hpp) in the shapes' vertices: adjoint/contact does the work.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint barrier_term_adjoint;

}  // namespace fettle::adjoint::energy
