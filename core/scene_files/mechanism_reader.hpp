// SPDX-License-Identifier: MIT
/// `joints`, `springs`, `dampers`, `motors` and `loads` of our own scene files. Keys: scene.schema.json. Faults go to the document; values
/// read after a fault are never used.
#pragma once

#include <vector>

#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"
#include "core/scene_files/scene_formulas.hpp"

namespace fettle::core::scene_files {

/// @param root    of the file.
/// @param unit    of lengths [m].
/// @param bodies    already read: where they are at the start.
/// @param formulas  of the file: what is computed of formulas is bound there.
scene::Mechanism read_mechanism(const files::JsonNode& root, double unit, const std::vector<scene::Body>& bodies, SceneFormulas& formulas);

}  // namespace fettle::core::scene_files
