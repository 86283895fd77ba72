// SPDX-License-Identifier: MIT
/// The geometry of a link as one mesh. Cylinders and spheres become polyhedra inside them.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "design/urdf/robot.hpp"

namespace fettle::design::urdf {

struct MeshFolders {
    std::string folder;                  ///< of the URDF file: relative mesh names are looked for there
    std::vector<std::string> mesh_dirs;  ///< and there; package://NAME/x is looked for as NAME/x and x, in these and in the folders above
};

/// All geometry of a link (Link::geometry), in its frame. Errors: of meshes; unsupported (another geometry than those).
Result<core::geometry::Mesh> link_mesh(const Link& link, const MeshFolders& where);

}  // namespace fettle::design::urdf
