// SPDX-License-Identifier: MIT
/// Reads the moves of a design file that are linear in their parameter: of joints, springs, motors and loads, of gravity, of coefficients
/// of friction, and of a body's turn, velocity and force. Part of parameter_reader.hpp.
///     { "joint": "A", "point_a": [1, 0, 0] }            { "spring": "back", "stiffness": true }
///     { "motor": "drive", "value": 2 }                  { "load": "push", "force": [0, 0, -1] }
///     { "gravity": [0, 0, -1] }                         { "body": "crank", "turn": [0, 0, 1] }
///     { "materials": ["steel", "brass"], "mu": true }   { "body": "crank", "mu": true }, { "material": "steel", "mu": true }, { "mu": true
///     }
#pragma once

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/description/parameter.hpp"
#include "fettle/design/reading/read_context.hpp"

namespace fettle::design::reading {

/// Does this move say something of these? Tells no fault.
bool is_mechanism_move(const core::files::JsonNode& node);

/// @return nothing where a fault was told, which goes to the node's document.
std::optional<description::Move> read_mechanism_move(const core::files::JsonNode& node, const ReadContext& context,
                                                     const description::Parameter& parameter);

/// The factor of a move: a pure number if parameter and target are of one kind, else the target's amount per unit of a pure number.
/// @param target_unit  SI value of the unit that the latter is in.
double read_scale(const core::files::JsonNode& node, const description::Parameter& parameter, Dimension target, double target_unit);

}  // namespace fettle::design::reading
