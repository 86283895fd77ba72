// SPDX-License-Identifier: MIT
/// Bounding volume hierarchy of one body, built once in the body's own frame and moved with it.
/// Leaves hold elements: triangles, then codimensional edges, then codimensional points. Each vertex and each edge is owned by exactly one
/// element that contains it, so that visiting pairs of elements visits each pair of primitives once.
#pragma once

#include <array>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::geometry {

struct HierarchyNode {
    Vector3 center = Vector3::Zero();       ///< of the axis-aligned box in the body's frame
    Vector3 half_extent = Vector3::Zero();  ///< rounded outwards: the box contains its elements exactly
    double radius = 0;                      ///< upper bound of |X| over the node's points: speed <= |dq| + |w| radius
    int left = -1, right = -1;              ///< children; -1 for a leaf
    int first = 0, count = 0;               ///< range in `elements()` (of the whole subtree)
    bool is_leaf() const { return left < 0; }
};

/// What an element owns. `vertices` of triangle elements are its three corners; edges have two, points one.
struct HierarchyElement {
    int triangle = -1;  ///< -1: a codimensional edge or point
    int face = -1;      ///< index into BodyHierarchy::faces()
    int vertex_count = 0;
    std::array<int, 3> vertices{-1, -1, -1};
    int owned_vertex_count = 0, owned_edge_count = 0;
    std::array<int, 3> owned_vertices{-1, -1, -1};
    std::array<int, 3> owned_edges{-1, -1, -1};
    std::array<int, 3> owned_vertex_corner{};                ///< where in `vertices` each owned vertex stands
    std::array<std::array<int, 2>, 3> owned_edge_corners{};  ///< the same for the ends of each owned edge, in the edge's order
};

class BodyHierarchy {
public:
    /// Contract: connectivity built, at least one vertex, finite coordinates.
    explicit BodyHierarchy(const geometry::Mesh& mesh);

    const std::vector<HierarchyNode>& nodes() const { return nodes_; }  ///< root is 0
    const std::vector<HierarchyElement>& elements() const { return elements_; }

    /// The mesh's triangles, then its codimensional edges as (e0, e1, e1) and points as (p, p, p), whose distances, closest points and CCD
    /// are those of the edge or point: so isolated points meet them as they meet triangles.
    const std::vector<geometry::Triangle>& faces() const { return faces_; }

private:
    std::vector<HierarchyNode> nodes_;
    std::vector<HierarchyElement> elements_;
    std::vector<geometry::Triangle> faces_;
};

}  // namespace fettle::core::geometry
