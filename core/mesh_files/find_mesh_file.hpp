// SPDX-License-Identifier: MIT
/// Where a mesh file that a scene names is looked for.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace fettle::core::mesh_files {

/// The first that exists of: `name` if absolute; beside the scene file; under each of `mesh_dirs`; under `meshes/` of each folder above the
/// scene file, nearest first. file_not_found lists where it was looked for.
base::Result<std::string> find_mesh_file(const std::string& name, const std::string& scene_path, const std::vector<std::string>& mesh_dirs,
                                         const std::string& where);

}  // namespace fettle::core::mesh_files
