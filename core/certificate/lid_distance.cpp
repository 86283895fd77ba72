// SPDX-License-Identifier: MIT
#include "core/certificate/lid_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/limits.hpp"
#include "core/solids/self_intersection.hpp"

namespace fettle::core::certificate {
namespace {

constexpr long most_bounds = 400'000;        // beside one for each place
constexpr std::size_t most_instants = 4096;  // whose poses are kept
constexpr double outwards = 1 + 1e-12;       // of radii and speeds, far above their rounding
constexpr double centre_rounding = 1e-14;    // of a middle of points, in their sizes

// Some points of a body: a node of a hierarchy, or a triangle (an edge or a point repeats its last corner).
struct Piece {
    const LidSurface* surface = nullptr;
    int node = -1;  // -1: a triangle
    std::array<Vector3, 3> corners = {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    Vector3 half = Vector3::Zero();  // of a node's box
    Vector3 centre = Vector3::Zero();
    double radius = 0;  // round the centre
    double reach = 0;   // >= |X|
};

Piece triangle_of(const LidSurface& surface, const std::array<Vector3, 3>& corners) {
    Piece out;
    out.surface = &surface;
    out.corners = corners;
    out.centre = (corners[0] + corners[1] + corners[2]) / 3;
    for (const Vector3& x : corners) {
        out.radius = std::max(out.radius, (x - out.centre).norm());
        out.reach = std::max(out.reach, x.norm());
    }
    out.radius = outwards * (out.radius + centre_rounding * out.reach);
    out.reach *= outwards;
    return out;
}

Piece node_of(const LidSurface& surface, int index) {
    const geometry::HierarchyNode& node = surface.hierarchy.nodes()[index];
    Piece out;
    out.surface = &surface;
    out.node = index;
    out.half = node.half_extent;
    out.centre = node.center;
    out.radius = outwards * node.half_extent.norm();
    out.reach = outwards * node.radius;
    return out;
}

// A node's children or elements; a triangle's halves through the middle of its longest side, whose rounding is in the pieces' reach.
std::vector<Piece> parts_of(const Piece& piece) {
    const LidSurface& surface = *piece.surface;
    if (piece.node < 0) {
        const auto& x = piece.corners;
        std::size_t longest = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if ((x[(i + 1) % 3] - x[i]).squaredNorm() > (x[(longest + 1) % 3] - x[longest]).squaredNorm()) longest = i;
        const Vector3 &a = x[longest], &b = x[(longest + 1) % 3], &c = x[(longest + 2) % 3];
        const Vector3 middle = 0.5 * (a + b);
        return {triangle_of(surface, {a, middle, c}), triangle_of(surface, {middle, b, c})};
    }
    const geometry::HierarchyNode& node = surface.hierarchy.nodes()[piece.node];
    if (!node.is_leaf()) return {node_of(surface, node.left), node_of(surface, node.right)};
    std::vector<Piece> out;
    for (int i = node.first; i < node.first + node.count; ++i) {
        const geometry::HierarchyElement& element = surface.hierarchy.elements()[i];
        std::array<Vector3, 3> corners;
        for (int k = 0; k < 3; ++k) corners[k] = surface.mesh.vertices.col(element.vertices[std::min(k, element.vertex_count - 1)]);
        out.push_back(triangle_of(surface, corners));
    }
    return out;
}

// How far a piece reaches from its centre along a direction of the world.
double reach_along(const Piece& piece, const IntervalMatrix& rotation, const Interval3& world) {
    const Interval3 m = transposed_times(rotation, world);  // the direction in the piece's frame
    double reach = 0;
    if (piece.node >= 0) {
        for (int k = 0; k < 3; ++k) reach += m[k].magnitude() * piece.half[k];
    } else {
        for (const Vector3& corner : piece.corners) reach = std::max(reach, dot(m, exactly(corner - piece.centre)).magnitude());
    }
    return outwards * (reach + 4 * centre_rounding * piece.reach * norm_bound(world));
}

class LidProver {
public:
    explicit LidProver(double room) : room_(room) {}

    bool prove(const BodyPath& path_a, const BodyPath& path_b, const LidSurface& lids, const std::vector<const LidSurface*>& others,
               long& budget) {
        if (!(path_a.magnitude < base::largest_magnitude) || !(path_b.magnitude < base::largest_magnitude)) return false;
        a_ = &path_a;
        b_ = &path_b;
        drift_ = norm_bound(a_->drift - b_->drift);
        instants_.clear();
        std::vector<Cell> open;
        for (const LidSurface* other : others) open.push_back({{0, 1}, node_of(lids, 0), node_of(*other, 0)});
        while (!open.empty()) {
            const Cell cell = open.back();
            open.pop_back();
            if (--budget < 0) return false;
            const double e = 0.5 * (cell.span.end - cell.span.start);
            const double moved = outwards * e * (drift_ + turning(*a_, cell.lid) + turning(*b_, cell.other));
            const double gap = apart(cell);
            if (gap - moved > room_) continue;
            if (are_seen_to_be_near(cell)) return false;
            const bool only_moves = gap > room_;  // apart at the middle: nothing but the motion is in the way
            if (!split(cell, only_moves || moved > std::max(cell.lid.radius, cell.other.radius), open)) return false;
        }
        return true;
    }

private:
    struct Cell {
        Span span;
        Piece lid, other;
    };
    struct Instant {
        IntervalMatrix a, b;
        Interval3 offset;  // q_a - q_b
    };

    static double turning(const BodyPath& path, const Piece& piece) { return path.speed * path.base_norm * piece.reach; }

    const Instant& at(double s) {
        const auto known = instants_.find(s);
        if (known != instants_.end()) return known->second;
        if (instants_.size() >= most_instants) instants_.clear();
        const Interval3 offset = (a_->place + Interval(s) * a_->drift) - (b_->place + Interval(s) * b_->drift);
        return instants_.emplace(s, Instant{pose_at(*a_, s).rotation, pose_at(*b_, s).rotation, offset}).first->second;
    }

    // At the middle of the span, from below: along the way between the centres, and along the normal of a lid's triangle.
    double apart(const Cell& cell) {
        const Instant& here = at(0.5 * (cell.span.start + cell.span.end));
        const Interval3 gap = between(cell, here);
        double best = apart_along(exactly(middle(gap)), cell, here, gap);
        if (cell.lid.node < 0) {
            const auto& x = cell.lid.corners;
            const Vector3 n = (x[1] - x[0]).cross(x[2] - x[0]);
            best = std::max(best, apart_along(times(here.a, exactly(n)), cell, here, gap));
        }
        return best;
    }

    // From the centre of one piece to that of the other, in the world.
    static Interval3 between(const Cell& cell, const Instant& here) {
        return here.offset + times(here.a, exactly(cell.lid.centre)) - times(here.b, exactly(cell.other.centre));
    }

    // Two triangles that cross, or whose centres are too near, at the middle of the span: no halving proves anything of them.
    bool are_seen_to_be_near(const Cell& cell) {
        if (cell.lid.node >= 0 || cell.other.node >= 0) return false;
        const Instant& here = at(0.5 * (cell.span.start + cell.span.end));
        if (norm_bound(between(cell, here)) <= room_) return true;
        std::array<Vector3, 3> lid, other;
        for (std::size_t k = 0; k < 3; ++k) {
            lid[k] = middle(times(here.a, exactly(cell.lid.corners[k])) + here.offset);
            other[k] = middle(times(here.b, exactly(cell.other.corners[k])));
        }
        return solids::triangles_intersect(lid, other);
    }

    static double apart_along(const Interval3& world, const Cell& cell, const Instant& here, const Interval3& between) {
        const double length = norm_bound(world);
        if (!(length > 0)) return -base::infinity;
        const Interval gap = dot(world, between);
        const double away =
            std::max(gap.low, -gap.high) - outwards * (reach_along(cell.lid, here.a, world) + reach_along(cell.other, here.b, world));
        return away > 0 ? away / (outwards * length) : away;
    }

    // What is loosest; false if nothing can be halved any more.
    static bool split(const Cell& cell, bool in_time, std::vector<Cell>& open) {
        if (in_time) {
            const double middle = 0.5 * (cell.span.start + cell.span.end);
            if (!(cell.span.start < middle && middle < cell.span.end)) return false;
            open.push_back({{cell.span.start, middle}, cell.lid, cell.other});
            open.push_back({{middle, cell.span.end}, cell.lid, cell.other});
        } else if (cell.other.radius >= cell.lid.radius) {
            if (!(cell.other.radius > 0)) return false;
            for (const Piece& part : parts_of(cell.other)) open.push_back({cell.span, cell.lid, part});
        } else {
            for (const Piece& part : parts_of(cell.lid)) open.push_back({cell.span, part, cell.other});
        }
        return true;
    }

    double room_;
    const BodyPath *a_ = nullptr, *b_ = nullptr;
    double drift_ = 0;  // >= |q_a' - q_b'|
    std::map<double, Instant> instants_;
};

}  // namespace

bool lids_stay_apart(const LidPath& path, const LidSurface& lids, const std::vector<const LidSurface*>& others, double room) {
    if (path.places.empty()) return false;
    LidProver prover(room);
    long budget = most_bounds + static_cast<long>(path.places.size() * others.size());
    for (const Place& place : path.places) {
        const BodyPath a = body_path(path.trajectory, place.step, place.segment, path.body),
                       b = body_path(path.trajectory, place.step, place.segment, path.other);
        if (!prover.prove(a, b, lids, others, budget)) return false;
    }
    return true;
}

}  // namespace fettle::core::certificate
