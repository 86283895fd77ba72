// SPDX-License-Identifier: MIT
/// Reads what a parameter of a design file moves: one of `moves`, a number or a vector of the scene. Part of parameter_reader.hpp.
///     { "body": "rod", "dimension": "length" }          { "body": "rod", "position": [0, 0, 0.5], "offset": [0, 0, "1mm"] }
///     { "joint": "A", "point_a": [1, 0, 0] }            { "spring": "back", "stiffness": true }
///     { "motor": "drive", "value": 2 }                  { "motor": "crank", "rate": "rz" }, of a body's prescribed coordinate
///     { "load": "push", "force": [0, 0, -1] }           { "gravity": [0, 0, -1] }, { "dmin": true }
///     { "materials": ["steel", "brass"], "mu": true }   { "body": "crank", "mu": true }, { "material": "steel", "mu": true }, { "mu": true
///     }
#pragma once

#include <memory>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/description/parameter.hpp"
#include "fettle/design/description/shape.hpp"
#include "fettle/design/reading/read_context.hpp"

namespace fettle::design::reading {

/// Per body; null: none that a parameter can move.
using Shapes = std::vector<std::shared_ptr<const description::Shape>>;

/// @param parameter  Its name and unit: a scale is a pure number if parameter and what it moves are of one dimension, else the amount (in
///                   the file's unit, degrees, SI) per unit of a pure number.
/// @return nothing where there is a fault, which goes to the node's document.
std::vector<description::Move> read_moves(const core::files::JsonNode& node, const ReadContext& context, const Shapes& shapes,
                                          const description::Parameter& parameter);

}  // namespace fettle::design::reading
