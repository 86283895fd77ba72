// SPDX-License-Identifier: MIT
/// Curves over time of a design's own quantities: those that each step has a number of (quantities/step_series.hpp), wanted, required, or
/// named alone; and how far bodies have travelled whose strokes are asked for.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "design/description/design.hpp"
#include "design/quantities/expression.hpp"

namespace fettle::design::report {

/// The quantities that have a curve, each once, by the name that the design calls it: first the named, then terms of the objective, then
/// constraints, and the parts of expressions among these. A quantity is in whichever scenario it is asked for there.
std::vector<quantities::NamedQuantity> quantities_with_curves(const std::vector<quantities::NamedQuantity>& named,
                                                              const description::Design& design);

/// Charts as step_curves.hpp has them, one per dimension and twelve lines; lengths in mm, angles in deg. Before what the reduction takes,
/// of all steps. Left out: what has a number that is not finite, or no value (of no step).
nlohmann::ordered_json quantity_curves(const std::vector<quantities::NamedQuantity>& quantities, const description::Simulated& simulated);

}  // namespace fettle::design::report
