// SPDX-License-Identifier: MIT
/// A robot description as a scene file of ours: one body for each link with geometry, its meshes written beside it, joints with limits,
/// damping and friction.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fettle/design/urdf/robot.hpp"

namespace fettle::design::urdf {

struct ImportOptions {
    std::string folder;                  ///< of the URDF file: relative mesh names are looked for there
    std::vector<std::string> mesh_dirs;  ///< and there; package://NAME/x is looked for as NAME/x and x, in these and in the folders above
    std::string stem = "robot";          ///< of what is written: STEM.scene.json, STEM.meshes/LINK.obj
    bool floating = false;               ///< is the root free? else it is static
};

struct ImportedScene {
    std::vector<std::pair<std::string, std::string>> files;  ///< name and contents; the scene first
    std::vector<std::string> warnings;                       ///< what a scene cannot say, or says otherwise
};

/// At coordinates 0 (or the limit nearest to it). A link's geometry becomes one mesh in the link's frame; cylinders and spheres become
/// polyhedra inside them. Mass and inertia are the file's; where it has no inertia, or one that no body has (a warning), the density is
/// mass over volume, and the inertia that of the solid. Links without geometry are frames: of their parent if they are fixed to it, which
/// takes their mass and inertia, of the world if they are a root; what is fixed to the world is static. Errors: of meshes; unsupported (a
/// link without geometry that moves, what mimics a joint that does not turn); inconsistent (links that form no tree).
Result<ImportedScene> scene_of_robot(const Robot& robot, const ImportOptions& options);

}  // namespace fettle::design::urdf
