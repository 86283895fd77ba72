// SPDX-License-Identifier: MIT
/// Pairs of primitives of two bodies: by their vertices in space, and by index into the bodies' meshes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

enum class PairType { point_triangle, edge_edge };

/// Vertices of a pair: point_triangle p t0 t1 t2, edge_edge ea0 ea1 eb0 eb1.
using PairVertices = std::array<Vector3, 4>;

/// How many of the four vertices lie on the first body.
inline int first_count(PairType type) { return type == PairType::point_triangle ? 1 : 2; }

/// Two primitives by index into their bodies' meshes, and a lower bound of their distance along the segments: while the bodies have left
/// those by less, the pair needs no second look.
struct PrimitivePair {
    int a = 0, b = 0;
    double distance = 0;  ///< proven [m]; never NaN
};

/// Primitives of two bodies, by kind. Each list is sorted by distance.
struct PrimitivePairs {
    std::vector<PrimitivePair> vertex_triangle;  ///< vertex of a, face of b (BodyHierarchy::faces: triangles first)
    std::vector<PrimitivePair> triangle_vertex;  ///< face of a, vertex of b
    std::vector<PrimitivePair> edge_edge;        ///< edge of a, edge of b
    bool empty() const { return vertex_triangle.empty() && triangle_vertex.empty() && edge_edge.empty(); }
    std::size_t size() const { return vertex_triangle.size() + triangle_vertex.size() + edge_edge.size(); }
};

/// Pairs of bodies that a thread takes at a time, 1 to 16: so many that there is something to do for all their pairs of primitives.
inline int pairs_at_once(std::size_t pairs, std::size_t primitives) {
    constexpr std::size_t enough = 128, most = 16;
    return static_cast<int>(std::clamp<std::size_t>(enough * pairs / std::max<std::size_t>(primitives, 1), 1, most));
}

}  // namespace fettle::core::geometry
