// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/leaf_search.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/base/stop.hpp"
#include "fettle/core/ccd/separating_plane.hpp"

namespace fettle::core::ccd {
namespace {

using Ends = std::array<Vector3, 2>;  // a vertex at both ends of the segments

// An element at both ends: corners (of edges and points repeated to three, as in BodyHierarchy::faces), box, and normal at the start.
struct SweptElement {
    std::array<Ends, 3> corners;
    Vector3 low, high;
    Vector3 normal;  // zero: has none
};

// `origin`: what positions are relative to, at each end.
SweptElement swept_element(const SweptBody& s, const geometry::HierarchyElement& e, const Ends& origin) {
    SweptElement out;
    const geometry::Triangle& face = s.body->hierarchy->faces()[e.face];
    for (int k = 0; k < 3; ++k) {
        const auto X = s.body->mesh.vertices.col(face[k]);
        for (int end = 0; end < 2; ++end) out.corners[k][end] = s.ends[end].rotation * X + origin[end];
    }
    const auto& c = out.corners;
    out.low = c[0][0].cwiseMin(c[0][1]);
    out.high = c[0][0].cwiseMax(c[0][1]);
    for (int k = 1; k < e.vertex_count; ++k) {
        out.low = out.low.cwiseMin(c[k][0].cwiseMin(c[k][1]));
        out.high = out.high.cwiseMax(c[k][0].cwiseMax(c[k][1]));
    }
    out.normal = (c[1][0] - c[0][0]).cross(c[2][0] - c[0][0]);
    const double length = out.normal.norm();
    // Shortened: a direction of length at most 1 keeps the separations along it true.
    out.normal = length > 0 ? Vector3(out.normal * ((1 - 1e-14) / length)) : Vector3(Vector3::Zero());
    return out;
}

// Elements of the leaves that a search has looked at. Cleared in the time that it took to fill.
class PlacedLeaves {
public:
    void start(const SweptBody& body, const Ends& origin) {
        body_ = &body;
        origin_ = origin;
        for (const int node : filled_) first_[node] = -1;
        filled_.clear();
        elements_.clear();
        const std::size_t nodes = body.body->hierarchy->nodes().size();
        if (first_.size() < nodes) first_.resize(nodes, -1);
    }
    // Where the leaf's elements start.
    int place(int node) {
        if (first_[node] >= 0) return first_[node];
        const geometry::BodyHierarchy& hierarchy = *body_->body->hierarchy;
        const geometry::HierarchyNode& leaf = hierarchy.nodes()[node];
        first_[node] = count_of(elements_);
        filled_.push_back(node);
        for (int k = leaf.first; k < leaf.first + leaf.count; ++k)
            elements_.push_back(swept_element(*body_, hierarchy.elements()[k], origin_));
        return first_[node];
    }
    const SweptElement& operator[](int i) const { return elements_[i]; }

private:
    const SweptBody* body_ = nullptr;
    Ends origin_;
    std::vector<int> first_;  // per node of the hierarchy; -1: not looked at
    std::vector<int> filled_;
    std::vector<SweptElement> elements_;
};

class LeafSearch {
public:
    LeafSearch(const SweptPair& pair, PlacedLeaves& placed_a, PlacedLeaves& placed_b, geometry::PrimitivePairs& out)
        : pair_(pair),
          body_a_(*pair.a->body->hierarchy),
          body_b_(*pair.b->body->hierarchy),
          placed_a_(placed_a),
          placed_b_(placed_b),
          out_(out) {
        // Relative to where body a is: what both have in common does not widen the boxes.
        Ends offset;
        for (int e = 0; e < 2; ++e) offset[e] = pair.b->ends[e].position - pair.a->ends[e].position;
        placed_a_.start(*pair.a, {Vector3::Zero(), Vector3::Zero()});
        placed_b_.start(*pair.b, offset);
    }

    void visit(const NodePair& leaves) {
        const geometry::HierarchyNode &na = body_a_.nodes()[leaves[0]], &nb = body_b_.nodes()[leaves[1]];
        lost_ = pair_.deviation(na.radius, nb.radius) + search_rounding * (pair_.world_size + pair_.reach);
        margin_ = pair_.margin + lost_;
        const int first_a = placed_a_.place(leaves[0]), first_b = placed_b_.place(leaves[1]);
        for (int i = 0; i < na.count; ++i)
            for (int j = 0; j < nb.count; ++j) {
                const SweptElement &a = placed_a_[first_a + i], &b = placed_b_[first_b + j];
                if (apart(a, b) || apart_along(a.normal, a, b) || apart_along(b.normal, a, b)) continue;
                visit_elements(body_a_.elements()[na.first + i], a, body_b_.elements()[nb.first + j], b);
            }
    }

private:
    bool apart(const SweptElement& a, const SweptElement& b) const {
        return ((a.low - b.high).array() > margin_).any() || ((b.low - a.high).array() > margin_).any();
    }

    struct Range {
        double low, high;
    };
    static Range along(const Vector3& n, const SweptElement& e, int end) {
        const double d0 = n.dot(e.corners[0][end]), d1 = n.dot(e.corners[1][end]), d2 = n.dot(e.corners[2][end]);
        return {std::min(d0, std::min(d1, d2)), std::max(d0, std::max(d1, d2))};
    }
    bool apart_along(const Vector3& n, const SweptElement& a, const SweptElement& b) const {
        const Range a0 = along(n, a, 0), b0 = along(n, b, 0);
        if (a0.low - b0.high > margin_) return along(n, a, 1).low - along(n, b, 1).high > margin_;
        return b0.low - a0.high > margin_ && along(n, b, 1).low - along(n, a, 1).high > margin_;
    }

    // Lower bound of the distance of the chords: the better of the planes between the closest points at each end.
    double least_separation(geometry::PairType type, const std::array<Ends, 4>& x) const {
        const RelativeMotion motion = relative_motion(type, {x[0][0], x[1][0], x[2][0], x[3][0]}, {x[0][1], x[1][1], x[2][1], x[3][1]});
        double best = 0;
        const bool still = pair_.a->still && pair_.b->still;
        for (int end = 0; end < (still ? 1 : 2); ++end) {
            const ClosestDirection c = closest_direction(type, end == 0 ? motion.d : motion.e);
            const SeparatingPlane s = separating_plane(motion, c.direction, 0, end);
            best = std::max(best, std::min(s.p.minCoeff(), s.q.minCoeff()) - s.limit);
            if (best > margin_) break;
        }
        return motion.usable ? best : 0;
    }

    void add(std::vector<geometry::PrimitivePair>& list, int i, int j, geometry::PairType type, const std::array<Ends, 4>& x) const {
        const double separation = least_separation(type, x);
        if (separation > margin_) return;
        // In this order: what is not a number loses.
        list.push_back({i, j, std::max(-std::numeric_limits<double>::infinity(), separation - lost_)});
    }

    // A box of one or two vertices at both ends against an element's.
    bool ends_apart(const Ends& p, const Ends& q, const SweptElement& e) const {
        const Vector3 low = p[0].cwiseMin(p[1]).cwiseMin(q[0].cwiseMin(q[1])), high = p[0].cwiseMax(p[1]).cwiseMax(q[0].cwiseMax(q[1]));
        return ((low - e.high).array() > margin_).any() || ((e.low - high).array() > margin_).any();
    }

    // Vertices that `owner` owns against the face of `other`.
    void visit_vertices(const geometry::HierarchyElement& owner, const SweptElement& v, const geometry::HierarchyElement& other,
                        const SweptElement& t, bool vertex_first) {
        // Loose edges and points are faces for isolated points only: other vertices are ends of edges, whose own pairs cover them. Two
        // points are one pair, not two.
        if (other.triangle < 0 && (owner.vertex_count > 1 || (other.vertex_count == 1 && !vertex_first))) return;
        for (int k = 0; k < owner.owned_vertex_count; ++k) {
            const Ends& p = v.corners[owner.owned_vertex_corner[k]];
            if (ends_apart(p, p, t)) continue;
            const int i = owner.owned_vertices[k];
            const std::array<Ends, 4> x{p, t.corners[0], t.corners[1], t.corners[2]};
            if (vertex_first)
                add(out_.vertex_triangle, i, other.face, geometry::PairType::point_triangle, x);
            else
                add(out_.triangle_vertex, other.face, i, geometry::PairType::point_triangle, x);
        }
    }

    void visit_elements(const geometry::HierarchyElement& ea, const SweptElement& a, const geometry::HierarchyElement& eb,
                        const SweptElement& b) {
        visit_vertices(ea, a, eb, b, true);
        visit_vertices(eb, b, ea, a, false);
        for (int k = 0; k < ea.owned_edge_count; ++k) {
            const Ends &a0 = a.corners[ea.owned_edge_corners[k][0]], &a1 = a.corners[ea.owned_edge_corners[k][1]];
            if (ends_apart(a0, a1, b)) continue;
            const Vector3 low = a0[0].cwiseMin(a0[1]).cwiseMin(a1[0].cwiseMin(a1[1]));
            const Vector3 high = a0[0].cwiseMax(a0[1]).cwiseMax(a1[0].cwiseMax(a1[1]));
            for (int l = 0; l < eb.owned_edge_count; ++l) {
                const Ends &b0 = b.corners[eb.owned_edge_corners[l][0]], &b1 = b.corners[eb.owned_edge_corners[l][1]];
                const Vector3 low_b = b0[0].cwiseMin(b0[1]).cwiseMin(b1[0].cwiseMin(b1[1]));
                const Vector3 high_b = b0[0].cwiseMax(b0[1]).cwiseMax(b1[0].cwiseMax(b1[1]));
                if (((low - high_b).array() > margin_).any() || ((low_b - high).array() > margin_).any()) continue;
                add(out_.edge_edge, ea.owned_edges[k], eb.owned_edges[l], geometry::PairType::edge_edge, {a0, a1, b0, b1});
            }
        }
    }

    const SweptPair& pair_;
    const geometry::BodyHierarchy &body_a_, &body_b_;
    PlacedLeaves &placed_a_, &placed_b_;
    double margin_ = 0, lost_ = 0;  // of the pair of leaves being visited
    geometry::PrimitivePairs& out_;
};

}  // namespace

void search_leaves(const SweptPair& pair, const std::vector<NodePair>& leaves, geometry::PrimitivePairs& out) {
    if (leaves.empty()) return;
    // Kept for their memory.
    static thread_local PlacedLeaves placed_a, placed_b;
    LeafSearch search(pair, placed_a, placed_b, out);
    for (const NodePair& l : leaves) {
        base::stop_if_asked();
        search.visit(l);
    }
}

}  // namespace fettle::core::ccd
