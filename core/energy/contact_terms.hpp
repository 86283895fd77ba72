// SPDX-License-Identifier: MIT
/// What acts between bodies that are near each other, as terms of the incremental potential: the barrier (contact/contact_set.hpp), damping
/// of contacts (contact/contact_damping.hpp), friction with the lag of the problem (contact/friction.hpp). Each reports the forces that it
/// puts between bodies; the barrier its energy too. docs/method/contact.md.
#pragma once

#include "core/energy/term.hpp"

namespace fettle::core::energy {

extern const CouplingTerm barrier_term;

extern const CouplingTerm contact_damping_term;

extern const CouplingTerm friction_term;

}  // namespace fettle::core::energy
