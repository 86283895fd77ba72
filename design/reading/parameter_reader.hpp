// SPDX-License-Identifier: MIT
/// Reads the `parameters` of a design file. Part of design_reader.hpp.
#pragma once

#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/description/parameter.hpp"
#include "fettle/design/reading/move_reader.hpp"

namespace fettle::design::reading {

/// @param default_unit  The file's: of a parameter that names none.
/// Faults go to the node's document.
std::vector<description::Parameter> read_parameters(const core::files::JsonNode& node, const ReadContext& context, const Shapes& shapes,
                                                    const Unit& default_unit);

}  // namespace fettle::design::reading
