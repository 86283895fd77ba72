// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/leaf_search.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/base/stop.hpp"
#include "fettle/core/ccd/four_separations.hpp"
#include "fettle/core/ccd/placed_body.hpp"

namespace fettle::core::ccd {
namespace {

using base::lanes;
using geometry::HierarchyElement;
using geometry::PairType;

// Two elements or two primitives that may come close, where they were placed, and what is charged to their distance.
struct PlacedPair {
    int a, b;
    double lost;
};
struct PlacedPrimitives {
    PlacedPair pair;
    std::array<int, 4> vertex;  // as in geometry::PairVertices
};

class LeafSearch {
public:
    LeafSearch(const SweptPair& pair, PlacedBody& a, PlacedBody& b, geometry::PrimitivePairs& out)
        : pair_(pair),
          a_(a),
          b_(b),
          elements_a_(pair.a->body->hierarchy->elements()),
          elements_b_(pair.b->body->hierarchy->elements()),
          out_(out) {
        // Relative to where body a is: what both have in common does not widen the boxes.
        std::array<Vector3, 2> offset;
        for (int e = 0; e < 2; ++e) offset[e] = pair.b->ends[e].position - pair.a->ends[e].position;
        a_.start(*pair.a, {Vector3::Zero(), Vector3::Zero()}, pair.plane_a);
        b_.start(*pair.b, offset, pair.plane_b);
    }

    void visit(const NodePair& leaves) {
        const geometry::HierarchyNode &na = pair_.a->body->hierarchy->nodes()[leaves[0]],
                                      &nb = pair_.b->body->hierarchy->nodes()[leaves[1]];
        const double lost = pair_.deviation(na.radius, nb.radius) + search_rounding * (pair_.world_size + pair_.reach);
        for (int i = na.first; i < na.first + na.count; ++i)
            for (int j = nb.first; j < nb.first + nb.count; ++j) {
                const int a = a_.place(i), b = b_.place(j);
                if (a_.element(a).box.is_apart(b_.element(b).box, pair_.margin + lost)) continue;
                visit_elements({a, b, lost});
            }
    }

    // What has not made four of a kind yet.
    void finish() {
        flush(PairType::point_triangle, vertex_triangle_, out_.vertex_triangle);
        flush(PairType::point_triangle, triangle_vertex_, out_.triangle_vertex);
        flush(PairType::edge_edge, edge_edge_, out_.edge_edge);
    }

private:
    // Elements whose boxes are close: their primitives, unless the plane of one of them separates them.
    void visit_elements(const PlacedPair& pair) {
        const PlacedElement &a = a_.element(pair.a), &b = b_.element(pair.b);
        const PlacedDetails &of_a = a_.details(pair.a), &of_b = b_.details(pair.b);
        const HierarchyElement &ea = elements_a_[a.element], &eb = elements_b_[b.element];
        // Within plane faces triangles own next to nothing.
        const bool has_edges = of_a.edge_count > 0 && of_b.edge_count > 0;
        if (ea.owned_vertex_count + eb.owned_vertex_count == 0 && !has_edges) return;
        const double margin = pair_.margin + pair.lost;
        if (is_apart_along(of_a.normal, a, b, margin) || is_apart_along(of_b.normal, a, b, margin)) return;
        visit_vertices(pair, a, b);
        if (has_edges) visit_edges(pair, of_a, of_b, b);
    }

    struct Range {
        double low, high;
    };
    static Range along(const Vector3& n, const PlacedBody& body, const PlacedElement& e, std::size_t end) {
        const auto at = [&](int corner) {
            const SweptVertex& x = body.vertex(e.corners[corner]).x;
            return n[0] * x[end] + n[1] * x[end + 1] + n[2] * x[end + 2];
        };
        const double d0 = at(0), d1 = at(1), d2 = at(2);
        return {std::min(d0, std::min(d1, d2)), std::max(d0, std::max(d1, d2))};
    }
    bool is_apart_along(const Vector3& n, const PlacedElement& a, const PlacedElement& b, double margin) const {
        const Range a0 = along(n, a_, a, 0), b0 = along(n, b_, b, 0);
        if (a0.low - b0.high > margin) return along(n, a_, a, 3).low - along(n, b_, b, 3).high > margin;
        return b0.low - a0.high > margin && along(n, b_, b, 3).low - along(n, a_, a, 3).high > margin;
    }

    void visit_vertices(const PlacedPair& pair, const PlacedElement& a, const PlacedElement& b) {
        const HierarchyElement &ea = elements_a_[a.element], &eb = elements_b_[b.element];
        const double margin = pair_.margin + pair.lost;
        if (takes_vertices(ea, eb, true))
            for (int k = 0; k < ea.owned_vertex_count; ++k) {
                const int corner = a.corners[ea.owned_vertex_corner[k]];
                if (a_.vertex(corner).box.is_apart(b.box, margin)) continue;
                add({{ea.owned_vertices[k], eb.face, pair.lost}, {corner, b.corners[0], b.corners[1], b.corners[2]}},
                    PairType::point_triangle, vertex_triangle_, out_.vertex_triangle);
            }
        if (takes_vertices(eb, ea, false))
            for (int k = 0; k < eb.owned_vertex_count; ++k) {
                const int corner = b.corners[eb.owned_vertex_corner[k]];
                if (b_.vertex(corner).box.is_apart(a.box, margin)) continue;
                add({{ea.face, eb.owned_vertices[k], pair.lost}, {corner, a.corners[0], a.corners[1], a.corners[2]}},
                    PairType::point_triangle, triangle_vertex_, out_.triangle_vertex);
            }
    }

    void visit_edges(const PlacedPair& pair, const PlacedDetails& of_a, const PlacedDetails& of_b, const PlacedElement& b) {
        const double margin = pair_.margin + pair.lost;
        for (int k = 0; k < of_a.edge_count; ++k) {
            const PlacedEdge& edge_a = of_a.edges[k];
            if (edge_a.box.is_apart(b.box, margin)) continue;
            for (int l = 0; l < of_b.edge_count; ++l) {
                const PlacedEdge& edge_b = of_b.edges[l];
                if (edge_a.box.is_apart(edge_b.box, margin)) continue;
                add({{edge_a.edge, edge_b.edge, pair.lost}, {edge_a.ends[0], edge_a.ends[1], edge_b.ends[0], edge_b.ends[1]}},
                    PairType::edge_edge, edge_edge_, out_.edge_edge);
            }
        }
    }

    // Vertices that `owner` owns against the face of `other`. Loose edges and points are faces for isolated points only: other vertices are
    // ends of edges, whose own pairs cover them. Two points are one pair, not two.
    static bool takes_vertices(const HierarchyElement& owner, const HierarchyElement& other, bool vertex_first) {
        return other.triangle >= 0 || (owner.vertex_count == 1 && (other.vertex_count > 1 || vertex_first));
    }

    using Waiting = std::vector<PlacedPrimitives>;
    void add(const PlacedPrimitives& primitives, PairType type, Waiting& waiting, std::vector<geometry::PrimitivePair>& list) {
        waiting.push_back(primitives);
        if (count_of(waiting) == lanes) flush(type, waiting, list);
    }

    // Up to four.
    void flush(PairType type, Waiting& waiting, std::vector<geometry::PrimitivePair>& list) {
        if (waiting.empty()) return;
        const bool swapped = &waiting == &triangle_vertex_;  // the vertex is on b
        const std::size_t on_first = geometry::first_count(type);
        FourPairs x;
        for (std::size_t k = 0; k < lanes; ++k) {
            const std::array<int, 4>& vertex = waiting[std::min(k, waiting.size() - 1)].vertex;  // the last ones again
            for (std::size_t i = 0; i < 4; ++i) x[i][k] = &((i < on_first) != swapped ? a_ : b_).vertex(vertex[i]).x;
        }
        const std::array<double, lanes> separations = four_separations(type, x);
        for (std::size_t k = 0; k < waiting.size(); ++k) {
            const PlacedPair& pair = waiting[k].pair;
            if (separations[k] > pair_.margin + pair.lost) continue;
            // In this order: what is not a number loses.
            list.push_back({pair.a, pair.b, std::max(-std::numeric_limits<double>::infinity(), separations[k] - pair.lost)});
        }
        waiting.clear();
    }

    const SweptPair& pair_;
    PlacedBody &a_, &b_;
    const std::vector<HierarchyElement>&elements_a_, &elements_b_;
    geometry::PrimitivePairs& out_;
    Waiting vertex_triangle_, triangle_vertex_, edge_edge_;
};

}  // namespace

void search_leaves(const SweptPair& pair, const std::vector<NodePair>& leaves, geometry::PrimitivePairs& out) {
    if (leaves.empty()) return;
    // Kept for their memory.
    static thread_local PlacedBody placed_a, placed_b;
    LeafSearch search(pair, placed_a, placed_b, out);
    for (const NodePair& l : leaves) {
        base::stop_if_asked();
        search.visit(l);
    }
    search.finish();
}

}  // namespace fettle::core::ccd
