// SPDX-License-Identifier: MIT
/// Reads the relations among the `constraints` of a design file: those of type `relation`. Part of design_reader.hpp.
///     { "type": "relation", "expression": "crank_radius / rod_length", "upper": 0.35 }
///     { "type": "relation", "name": "Grashof", "expression": "2 * (min(a, b, c, d) + max(a, b, c, d)) - (a + b + c + d)", "upper": 0 }
///     { "type": "relation", "expression": "left + right", "lower": "30mm", "upper": "30mm" }
/// The formula, of parameters and variables: core/expression/parse_formula.hpp.
#pragma once

#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/constraint.hpp"
#include "design/description/parameter.hpp"
#include "design/description/relation.hpp"
#include "design/reading/read_context.hpp"

namespace fettle::design::reading {

inline constexpr std::string_view relation_type = "relation";

/// Is this entry of `constraints` a relation? Tells no fault.
bool is_relation(const core::files::JsonNode& node);

/// A bound is a number (plain for pure numbers, lengths, areas and masses, in the file's units and grams), or a string with a unit of the
/// expression's dimension. Margin and tolerance, where the file does not say: with c = 1e-5 sum |dr/dp_k| (upper_k - lower_k) at the
/// parameters' values, a margin of c (at most a quarter of the band) and no tolerance, of an equation (lower = upper) no margin and a
/// tolerance of c.
/// @param node        The list of all constraints; those of other types are passed over.
/// @param parameters  As read.
/// @param others      The other constraints: relations get names that none of them has.
/// @param choices    The names of formulas where those of choices are no numbers (ChoiceReader::scope): a relation that no parameter
/// changes, but choices do, is one too. Null: there are no choices.
/// @param has_tolerances  What no parameter changes may be for `fettle tolerance`: it is left out with a warning, and is no fault.
/// Faults go to the node's document.
std::vector<description::Relation> read_relations(const core::files::JsonNode& node, const ReadContext& context,
                                                  const std::vector<description::Parameter>& parameters,
                                                  const std::vector<description::Constraint>& others,
                                                  const core::expression::Scope* choices, bool has_tolerances);

}  // namespace fettle::design::reading
