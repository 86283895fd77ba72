// SPDX-License-Identifier: MIT
/// Friction with the lag of the problem (contact/friction.hpp) as a term of the incremental potential. Reports its part of the forces
/// between bodies. docs/method/contact.md#friction.
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const CouplingTerm friction_term;

}  // namespace fettle::core::energy
