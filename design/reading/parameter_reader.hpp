// SPDX-License-Identifier: MIT
/// Reads the `parameters` of a design file. Part of design_reader.hpp.
#pragma once

#include <memory>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/description/parameter.hpp"
#include "fettle/design/description/shape.hpp"
#include "fettle/design/reading/read_context.hpp"

namespace fettle::design::reading {

/// @param shapes        Per body of the scene; null: none that a parameter can move.
/// @param default_unit  The file's: of a parameter that names none.
/// Faults go to the node's document.
std::vector<description::Parameter> read_parameters(const core::files::JsonNode& node, const ReadContext& context,
                                                    const std::vector<std::shared_ptr<const description::Shape>>& shapes,
                                                    const Unit& default_unit);

}  // namespace fettle::design::reading
