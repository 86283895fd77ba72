// SPDX-License-Identifier: MIT
/// Joins the scene's description of generated parts (core/scene/scene.hpp, ShapeSpec) with the generators (shapes/generated_part.hpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/shapes/generated_part.hpp"

namespace fettle::design::reading {

/// The part that a scene asks for. The only count is `segments`.
Result<std::shared_ptr<const shapes::GeneratedPart>> generated_part(const core::scene::ShapeSpec& spec);

/// What read_scene needs to make the parts of this program, and where it looks for meshes.
core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs = {});

}  // namespace fettle::design::reading
