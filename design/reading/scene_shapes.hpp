// SPDX-License-Identifier: MIT
/// Joins the scene's description of parts that are made (core/scene/scene.hpp, ShapeSpec) with the generators (shapes/generated_part.hpp)
/// and the designer's own programs (shapes/mesh_program.hpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/shapes/generated_part.hpp"

namespace fettle::design::reading {

/// May a file's parts be made by the programs that it names? Never because the file says so: because the user does.
enum class Programs { refused, allowed };

/// The part of a generator. The only count is `segments`.
Result<std::shared_ptr<const shapes::GeneratedPart>> generated_part(const core::scene::ShapeSpec& spec);
/// The part that a scene asks for. Errors (unsupported): a program where programs are refused.
Result<std::shared_ptr<const description::Shape>> shape_of_spec(const core::scene::ShapeSpec& spec, Programs programs);

/// What read_scene needs to make the parts of this program, and where it looks for meshes.
core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs = {}, Programs programs = Programs::refused);

}  // namespace fettle::design::reading
