// SPDX-License-Identifier: MIT
/// Meshes made from meshes: scaled, turned inside out, cut into shells.
#pragma once

#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Scales about the file's origin. A mirror image (an odd number of negative factors) has its triangles turned, so that a solid stays
/// a solid. Vertices that become equal are left as they are.
void scale_mesh(Mesh& mesh, const Vector3& factors);

/// Every triangle seen from the other side; edges and shells anew.
void turn_triangles(Mesh& mesh);

/// One mesh for each of `count` parts, named after its first shell, its vertices in their order; loose edges and points belong to none.
/// @param part_of_shell  which shells a part has; from 0. Contract: connectivity built, each part has a shell.
std::vector<Mesh> split_parts(const Mesh& mesh, const std::vector<int>& part_of_shell, int count);

}  // namespace fettle::core::geometry
