// SPDX-License-Identifier: MIT
#include "core/ccd/side_pieces.hpp"

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

// The same of many faces, each worked out once.
class RectanglesOf {
public:
    RectanglesOf(const RoundedSides& sides, std::vector<int>& number) : sides_(sides), number_(number) {
        if (number_.size() < sides.of_triangle.size()) number_.resize(sides.of_triangle.size(), -1);
    }
    ~RectanglesOf() {
        for (const int face : faces_) number_[face] = -1;
    }
    RectanglesOf(const RectanglesOf&) = delete;
    RectanglesOf& operator=(const RectanglesOf&) = delete;

    const std::array<RoundedSides::Place, 2>& operator()(int face) {
        if (face >= count_of(sides_.of_triangle)) return none_;
        int& number = number_[face];
        if (number < 0) {
            number = count_of(faces_);
            faces_.push_back(face);
            rectangles_.push_back(rectangles_of(sides_, face));
        }
        return rectangles_[number];
    }

private:
    const RoundedSides& sides_;
    std::vector<int>& number_;  // [face] among those worked out; -1: not there
    std::vector<int> faces_;
    std::vector<std::array<RoundedSides::Place, 2>> rectangles_;
    std::array<RoundedSides::Place, 2> none_;
};

// The corners that an edge's ends are of, each once: both ends of a corner's line are of one.
void find_ends(const RoundedSides& sides, const geometry::Edge& edge, std::vector<RoundedSides::Place>& out) {
    out.clear();
    for (const int v : edge)
        for (const RoundedSides::Place& at : sides.of_vertex[v]) {
            const auto is_same = [&at](const RoundedSides::Place& other) { return other.side == at.side && other.at == at.at; };
            if (std::none_of(out.begin(), out.end(), is_same)) out.push_back(at);
        }
}

// Corners that candidates have, of one side.
class Corners {
public:
    explicit Corners(const RoundedSide& side) : named_(side.corners.size(), 0) {}
    void add(const RoundedSides::Place& place, bool is_rectangle) {
        const auto at = static_cast<std::size_t>(place.at);
        named_[at] = 1;
        if (is_rectangle) named_[at + 1 < named_.size() ? at + 1 : 0] = 1;
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
    struct Named {
        Corners a, b;
        bool is_round;
    };
    using Near = std::map<std::pair<int, int>, Named>;
    Near near;
    auto last = near.end();  // most candidates are of the same two sides as the one before
    const auto add = [&](const RoundedSides::Place& at_a, bool rectangle_a, const RoundedSides::Place& at_b, bool rectangle_b) {
        if (at_a.side < 0 || at_b.side < 0) return;
        const std::pair key(at_a.side, at_b.side);
        if (last == near.end() || last->first != key) {
            last = near.find(key);
            if (last == near.end()) {
                const RoundedSide &side_a = sides_a.sides[at_a.side], &side_b = sides_b.sides[at_b.side];
                last = near.emplace(key, Named{Corners(side_a), Corners(side_b), side_a.is_round() || side_b.is_round()}).first;
            }
        }
        Named& named = last->second;
        if (!named.is_round) return;
        named.a.add(at_a, rectangle_a);
        named.b.add(at_b, rectangle_b);
    };
    static thread_local std::vector<int> number_a, number_b;  // kept for their memory
    RectanglesOf rectangles_a(sides_a, number_a), rectangles_b(sides_b, number_b);
    for (const geometry::PrimitivePair& pair : candidates.vertex_triangle)
        for (const auto& at_a : sides_a.of_vertex[pair.a])
            for (const auto& at_b : rectangles_b(pair.b)) add(at_a, false, at_b, true);
    for (const geometry::PrimitivePair& pair : candidates.triangle_vertex)
        for (const auto& at_b : sides_b.of_vertex[pair.b])
            for (const auto& at_a : rectangles_a(pair.a)) add(at_a, true, at_b, false);
    std::vector<RoundedSides::Place> ends_a, ends_b;
    for (const geometry::PrimitivePair& pair : candidates.edge_edge) {
        find_ends(sides_a, a.mesh.edges[pair.a], ends_a);
        find_ends(sides_b, b.mesh.edges[pair.b], ends_b);
        for (const auto& at_a : ends_a)
            for (const auto& at_b : ends_b) add(at_a, false, at_b, false);
    }
    std::vector<SidePieces> out;
    const std::vector<model::FacetSides>& facets = model.facet_sides;
    for (const auto& [sides, named] : near) {
        if (!named.is_round) continue;
        if (std::binary_search(facets.begin(), facets.end(), model::FacetSides{body_a, sides.first, body_b, sides.second})) continue;
        SidePieces& pieces = out.emplace_back();
        pieces.side_a = sides.first;
        pieces.side_b = sides.second;
        named.a.list(sides_a.sides[pieces.side_a], pieces.corners_a, pieces.rectangles_a);
        named.b.list(sides_b.sides[pieces.side_b], pieces.corners_b, pieces.rectangles_b);
    }
    return out;
}

}  // namespace fettle::core::ccd
