// SPDX-License-Identifier: MIT
/// Bounding volume hierarchy of one body, built once in the body's own frame and moved with it.
/// Leaves hold elements: triangles, then codimensional edges, then codimensional points. Each vertex and each edge is owned by exactly one
/// element that contains it, so that visiting pairs of elements visits each pair of primitives once.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/flat_features.hpp"
#include "core/geometry/mesh.hpp"

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

/// Axis-aligned, in the body's frame, rounded outwards to single precision. A box of nothing has low above high.
struct OwnedBox {
    static constexpr float nowhere = std::numeric_limits<float>::infinity();
    std::array<float, 3> low{nowhere, nowhere, nowhere}, high{-nowhere, -nowhere, -nowhere};
    bool is_empty() const { return low[0] > high[0]; }
};

class BodyHierarchy {
public:
    /// @param flat  of the mesh: whose plane edges edge_boxes() leaves out; null: there are no edge_boxes()
    /// Contract: connectivity built, at least one vertex, finite coordinates.
    explicit BodyHierarchy(const geometry::Mesh& mesh, const FlatFeatures* flat = nullptr);

    const std::vector<HierarchyNode>& nodes() const { return nodes_; }  ///< root is 0

    /// [node] Of the vertices that the node's elements own, and of the edges that they own and that are not plane.
    const std::vector<OwnedBox>& vertex_boxes() const { return vertex_boxes_; }
    const std::vector<OwnedBox>& edge_boxes() const { return edge_boxes_; }
    const std::vector<HierarchyElement>& elements() const { return elements_; }

    /// The mesh's triangles, then its codimensional edges as (e0, e1, e1) and points as (p, p, p), whose distances, closest points and CCD
    /// are those of the edge or point: so isolated points meet them as they meet triangles.
    const std::vector<geometry::Triangle>& faces() const { return faces_; }

private:
    std::vector<HierarchyNode> nodes_;
    std::vector<HierarchyElement> elements_;
    std::vector<geometry::Triangle> faces_;
    std::vector<OwnedBox> vertex_boxes_, edge_boxes_;
};

}  // namespace fettle::core::geometry
