// SPDX-License-Identifier: MIT
/// What the readers of scenes share: angles in degrees, scale, and where a mesh file is looked for.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::scene {

double radians(double degrees);

/// R = Rz(c) Ry(b) Rx(a) for [a, b, c] in degrees; exact for multiples of 90.
Matrix3 rotation_from_degrees(const Vector3& angles);

/// Scales about the file's origin. A mirror image (an odd number of negative factors) has its triangles turned, so that a solid stays
/// a solid. Vertices that become equal are left as they are.
void scale_mesh(geometry::Mesh& mesh, const Vector3& factors);

/// Every triangle seen from the other side; edges and shells anew.
void turn_triangles(geometry::Mesh& mesh);

/// One mesh per edge-connected shell, named after it, its vertices in their order; loose edges and points belong to none. A mesh without
/// triangles stays whole.
std::vector<geometry::Mesh> split_shells(const geometry::Mesh& mesh);

/// The first that exists of: `name` if absolute; beside the scene file; under each of `mesh_dirs`; under `meshes/` of each folder above the
/// scene file, nearest first. file_not_found lists where it was looked for.
base::Result<std::string> find_mesh_file(const std::string& name, const std::string& scene_path, const std::vector<std::string>& mesh_dirs,
                                         const std::string& where);

}  // namespace fettle::core::scene
