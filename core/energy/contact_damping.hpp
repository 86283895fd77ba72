// SPDX-License-Identifier: MIT
/// Damping of contacts as a term of the incremental potential: what contact/contact_damping.hpp sums over the contacts. Reports its forces.
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const CouplingTerm contact_damping_term;

}  // namespace fettle::core::energy
