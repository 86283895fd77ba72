// SPDX-License-Identifier: MIT
/// The facts that a person checks before trusting a file: how large, how much, how heavy; and what cannot well be meant.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::design::cli {

/// Per body: `name`, `type`, `size` (of its mesh's box in its own frame, [m]), `solids` (how many its mesh has, solids/shells.hpp),
/// `volume`
/// ([m^3], null unless its mesh is closed or nearly), `mass` ([kg], null unless dynamic).
nlohmann::ordered_json parts_json(const core::model::Model& model);

/// The same as a table in the file's unit of length; masses in kg, or g below 1 kg.
std::string parts_text(const core::model::Model& model);

}  // namespace fettle::design::cli
