// SPDX-License-Identifier: MIT
/// Reads the `constraints` of a design file. Part of design_file.hpp.
#pragma once

#include <memory>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/constraints/constraint.hpp"
#include "fettle/design/objectives/objective_table.hpp"

namespace fettle::design {

/// @param clearance_margin  By which the optimiser keeps away from bounds on lengths [m].
/// Faults go to the node's document.
std::vector<std::unique_ptr<constraints::Constraint>> read_constraints(const core::files::JsonNode& node,
                                                                       const objectives::ReadContext& context, double clearance_margin);

}  // namespace fettle::design
