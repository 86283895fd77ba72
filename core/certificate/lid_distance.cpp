// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/lid_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "fettle/core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

constexpr long most_bounds = 400'000;      // beside one for each place
constexpr double outwards = 1 + 1e-12;     // of radii and speeds, far above their rounding
constexpr double centre_rounding = 1e-14;  // of a middle of points, in their sizes

// Some points of a body: a node of its hierarchy, or a triangle (an edge or a point repeats its last corner), in a ball.
struct Ball {
    int node = -1;  // -1: a triangle
    std::array<Vector3, 3> corners;
    Vector3 half = Vector3::Zero();  // of a node's box
    Vector3 centre = Vector3::Zero();
    double radius = 0;  // round the centre
    double reach = 0;   // >= |X|
};

Ball ball_of(const std::array<Vector3, 3>& corners) {
    Ball out;
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

Ball ball_of(const geometry::BodyHierarchy& hierarchy, int index) {
    const geometry::HierarchyNode& node = hierarchy.nodes()[static_cast<std::size_t>(index)];
    Ball out;
    out.node = index;
    out.half = node.half_extent;
    out.centre = node.center;
    out.radius = outwards * node.half_extent.norm();
    out.reach = outwards * node.radius;
    return out;
}

std::array<Vector3, 3> corners_of(const Matrix3X& vertices, const geometry::Triangle& t) {
    return {vertices.col(t[0]), vertices.col(t[1]), vertices.col(t[2])};
}

// Through the middle of its longest side; the middle's rounding is in the ball's radius.
std::pair<Ball, Ball> halves_of(const Ball& triangle) {
    const auto& x = triangle.corners;
    int longest = 0;
    for (int i = 1; i < 3; ++i)
        if ((x[(i + 1) % 3] - x[i]).squaredNorm() > (x[(longest + 1) % 3] - x[longest]).squaredNorm()) longest = i;
    const Vector3 &a = x[longest], &b = x[(longest + 1) % 3], &c = x[(longest + 2) % 3];
    const Vector3 middle = 0.5 * (a + b);
    return {ball_of({a, middle, c}), ball_of({middle, b, c})};
}

class LidProver {
public:
    LidProver(const LidNeighbour& other, double room) : other_(other), room_(room) {}

    bool prove(const BodyPath& path_a, const BodyPath& path_b, const std::vector<Ball>& lids, const std::vector<Ball>& others,
               long& budget) {
        if (!(path_a.magnitude < base::largest_magnitude) || !(path_b.magnitude < base::largest_magnitude)) return false;
        a_ = &path_a;
        b_ = &path_b;
        instants_.clear();
        std::vector<Cell> open;
        for (const Ball& lid : lids)
            for (const Ball& ball : others) open.push_back({{0, 1}, lid, ball});
        while (!open.empty()) {
            const Cell cell = open.back();
            open.pop_back();
            if (--budget < 0) return false;
            const double e = 0.5 * (cell.span.end - cell.span.start);
            const double moved = outwards * e * (speed(*a_, cell.lid) + speed(*b_, cell.other));
            const double gap = apart(cell);
            if (gap - moved > room_) continue;
            const bool only_moves = gap > room_;  // apart at the middle: nothing but the motion is in the way
            if (!split(cell, only_moves || moved > std::max(cell.lid.radius, cell.other.radius), open)) return false;
        }
        return true;
    }

private:
    struct Cell {
        Span span;
        Ball lid, other;
    };
    struct Instant {
        IntervalMatrix a, b;
        Interval3 offset;  // q_a - q_b
    };

    static double speed(const BodyPath& path, const Ball& ball) {
        return norm_bound(path.drift) + path.speed * path.base_norm * ball.reach;
    }

    const Instant& at(double s) {
        const auto [known, is_new] = instants_.try_emplace(s);
        if (!is_new) return known->second;
        known->second.a = pose_at(*a_, s).rotation;
        known->second.b = pose_at(*b_, s).rotation;
        for (std::size_t k = 0; k < 3; ++k)
            known->second.offset[k] = (a_->place[k] + Interval(s) * a_->drift[k]) - (b_->place[k] + Interval(s) * b_->drift[k]);
        return known->second;
    }

    // At the middle of the span, from below.
    double apart(const Cell& cell) {
        const Instant& here = at(0.5 * (cell.span.start + cell.span.end));
        Interval3 between = here.offset;  // of the centres
        for (std::size_t k = 0; k < 3; ++k)
            between[k] = between[k] + row_times(here.a[k], cell.lid.centre) - row_times(here.b[k], cell.other.centre);
        const Interval squared = square(between[0]) + square(between[1]) + square(between[2]);
        const double by_balls = geometry::sqrt(squared).low - cell.lid.radius - cell.other.radius;
        return std::max(by_balls, along_normal(cell, here, between));
    }

    static Interval row_times(const Interval3& row, const Vector3& x) {
        return row[0] * Interval(x[0]) + row[1] * Interval(x[1]) + row[2] * Interval(x[2]);
    }

    // Along the lid's normal.
    double along_normal(const Cell& cell, const Instant& here, const Interval3& between) const {
        const auto& x = cell.lid.corners;
        const Vector3 across = (x[1] - x[0]).cross(x[2] - x[0]);
        const double length = across.norm();
        if (!(length > 0)) return -base::infinity;
        const Vector3 n = across / length;
        const Interval3 world{row_times(here.a[0], n), row_times(here.a[1], n), row_times(here.a[2], n)};
        const Interval gap = world[0] * between[0] + world[1] * between[1] + world[2] * between[2];
        double reach = 0;
        for (const Vector3& corner : x) reach = std::max(reach, std::abs(n.dot(corner - cell.lid.centre)));
        reach = outwards * (reach + 4 * centre_rounding * cell.lid.reach);
        const double away = std::max(gap.low, -gap.high) - reach - reach_along(cell.other, here, world);
        return away > 0 ? away / (outwards * a_->base_norm) : away;
    }

    // How far the other's piece reaches from its centre along a direction.
    static double reach_along(const Ball& ball, const Instant& here, const Interval3& world) {
        Interval3 m;  // the direction in the other's frame
        for (std::size_t k = 0; k < 3; ++k) m[k] = world[0] * here.b[0][k] + world[1] * here.b[1][k] + world[2] * here.b[2][k];
        double reach = 0;
        if (ball.node >= 0) {
            for (int k = 0; k < 3; ++k) reach += m[static_cast<std::size_t>(k)].magnitude() * ball.half[k];
        } else {
            for (const Vector3& corner : ball.corners) reach = std::max(reach, row_times(m, corner - ball.centre).magnitude());
        }
        return outwards * (reach + 4 * centre_rounding * ball.reach);
    }

    // What is loosest; false if nothing can be halved any more.
    bool split(const Cell& cell, bool in_time, std::vector<Cell>& open) const {
        if (in_time) {
            const double middle = 0.5 * (cell.span.start + cell.span.end);
            if (!(cell.span.start < middle && middle < cell.span.end)) return false;
            open.push_back({{cell.span.start, middle}, cell.lid, cell.other});
            open.push_back({{middle, cell.span.end}, cell.lid, cell.other});
            return true;
        }
        if (cell.other.radius >= cell.lid.radius) {
            if (!(cell.other.radius > 0)) return false;
            for (const Ball& part : parts_of(cell.other)) open.push_back({cell.span, cell.lid, part});
            return true;
        }
        const auto [first, second] = halves_of(cell.lid);
        open.push_back({cell.span, first, cell.other});
        open.push_back({cell.span, second, cell.other});
        return true;
    }

    std::vector<Ball> parts_of(const Ball& ball) const {
        if (ball.node < 0) {
            const auto [first, second] = halves_of(ball);
            return {first, second};
        }
        const geometry::HierarchyNode& node = other_.hierarchy.nodes()[static_cast<std::size_t>(ball.node)];
        if (!node.is_leaf()) return {ball_of(other_.hierarchy, node.left), ball_of(other_.hierarchy, node.right)};
        std::vector<Ball> out;
        for (int i = node.first; i < node.first + node.count; ++i) {
            const geometry::HierarchyElement& element = other_.hierarchy.elements()[static_cast<std::size_t>(i)];
            std::array<Vector3, 3> corners;
            for (int k = 0; k < 3; ++k)
                corners[static_cast<std::size_t>(k)] =
                    other_.mesh.vertices.col(element.vertices[static_cast<std::size_t>(std::min(k, element.vertex_count - 1))]);
            out.push_back(ball_of(corners));
        }
        return out;
    }

    const LidNeighbour& other_;
    double room_;
    const BodyPath *a_ = nullptr, *b_ = nullptr;
    std::map<double, Instant> instants_;
};

}  // namespace

bool lids_stay_apart(const LidPath& path, const LidBody& lids, const LidNeighbour& other, double room) {
    if (path.places.empty()) return false;
    std::vector<Ball> of_body, of_other{ball_of(other.hierarchy, 0)};
    for (const geometry::Triangle& t : lids.triangles) of_body.push_back(ball_of(corners_of(lids.vertices, t)));
    for (const geometry::Triangle& t : other.lids.triangles) of_other.push_back(ball_of(corners_of(other.lids.vertices, t)));
    LidProver prover(other, room);
    long budget = most_bounds + static_cast<long>(path.places.size() * of_body.size() * of_other.size());
    for (const Place& place : path.places) {
        const BodyPath a = body_path(path.trajectory, place.step, place.segment, path.body),
                       b = body_path(path.trajectory, place.step, place.segment, path.other);
        if (!prover.prove(a, b, of_body, of_other, budget)) return false;
    }
    return true;
}

}  // namespace fettle::core::certificate
