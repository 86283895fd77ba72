// SPDX-License-Identifier: MIT
/// What `fettle validate X.step` tells of each solid: name, size, volume, faces by their kind, and how far its mesh is from it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::design::cli {

/// [{name, size [mm], volume [mm^3], triangles, faces {plane: 6, ...}, colour, deviation {out, in, out_is_proven, in_is_proven, declared}
/// [m]}]
nlohmann::ordered_json step_items_json(const std::vector<core::geometry::Mesh>& items);
/// The same as a table, and below it what the deviations rest on.
std::string step_items_text(const std::vector<core::geometry::Mesh>& items);
/// The deviation of a body's mesh, as answers have it [m].
nlohmann::ordered_json deviation_json(const core::geometry::Deviation& deviation);

}  // namespace fettle::design::cli
