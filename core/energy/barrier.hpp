// SPDX-License-Identifier: MIT
/// The barrier between bodies (contact/contact_set.hpp) as a term of the incremental potential. Reports the energy and the forces that it
/// puts between bodies. docs/method/contact.md.
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const CouplingTerm barrier_term;

}  // namespace fettle::core::energy
