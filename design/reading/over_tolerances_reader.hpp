// SPDX-License-Identifier: MIT
/// Reads `over_tolerances`, of a design file or of one of its requirements or terms:
///     "over_tolerances": { "sigma": 3 }      with three standard deviations in reserve
///     "over_tolerances": "worst_case"        with the linear worst case in reserve
///     "over_tolerances": "proven"            of a clearance as assembled or over the ranges of joints: the certified one of all parts
///                                            within the tolerances
///     "over_tolerances": "as_drawn"          without a reserve
/// Part of design_reader.hpp.
#pragma once

#include <optional>

#include "core/files/json_document.hpp"
#include "design/description/constraint.hpp"

namespace fettle::design::reading {

/// Faults go to the node's document. @param otherwise  Where the node is not there. @param is_clearance  What may be "proven".
std::optional<description::OverTolerances> read_over_tolerances(const core::files::JsonNode& node,
                                                                const std::optional<description::OverTolerances>& otherwise = {},
                                                                bool is_clearance = false);

/// The same of a requirement with these bounds, which are no equation.
/// @param requirement  The constraint or relation.
std::optional<description::OverTolerances> read_over_tolerances_of(const core::files::JsonNode& requirement,
                                                                   const description::Bounds& bounds,
                                                                   const std::optional<description::OverTolerances>& otherwise,
                                                                   bool is_clearance = false);

}  // namespace fettle::design::reading
