// SPDX-License-Identifier: MIT
#include "core/mesh_files/find_mesh_file.hpp"

#include <filesystem>

namespace fettle::core::mesh_files {

base::Result<std::string> find_mesh_file(const std::string& name, const std::string& scene_path, const std::vector<std::string>& mesh_dirs,
                                         const std::string& where) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    std::vector<fs::path> candidates;
    const fs::path folder = fs::absolute(scene_path, ignored).lexically_normal().parent_path();
    if (fs::path(name).is_absolute()) {
        candidates.emplace_back(name);
    } else {
        candidates.push_back(folder / name);
        for (const auto& dir : mesh_dirs) candidates.push_back(fs::path(dir) / name);
        fs::path above = folder;
        while (true) {
            candidates.push_back(above / "meshes" / name);
            if (above == above.parent_path()) break;
            above = above.parent_path();
        }
    }
    for (const auto& candidate : candidates) {
        if (fs::is_regular_file(candidate, ignored)) return candidate.string();
    }
    std::string looked = folder.string();
    for (const auto& dir : mesh_dirs) looked += ", " + dir;
    if (fs::path(name).is_absolute()) {
        return base::Error{base::ErrorCode::file_not_found, where, "mesh file " + name + " does not exist"};
    }
    return base::Error{base::ErrorCode::file_not_found, where,
                       "mesh file \"" + name + "\" was not found in " + looked +
                           ", nor in meshes/ of any folder above the scene; correct the name or add a folder with --mesh-dir"};
}

}  // namespace fettle::core::mesh_files
