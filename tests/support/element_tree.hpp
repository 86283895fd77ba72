// SPDX-License-Identifier: MIT
/// Which elements of two moving bodies can come near each other? A tree of boxes per body, in the body's own frame: culling for the
/// intersection oracle, with code of its own, so that the judge shares nothing with core/contact.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::tests::support {

enum class ElementKind { triangle, edge, point };
const char* to_string(ElementKind kind);

/// A triangle, or an edge of no triangle, or a vertex of no edge.
struct Element {
    ElementKind kind = ElementKind::triangle;
    int index = 0;                         ///< into the mesh's triangles, edges, or vertices
    std::array<int, 3> vertices{0, 0, 0};  ///< the first vertex_count(element) count
};
inline int vertex_count(const Element& e) { return 3 - static_cast<int>(e.kind); }

/// How far a body's points can be from where they are in one pose: a point X is within q + r |X| of its place there.
struct Spread {
    double q = 0, r = 0;
};
/// During `duration` (in s) of a segment, from any pose of it: a point's speed is at most |dq| + |dtheta| |X|. Rounding of poses and
/// positions is included.
Spread spread_of(const core::kinematics::PathSegment& path, double duration);

class ElementTree {
public:
    /// Takes a copy of what it needs. Contract: at least one vertex, finite.
    explicit ElementTree(const core::geometry::Mesh& mesh);

    const std::vector<Element>& elements() const { return elements_; }
    bool has_loose_elements() const { return has_loose_elements_; }  ///< edges or points

    double element_size() const { return element_size_; }  ///< mean largest half extent

    struct Node {
        Vector3 center = Vector3::Zero(), half = Vector3::Zero();  ///< axis-aligned in the body's frame
        double radius = 0;                                         ///< largest |X|
        int left = -1, right = -1;                                 ///< children; -1 for a leaf
        int first = 0, count = 0;                                  ///< elements of a leaf
    };
    const std::vector<Node>& nodes() const { return nodes_; }  ///< root is 0

private:
    int build(int first, int count, const core::geometry::Mesh& mesh);
    std::vector<Element> elements_;
    std::vector<Node> nodes_;
    bool has_loose_elements_ = false;
    double element_size_ = 0;
};

/// A body for the search: its tree, one pose, and how far from there its points can be.
struct SpreadBody {
    const ElementTree& tree;
    core::kinematics::Pose pose;
    Spread spread;
};

/// Pairs of elements (indices into elements()) that include all that touch while each body is within its spread. Conservative.
std::vector<std::pair<int, int>> near_elements(const SpreadBody& a, const SpreadBody& b);

}  // namespace fettle::tests::support
