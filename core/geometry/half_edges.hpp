// SPDX-License-Identifier: MIT
/// The sides of a mesh's triangles, sorted so that those of one edge stand together, for checks and repairs of meshes to walk over; and
/// edges by number. All in linear time (counting by the smaller index) where indices are as dense as a mesh has them; right for any
/// integers.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// One side of a triangle: its undirected edge, whether it runs from the smaller index to the larger, and whose it is.
struct HalfEdge {
    int low, high;
    bool forward;
    int triangle;

    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// By edge, then by triangle, then by corner.
std::vector<HalfEdge> sorted_half_edges(const std::vector<Triangle>& triangles);
inline std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) { return sorted_half_edges(mesh.triangles); }

/// Calls visit(first, last) with the range of half edges of each edge.
template <class Visit>
void visit_edges(const std::vector<HalfEdge>& halves, const Visit& visit) {
    for (std::size_t first = 0, last = 0; first < halves.size(); first = last) {
        for (last = first + 1; last < halves.size() && halves[last].same_edge(halves[first]);) ++last;
        visit(first, last);
    }
}

/// How many edges there are between two vertices.
inline std::size_t count_edges(const std::vector<HalfEdge>& halves) {
    std::size_t count = 0;
    visit_edges(halves, [&](std::size_t first, std::size_t) { count += halves[first].low != halves[first].high ? 1 : 0; });
    return count;
}

/// In exactly two triangles, once in each direction, between two vertices.
inline bool is_sound_edge(const std::vector<HalfEdge>& halves, std::size_t first, std::size_t last) {
    return last - first == 2 && halves[first].forward != halves[first + 1].forward && halves[first].low != halves[first].high;
}

/// Edges of triangles, numbered as they first appear, triangle by triangle and corner by corner.
struct TriangleEdges {
    std::vector<Edge> edges;   ///< each as its first triangle runs along it
    std::vector<int> of_side;  ///< 3 per triangle: of the side from corner k to the next; -1 where both are the same vertex
};
TriangleEdges triangle_edges(const std::vector<Triangle>& triangles);

/// Finds edges by their ends.
class EdgeIndex {
public:
    explicit EdgeIndex(const std::vector<Edge>& edges);

    /// Position of the edge between a and b, in either direction, the last one if it is listed more than once; -1: none.
    int find(int a, int b) const;

private:
    struct Entry {
        int low, high, edge;
    };
    int lowest_ = 0;
    std::vector<int> first_;      ///< per smaller index, from lowest_: its first entry; empty: entries are sorted, and searched by halves
    std::vector<Entry> entries_;  ///< by smaller index, then by the larger, then by position
};

}  // namespace fettle::core::geometry
