// SPDX-License-Identifier: MIT
/// Joins the scene's description of parts that are made (core/scene/scene.hpp, ShapeSpec) with the parts of files (shapes/file_part.hpp)
/// and the designer's own programs (shapes/mesh_program.hpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/read_record.hpp"
#include "core/base/result.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/description/shape.hpp"

namespace fettle::design::reading {

/// May a file's parts be made by the programs that it names? Never because the file says so: because the user does.
enum class Programs { refused, allowed };

/// A part that was made while a scene was read. Errors (unsupported): a program where programs are refused.
struct MadePart {
    core::scene::ShapeSpec spec;
    std::shared_ptr<const description::Shape> shape;
    core::geometry::Mesh mesh;                 ///< as drawn
    core::base::ReadRecord::Files files = {};  ///< that it was made of
};

/// What read_scene needs to make the parts of this program, and where it looks for meshes. Each part is made once, however many bodies are
/// like it. For one thread at a time.
/// @param made          Gets the parts.
/// @param finer_facets  So many times as many facets along what is round, of parts that are files.
core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs = {}, Programs programs = Programs::refused,
                                            const std::shared_ptr<std::vector<MadePart>>& made = std::make_shared<std::vector<MadePart>>(),
                                            int finer_facets = 1);

}  // namespace fettle::design::reading
