// SPDX-License-Identifier: MIT
/// What the readers of scenes take besides the file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene.hpp"

namespace fettle::core::scene {

/// Makes the mesh of a `shape` body [m]. Errors: their `where` is replaced by the body's place in the file.
using ShapeGenerator = std::function<base::Result<geometry::Mesh>(const ShapeSpec&)>;

struct ReadOptions {
    std::vector<std::string> mesh_dirs;      ///< also looked in for meshes; see find_mesh_file in mesh_files/find_mesh_file.hpp
    ShapeGenerator shape_generator;          ///< empty: a body with `shape` is an error that says so
    std::function<bool()> should_stop = {};  ///< optional, asked on any thread while a mesh is read that may take long: true ends it
    bool strict_meshes = false;  ///< meshes of our own format: MeshPolicy::strict, and nothing is repaired (solids/mesh_repair.hpp)
};

}  // namespace fettle::core::scene
