// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/side_pieces.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace fettle::core::ccd {
namespace {

using geometry::RoundedSide;
using geometry::RoundedSides;

std::array<int, 4> vertices_of(const RoundedSides& sides, const RoundedSides::Place& rectangle) {
    const RoundedSide& side = sides.sides[rectangle.side];
    const auto &first = side.corners[rectangle.at].rim, &last = side.corners[(rectangle.at + 1) % count_of(side.corners)].rim;
    std::array<int, 4> out{first[0], first[1], last[0], last[1]};
    std::sort(out.begin(), out.end());
    return out;
}

// The rectangles that a face is of: a plane facet may be one of two directions, of which of_triangle names one.
std::array<RoundedSides::Place, 2> rectangles_of(const RoundedSides& sides, int face) {
    std::array<RoundedSides::Place, 2> out;
    if (face >= count_of(sides.of_triangle)) return out;  // faces of wires and points come after the triangles
    out[0] = sides.of_triangle[face];
    if (out[0].side < 0) return out;
    const std::array<int, 4> vertices = vertices_of(sides, out[0]);
    for (const RoundedSides::Place& at : sides.of_vertex[vertices[0]]) {
        if (at.side == out[0].side) continue;
        const RoundedSide& side = sides.sides[at.side];
        const int before = at.at > 0 ? at.at - 1 : side.closed ? count_of(side.corners) - 1 : -1;
        for (const int k : {before, at.at})
            if (k >= 0 && k < side.rectangles() && vertices_of(sides, {at.side, k}) == vertices) out[1] = {at.side, k};
    }
    return out;
}

// Corners that candidates have, of one side.
class Corners {
public:
    void add(const RoundedSide& side, const RoundedSides::Place& place, bool is_rectangle) {
        named_.resize(side.corners.size(), 0);
        named_[place.at] = 1;
        if (is_rectangle) named_[(place.at + 1) % named_.size()] = 1;
    }

    // With their neighbours, and the rectangles beside them.
    void list(const RoundedSide& side, std::vector<int>& corners, std::vector<int>& rectangles) const {
        const int count = count_of(side.corners);
        const auto is_named = [&](int corner) {
            return (side.closed || (corner >= 0 && corner < count)) && named_[(corner + count) % count] != 0;
        };
        for (int k = 0; k < count; ++k)
            if (is_named(k - 1) || is_named(k) || is_named(k + 1)) corners.push_back(k);
        for (int k = 0; k < side.rectangles(); ++k)
            if (is_named(k) || is_named(k + 1)) rectangles.push_back(k);
    }

private:
    std::vector<char> named_;
};

}  // namespace

std::vector<SidePieces> side_pieces(const model::Model& model, int body_a, int body_b, const geometry::PrimitivePairs& candidates) {
    const model::Body &a = model.bodies[body_a], &b = model.bodies[body_b];
    if (!a.round || !b.round || !(a.round->any() || b.round->any())) return {};
    const RoundedSides &sides_a = a.round->mesh_sides, &sides_b = b.round->mesh_sides;
    std::map<std::pair<int, int>, std::pair<Corners, Corners>> near;
    const auto add = [&](const RoundedSides::Place& at_a, bool rectangle_a, const RoundedSides::Place& at_b, bool rectangle_b) {
        if (at_a.side < 0 || at_b.side < 0) return;
        const RoundedSide &side_a = sides_a.sides[at_a.side], &side_b = sides_b.sides[at_b.side];
        if (!side_a.is_round() && !side_b.is_round()) return;
        auto& [corners_a, corners_b] = near[{at_a.side, at_b.side}];
        corners_a.add(side_a, at_a, rectangle_a);
        corners_b.add(side_b, at_b, rectangle_b);
    };
    for (const geometry::PrimitivePair& pair : candidates.vertex_triangle)
        for (const auto& at_a : sides_a.of_vertex[pair.a])
            for (const auto& at_b : rectangles_of(sides_b, pair.b)) add(at_a, false, at_b, true);
    for (const geometry::PrimitivePair& pair : candidates.triangle_vertex)
        for (const auto& at_b : sides_b.of_vertex[pair.b])
            for (const auto& at_a : rectangles_of(sides_a, pair.a)) add(at_a, true, at_b, false);
    for (const geometry::PrimitivePair& pair : candidates.edge_edge)
        for (const int v : a.mesh.edges[pair.a])
            for (const int w : b.mesh.edges[pair.b])
                for (const auto& at_a : sides_a.of_vertex[v])
                    for (const auto& at_b : sides_b.of_vertex[w]) add(at_a, false, at_b, false);
    std::vector<SidePieces> out;
    const std::vector<model::FacetSides>& facets = model.facet_sides;
    for (const auto& [sides, corners] : near) {
        if (std::binary_search(facets.begin(), facets.end(), model::FacetSides{body_a, sides.first, body_b, sides.second})) continue;
        SidePieces& pieces = out.emplace_back();
        pieces.side_a = sides.first;
        pieces.side_b = sides.second;
        corners.first.list(sides_a.sides[pieces.side_a], pieces.corners_a, pieces.rectangles_a);
        corners.second.list(sides_b.sides[pieces.side_b], pieces.corners_b, pieces.rectangles_b);
    }
    return out;
}

}  // namespace fettle::core::ccd
