// SPDX-License-Identifier: MIT
/// Reads the `constraints` of a design file but the relations (relation_reader.hpp). Part of design_reader.hpp.
#pragma once

#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/constraint.hpp"
#include "design/reading/read_context.hpp"

namespace fettle::design::reading {

/// @param clearance_margin  By which the optimiser keeps away from bounds on lengths [m].
/// A bound is a number in the unit of the quantity's dimension (ReadContext::unit), or a string with a unit of that dimension.
/// Faults go to the node's document.
std::vector<description::Constraint> read_constraints(const core::files::JsonNode& node, const ReadContext& context,
                                                      double clearance_margin);

}  // namespace fettle::design::reading
