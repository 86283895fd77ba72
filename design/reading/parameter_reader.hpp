// SPDX-License-Identifier: MIT
/// Reads the `parameters` of a design file. Part of design_reader.hpp.
///     { "name": "crank_radius", "value": 13.5, "lower": 12, "upper": 16 }
/// A parameter that has the name of one of the scene's variables takes its place, and where the file gives none its value and unit.
#pragma once

#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/description/parameter.hpp"

namespace fettle::design::reading {

/// @param variables    Of the scene, as its file has them.
/// @param length_unit  The file's: of a parameter that names none and is no other dimension's.
/// Faults go to the node's document.
std::vector<description::Parameter> read_parameters(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                    const Unit& length_unit);

}  // namespace fettle::design::reading
