// SPDX-License-Identifier: MIT
/// Joins the scene's description of generated parts (core/scene/scene.hpp, ShapeSpec) with the generators (shapes/shape_generator.hpp).
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/shapes/shape_generator.hpp"

namespace fettle::design {

/// The part that a scene asks for. The only count is `segments`.
Result<shapes::GeneratedShape> generate_shape(const core::scene::ShapeSpec& spec);

/// What read_scene needs to make the parts of this program, and where it looks for meshes.
core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs = {});

}  // namespace fettle::design
