// SPDX-License-Identifier: MIT
/// A design as a scene file: the scene that it names, with what it sets, at the values of its parameters. These, and the design's
/// variables, become variables of the scene, so that its formulas stay formulas.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/scene/read_options.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::reading {

/// @param scenario  Whose scene it is, of a design with scenarios. Names of meshes and parts are written as they are from the new file's
/// folder. What is written is read again: every number that a design can move, and every mesh, has to be as the design has it.
/// @param path     of the file that is to be.
/// @param options  What scenes are read with (scene_read_options).
/// Errors: of the files; unsupported, by place: what a scene file cannot say of this design (a formula of the design's variables with a
/// number that counts in the design's unit, where the scene's is another).
Result<std::string> scene_text(const DesignFile& file, const std::string& path, const core::scene::ReadOptions& options, int scenario = 0);

}  // namespace fettle::design::reading
