// SPDX-License-Identifier: MIT
/// Reads the `parameters` of a design file. Part of design_file.hpp.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/objectives/objective_table.hpp"
#include "fettle/design/parameters.hpp"

namespace fettle::design {

/// @param length_unit_name  Of the file: the unit of a parameter that names none.
/// Faults go to the node's document.
std::vector<Parameter> read_parameters(const core::files::JsonNode& node, const objectives::ReadContext& context,
                                       const std::string& length_unit_name);

/// `wanted`, or "wanted 2", "wanted 3", ... if it is taken; takes it.
std::string unique_name(const std::string& wanted, std::set<std::string>& taken);

}  // namespace fettle::design
