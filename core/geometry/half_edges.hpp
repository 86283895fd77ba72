// SPDX-License-Identifier: MIT
/// The sides of a mesh's triangles, sorted so that those of one edge stand together: what checks and repairs of meshes walk over.
#pragma once

#include <cstddef>
#include <vector>

#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// One side of a triangle: its undirected edge, whether it runs from the smaller index to the larger, and whose it is.
struct HalfEdge {
    int low, high;
    bool forward;
    int triangle;

    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// By edge, then by triangle.
std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh);

/// Calls visit(first, last) with the range of half edges of each edge.
template <class Visit>
void visit_edges(const std::vector<HalfEdge>& halves, const Visit& visit) {
    for (std::size_t first = 0, last = 0; first < halves.size(); first = last) {
        for (last = first + 1; last < halves.size() && halves[last].same_edge(halves[first]);) ++last;
        visit(first, last);
    }
}

/// In exactly two triangles, once in each direction, between two vertices.
inline bool is_sound_edge(const std::vector<HalfEdge>& halves, std::size_t first, std::size_t last) {
    return last - first == 2 && halves[first].forward != halves[first + 1].forward && halves[first].low != halves[first].high;
}

}  // namespace fettle::core::geometry
