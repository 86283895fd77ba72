// SPDX-License-Identifier: MIT
/// Meshes made from meshes: scaled, turned inside out, cut into shells.
#pragma once

#include <vector>

#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Scales about the file's origin. A mirror image (an odd number of negative factors) has its triangles turned, so that a solid stays
/// a solid. Vertices that become equal are left as they are.
void scale_mesh(Mesh& mesh, const Vector3& factors);

/// Every triangle seen from the other side; edges and shells anew.
void turn_triangles(Mesh& mesh);

/// One mesh per edge-connected shell, named after it, its vertices in their order; loose edges and points belong to none. A mesh without
/// triangles stays whole.
std::vector<Mesh> split_shells(const Mesh& mesh);

}  // namespace fettle::core::geometry
