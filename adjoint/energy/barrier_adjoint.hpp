// SPDX-License-Identifier: MIT
/// The barrier (core/energy/barrier.hpp) in the shapes' vertices: adjoint/contact does the work. Refused is
/// friction with area weights.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint barrier_term_adjoint;

}  // namespace fettle::adjoint::energy
