// SPDX-License-Identifier: MIT
/// How fast the vertices of a part move with a dimension, from meshes of the part made a little beside it.
///
/// Where all meshes have the same triangles (perhaps in another order: vertices are matched by nearness) vertex by vertex,
///   dx/dd = (x+ - x-) / width,
/// exact but for the meshes' rounding and the third derivative. Where a program cuts the surface into other triangles only the surface's
/// normal velocity is known: of each triangle near each of its corners s = n . (closest point - point), and a vertex' velocity is the
/// least v with n_f . v = s_f for the triangles f round it, in the sense of least squares. To first order nothing else of the velocity
/// changes what a rigid body is.
#pragma once

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::design::shapes {

struct MeshVelocity {
    Matrix3X velocity;        ///< 3 x n [1]
    bool by_normals = false;  ///< else vertex by vertex
    double misfit = 0;        ///< by normals: largest |n_f . v - s_f| [1]; what triangles of another cut leave open
};

/// @param at           Where the velocity is wanted.  @param plus, minus  Made at the dimension + and - half the width.
/// @param width        [m].
/// Errors (mesh_invalid): another topology (number of shells, Euler characteristic): between these dimensions something appears, vanishes
/// or merges, and there is no derivative.
Result<MeshVelocity> mesh_velocity(const core::geometry::Mesh& at, const core::geometry::Mesh& plus, const core::geometry::Mesh& minus,
                                   double width);

}  // namespace fettle::design::shapes
