// SPDX-License-Identifier: MIT
/// Design files of version 0.1 had `moves` in their parameters, lists of coefficients; now formulas say what follows from parameters.
#pragma once

#include <string>

#include "core/files/json_document.hpp"

namespace fettle::design::reading {

/// What to write in place of a parameter's `moves`, for a message: `"/bodies/rod/position/0": "= crank_radius"`, and so on.
/// docs/convert_moves.py rewrites whole files.
std::string instead_of_moves(const core::files::JsonNode& moves, const std::string& parameter);

}  // namespace fettle::design::reading
