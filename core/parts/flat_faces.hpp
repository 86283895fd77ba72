// SPDX-License-Identifier: MIT
/// The planes of the flat faces of two solids that are to be cut by each other. Faces that are flush to rounding have one plane, of
/// whichever solid they are and however it is turned: what is exact from there on sees them flush.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::parts {

/// A mesh, and per triangle which flat face it is of; -1: of none.
struct FacedMesh {
    geometry::Mesh mesh;
    std::vector<int> face;
};

/// Points x with normal . x = offset. The normal's largest entry is 1 or -1.
struct FlatPlane {
    Vector3 normal;
    double offset = 0;
};

struct FlatFaces {
    std::vector<FlatPlane> planes;
    std::array<std::vector<std::vector<int>>, 2> of_vertex;  ///< of each mesh, per vertex: up to three planes that meet there at an angle
};

/// @param rounding  What vertices may be off by [m].
FlatFaces flat_faces(const FacedMesh& a, const FacedMesh& b, double rounding);

}  // namespace fettle::core::parts
