// SPDX-License-Identifier: MIT
/// A robot description as a scene file of ours: one body for each link with geometry, its meshes written beside it, joints with limits,
/// damping and friction.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "design/urdf/link_mesh.hpp"
#include "design/urdf/robot.hpp"

namespace fettle::design::urdf {

struct ImportOptions {
    MeshFolders meshes;
    std::string stem = "robot";  ///< of what is written: STEM.scene.json, STEM.meshes/LINK.obj
    bool floating = false;       ///< is the root free? else it is static
};

struct ImportedScene {
    std::vector<std::pair<std::string, std::string>> files;  ///< name and contents; the scene first
    std::vector<std::string> warnings;                       ///< what a scene cannot say, or says otherwise
};

/// Where joints stand: joint_starts.hpp. A link's geometry becomes one mesh in the link's frame (link_mesh.hpp). Mass and inertia are the
/// file's; where it has no inertia, or one that no body has (a warning), the density is mass over volume, and the inertia that of the
/// solid. Links without geometry are frames: of their parent if they are fixed to it, which takes their mass and inertia, of the world if
/// they are a root; with a joint that moves they are left out where nothing with geometry hangs from them. What is fixed to the world is
/// static. What a scene does not use is kept in it for export (robot_notes.hpp): colours, frames, effort, velocity, the coordinate at the
/// start; the rest is told in `warnings`, by name. Errors: of meshes; unsupported (a link without geometry that moves one with geometry);
/// inconsistent (links that form no tree, joint_starts.hpp).
Result<ImportedScene> scene_of_robot(const Robot& robot, const ImportOptions& options);

}  // namespace fettle::design::urdf
