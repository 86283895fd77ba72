// SPDX-License-Identifier: MIT
/// Reads the `parameters` of a design file. Part of design_reader.hpp.
///     { "name": "crank_radius", "value": 13.5, "lower": 12, "upper": 16 }
/// A parameter that has the name of one of the scene's variables replaces it, and has its value and unit where the file gives none.
#pragma once

#include <vector>

#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::reading {

/// @param variables    The scene's variables, as its file has them.
/// @param length_unit  The file's: for a parameter that names no unit and has no other dimension.
/// Faults go to the node's document.
std::vector<description::Parameter> read_parameters(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                    const Unit& length_unit);

/// The unit in which people write such a quantity: of lengths the file's, of angles degrees, of others SI.
Unit usual_unit(Dimension dimension, const Unit& length_unit);

}  // namespace fettle::design::reading
