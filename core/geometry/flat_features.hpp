// SPDX-License-Identifier: MIT
/// Where a mesh is flat: edges between two triangles of one plane, and vertices with nothing but such edges round them. They are marks of
/// the triangulation and no feature of the solid: contact counts a plane face once, however it is cut (contact/contact_set.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Facets grow from the largest triangles, over edges with exactly two triangles, one on each side, as far as all vertices lie within
/// `flatness` of the first triangle's plane: what is curved finely stays in pieces no farther from a plane than that. An edge is flat if
/// both its triangles are of one facet. A vertex is flat if all its edges are. An edge is plane if it is flat as exactly as numbers are:
/// all vertices of its two triangles lie within `plane` flatness of the first triangle's plane, and the triangles are no slivers beside
/// that.
struct FlatFeatures {
    std::vector<std::uint8_t> edge;        ///< [edge of the mesh] 1: flat; empty where the mesh has none
    std::vector<std::uint8_t> face;        ///< [triangle] bit k: the edge from corner k to the next is flat; bit 3 + k: corner k is
    double height = 0;                     ///< largest distance of a vertex from its facet's plane [m]
    std::vector<std::uint8_t> plane_edge;  ///< [edge of the mesh] 1: plane; empty where the mesh has no flat edge
    double plane_height = 0;               ///< bound of that distance for the triangles at plane edges, rounding included [m]

    bool any() const { return !edge.empty(); }
    bool is_flat_edge(int e) const { return any() && edge[e] != 0; }
    bool is_plane_edge(int e) const { return any() && plane_edge[e] != 0; }
    /// 0 for the faces of wires and points, which come after the triangles (BodyHierarchy::faces).
    unsigned of_face(int f) const { return static_cast<std::size_t>(f) < face.size() ? face[f] : 0U; }
};

/// A share of the flatness: what is no farther from a plane is on it, but for the last digits of coordinates.
inline constexpr double plane = 1e-7;

/// @param flatness  [m]. Contract: connectivity built.
FlatFeatures flat_features(const Mesh& mesh, double flatness);

}  // namespace fettle::core::geometry
