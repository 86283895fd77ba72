// SPDX-License-Identifier: MIT
/// What of a scene decides how its simulation goes on, part by part: a run is taken up by the scene that it was a run of, and what differs
/// is told by name. Meshes: geometry_hash.hpp.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/model/model.hpp"

namespace fettle::core::records {

struct ScenePart {
    std::string name;  ///< as a message says it: "gravity", "start velocities"
    std::string hash;  ///< FNV-1a over the bits of its numbers, hexadecimal
};

/// Of a model, in a fixed order.
std::vector<ScenePart> scene_parts(const model::Model& model);

}  // namespace fettle::core::records
