// SPDX-License-Identifier: MIT
/// The parts of a scene that decide how its simulation goes on. A run can be continued only with the scene that it is a run of; the parts
/// that differ are named. Meshes: geometry_hash.hpp.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::core::records {

struct ScenePart {
    std::string name;  ///< as a message says it: "gravity", "start velocities"
    std::string hash;  ///< FNV-1a over the bits of its numbers, hexadecimal
};

/// The parts of a model, in a fixed order.
std::vector<ScenePart> scene_parts(const model::Model& model);

}  // namespace fettle::core::records
