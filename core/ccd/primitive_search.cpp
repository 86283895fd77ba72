// SPDX-License-Identifier: MIT
#include "core/ccd/primitive_search.hpp"

#include <algorithm>
#include <limits>

#include "core/base/float_rounding.hpp"
#include "core/base/four.hpp"
#include "core/base/stop.hpp"
#include "core/ccd/four_separations.hpp"
#include "core/ccd/placed_tree.hpp"

namespace fettle::core::ccd {
namespace {

using base::lanes;
using geometry::HierarchyElement;
using geometry::PairType;

// Both bodies, placed. Kept for their memory.
struct PlacedPair {
    PlacedBody a, b;
    PlacedTree tree_a, tree_b;
    std::vector<NodePair> stack;  // of items

    // Relative to where body a is.
    void start(const SweptPair& pair) {
        std::array<Vector3, 2> offset;
        for (std::size_t e = 0; e < 2; ++e) offset[e] = pair.b->ends[e].position - pair.a->ends[e].position;
        a.start(*pair.a, pair.a_seen_from_b, true, {Vector3::Zero(), Vector3::Zero()});
        b.start(*pair.b, pair.b_seen_from_a, false, offset);
        stack.clear();  // of a search that was stopped
    }
};

PlacedPair& memory() {
    static thread_local PlacedPair placed;
    return placed;
}

// Splits the larger one of two items that are not both primitives, and keeps the pairs that are not apart.
[[gnu::always_inline]] inline void split(PlacedPair& placed, int i, int j, float margin) {
    const auto keep = [&](int k, int l) {
        if (!placed.tree_a[k].box.is_apart(placed.tree_b[l].box, margin)) placed.stack.push_back({k, l});
    };
    const PlacedItem &a = placed.tree_a[i], &b = placed.tree_b[j];
    if (b.is_primitive() || (!a.is_primitive() && a.size >= b.size)) {
        placed.tree_a.expand(i);
        const int first = placed.tree_a[i].first, end = first + placed.tree_a[i].count;
        for (int k = first; k < end; ++k) keep(k, j);
    } else {
        placed.tree_b.expand(j);
        const int first = placed.tree_b[j].first, end = first + placed.tree_b[j].count;
        for (int l = first; l < end; ++l) keep(i, l);
    }
}

// One kind of pairs of primitives below a pair of nodes.
class KindSearch {
public:
    KindSearch(const SweptPair& pair, PlacedPair& placed, PairType type, bool swapped, std::vector<geometry::PrimitivePair>& out)
        : pair_(pair), placed_(placed), type_(type), swapped_(swapped), margin_(base::float_above(pair.margin)), out_(out) {}

    void run(const NodePair& from) {
        const bool edges = type_ == PairType::edge_edge;
        const PrimitiveKind vertices = PrimitiveKind::vertices, faces = PrimitiveKind::faces;
        placed_.tree_a.start(placed_.a, edges ? PrimitiveKind::edges : swapped_ ? faces : vertices, from[0], pair_.plane_a);
        placed_.tree_b.start(placed_.b, edges ? PrimitiveKind::edges : swapped_ ? vertices : faces, from[1], pair_.plane_b);
        placed_.stack.push_back({0, 0});
        base::has_wide_instructions() ? descend_wide() : descend();
        flush();
    }

private:
    [[gnu::always_inline]] inline void descend() {
        while (!placed_.stack.empty()) {
            const auto [i, j] = placed_.stack.back();
            placed_.stack.pop_back();
            if (placed_.tree_a[i].is_primitive() && placed_.tree_b[j].is_primitive())
                add(i, j);
            else
                split(placed_, i, j, margin_);
        }
    }
    FETTLE_WIDE void descend_wide() { descend(); }

    // Vertices against the faces of elements. Loose edges and points are faces for isolated points only: other vertices are ends of edges,
    // whose own pairs cover them. Two points are one pair, not two.
    bool is_pair(const PlacedItem& a, const PlacedItem& b) const {
        if (type_ == PairType::edge_edge) return true;
        const PlacedItem &vertex = swapped_ ? b : a, &face = swapped_ ? a : b;
        const HierarchyElement& other = elements(!swapped_)[face.element];
        return other.triangle >= 0 || (elements(swapped_)[vertex.element].vertex_count == 1 && (other.vertex_count > 1 || !swapped_));
    }
    const std::vector<HierarchyElement>& elements(bool of_b) const { return (of_b ? placed_.b : placed_.a).hierarchy().elements(); }

    void add(int i, int j) {
        if (!is_pair(placed_.tree_a[i], placed_.tree_b[j])) return;
        waiting_[waiting_count_++] = {i, j};
        if (waiting_count_ == lanes) flush();
    }

    // Up to four that wait.
    void flush() {
        if (waiting_count_ == 0) return;
        base::stop_if_asked();
        FourPairs x;
        std::array<std::array<const PlacedItem*, 2>, lanes> items;
        for (std::size_t k = 0; k < lanes; ++k) {
            const auto [i, j] = waiting_[std::min(k, waiting_count_ - 1)];  // the last one again
            items[k] = {&placed_.tree_a[i], &placed_.tree_b[j]};
            const auto set = [&](std::size_t from, const PlacedBody& body, const PlacedItem& item, std::size_t count) {
                for (std::size_t i = 0; i < count; ++i) x[from + i][k] = &body.vertex(item.vertex[i]).x;
            };
            const std::size_t on_a = type_ == PairType::edge_edge ? 2 : swapped_ ? 3 : 1;
            set(swapped_ ? 1 : 0, placed_.a, *items[k][0], on_a);
            set(swapped_ ? 0 : on_a, placed_.b, *items[k][1], 4 - on_a);
        }
        const std::array<double, lanes> separations = four_separations(type_, x);
        for (std::size_t k = 0; k < waiting_count_; ++k) {
            const PlacedItem &a = *items[k][0], &b = *items[k][1];
            const double lost = pair_.deviation(a.radius, b.radius) + search_rounding * (pair_.world_size + pair_.reach);
            if (separations[k] > pair_.margin + lost) continue;
            // In this order: what is not a number loses.
            out_.push_back(
                {number_of(a, false), number_of(b, true), std::max(-std::numeric_limits<double>::infinity(), separations[k] - lost)});
        }
        waiting_count_ = 0;
    }

    int number_of(const PlacedItem& item, bool of_b) const {
        const bool is_face = type_ == PairType::point_triangle && of_b != swapped_;
        return is_face ? elements(of_b)[item.element].face : item.primitive;
    }

    const SweptPair& pair_;
    PlacedPair& placed_;
    const PairType type_;
    const bool swapped_;  // the vertex is on b
    const float margin_;
    std::vector<geometry::PrimitivePair>& out_;
    std::array<NodePair, lanes> waiting_;  // items
    std::size_t waiting_count_ = 0;
};

// The vertices of a pair of primitives: a's first, then b's.
struct PairCorners {
    std::array<int, 4> vertex;
    std::size_t on_a;
};

PairCorners corners_of(const SweptPair& pair, PairType type, bool swapped, const geometry::PrimitivePair& of) {
    const model::Body &a = *pair.a->body, &b = *pair.b->body;
    if (type == PairType::edge_edge) {
        const geometry::Edge &ea = a.mesh.edges[of.a], &eb = b.mesh.edges[of.b];
        return {{ea[0], ea[1], eb[0], eb[1]}, 2};
    }
    const geometry::Triangle& face = swapped ? a.hierarchy->faces()[of.a] : b.hierarchy->faces()[of.b];
    if (swapped) return {{face[0], face[1], face[2], of.b}, 3};
    return {{of.a, face[0], face[1], face[2]}, 1};
}

// search_again() for one kind.
void search_kind_again(const SweptPair& pair, PlacedPair& placed, PairType type, bool swapped, std::vector<geometry::PrimitivePair>& list) {
    const double lost = pair.deviation(pair.a->body->radius, pair.b->body->radius) + search_rounding * (pair.world_size + pair.reach);
    std::size_t kept = 0;
    for (std::size_t first = 0; first < list.size(); first += lanes) {
        const std::size_t count = std::min<std::size_t>(lanes, list.size() - first);
        std::array<std::array<int, 4>, lanes> at;
        std::size_t on_a = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const PairCorners corners = corners_of(pair, type, swapped, list[first + k]);
            on_a = corners.on_a;
            for (std::size_t i = 0; i < 4; ++i) at[k][i] = (i < on_a ? placed.a : placed.b).place(corners.vertex[i]);
        }
        FourPairs x;  // the vertex of a vertex and a face comes first
        for (std::size_t k = 0; k < lanes; ++k)
            for (std::size_t i = 0; i < 4; ++i)
                x[swapped ? (i + 1) % 4 : i][k] = &(i < on_a ? placed.a : placed.b).vertex(at[std::min(k, count - 1)][i]).x;
        const std::array<double, lanes> separations = four_separations(type, x);
        for (std::size_t k = 0; k < count; ++k) {
            if (separations[k] > pair.margin + lost) continue;
            list[kept] = list[first + k];
            list[kept++].distance = std::max(-std::numeric_limits<double>::infinity(), separations[k] - lost);  // in this order
        }
    }
    list.resize(kept);
}

}  // namespace

std::vector<NodePair> close_nodes(const SweptPair& pair, std::size_t most) {
    PlacedPair& placed = memory();
    placed.start(pair);
    placed.tree_a.start(placed.a, PrimitiveKind::faces, 0, nullptr);
    placed.tree_b.start(placed.b, PrimitiveKind::faces, 0, nullptr);
    const float margin = base::float_above(pair.margin);
    std::vector<NodePair> out;
    // Not down to primitives.
    const auto is_last = [](const PlacedBody& body, int node) {
        const auto& nodes = body.hierarchy().nodes();
        return nodes[node].is_leaf() || nodes[nodes[node].left].is_leaf() || nodes[nodes[node].right].is_leaf();
    };
    placed.stack.push_back({0, 0});
    while (!placed.stack.empty() && placed.stack.size() + out.size() < most) {
        const auto [i, j] = placed.stack.back();
        placed.stack.pop_back();
        const NodePair nodes{placed.tree_a[i].node, placed.tree_b[j].node};
        if (is_last(placed.a, nodes[0]) || is_last(placed.b, nodes[1]))
            out.push_back(nodes);
        else
            split(placed, i, j, margin);
    }
    for (const auto& [i, j] : placed.stack) out.push_back({placed.tree_a[i].node, placed.tree_b[j].node});
    placed.stack.clear();
    return out;
}

void search_primitives(const SweptPair& pair, const NodePair& from, geometry::PrimitivePairs& out) {
    PlacedPair& placed = memory();
    placed.start(pair);
    KindSearch(pair, placed, PairType::point_triangle, false, out.vertex_triangle).run(from);
    KindSearch(pair, placed, PairType::point_triangle, true, out.triangle_vertex).run(from);
    KindSearch(pair, placed, PairType::edge_edge, false, out.edge_edge).run(from);
}

void search_again(const SweptPair& pair, geometry::PrimitivePairs& pairs) {
    PlacedPair& placed = memory();
    placed.start(pair);
    search_kind_again(pair, placed, PairType::point_triangle, false, pairs.vertex_triangle);
    search_kind_again(pair, placed, PairType::point_triangle, true, pairs.triangle_vertex);
    search_kind_again(pair, placed, PairType::edge_edge, false, pairs.edge_edge);
}

}  // namespace fettle::core::ccd
