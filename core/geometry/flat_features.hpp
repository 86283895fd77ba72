// SPDX-License-Identifier: MIT
/// Where a mesh is flat: edges between two triangles of one plane, and vertices with nothing but such edges round them. They are marks of
/// the triangulation and no feature of the solid: contact counts a plane face once, however it is cut (contact/contact_set.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// An edge is flat if it has exactly two triangles, one on each side, and the far vertex of each lies within `flatness` of the plane of the
/// other. A vertex is flat if all its edges are, and it has no edge without triangles.
struct FlatFeatures {
    std::vector<std::uint8_t> edge;  ///< [edge of the mesh] 1: flat; empty where the mesh has none
    std::vector<std::uint8_t> face;  ///< [triangle] bit k: the edge from corner k to the next is flat; bit 3 + k: corner k is
    double height = 0;               ///< largest distance of a far vertex from the other plane, of the flat edges [m]

    bool any() const { return !edge.empty(); }
    bool is_flat_edge(int e) const { return any() && edge[static_cast<std::size_t>(e)] != 0; }
    /// 0 for the faces of wires and points, which come after the triangles (BodyHierarchy::faces).
    unsigned of_face(int f) const { return static_cast<std::size_t>(f) < face.size() ? face[static_cast<std::size_t>(f)] : 0U; }
};

/// @param flatness  [m]. Contract: connectivity built.
FlatFeatures flat_features(const Mesh& mesh, double flatness);

}  // namespace fettle::core::geometry
