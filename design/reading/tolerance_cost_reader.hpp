// SPDX-License-Identifier: MIT
/// Reads what a tolerance costs, and whether it is fixed: of `fettle tolerance --allocate`.
///     "cost": 3                                      as it stands; half of that where it is twice as wide
///     "cost": "1 + 0.2 mm / t"                       by half of its width
///     "cost": { "IT6": 4, "IT7": 2, "IT8": 1 }       one of these grades: of the same letter, or +- half of their width
///     "fixed": true                                  it is left as it stands
/// Part of tolerance_reader.hpp.
#pragma once

#include "core/base/units.hpp"
#include "core/files/json_document.hpp"
#include "design/description/tolerance.hpp"

namespace fettle::design::reading {

/// @param node     The tolerance's object. @param nominal  The number's [SI]. @param unit  In which plain numbers of it are.
/// @param tolerance  As read but for these. Faults go to the node's document.
void read_cost(const core::files::JsonNode& node, double nominal, const Unit& unit, description::Tolerance& tolerance);

}  // namespace fettle::design::reading
