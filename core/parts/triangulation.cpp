// SPDX-License-Identifier: MIT
#include "core/parts/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/base/contract.hpp"
#include "core/geometry/predicates.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Edge;
using geometry::orient2d;
using geometry::Triangle;

struct Fault {
    std::array<Edge, 2> edges;
};

// True only if d is inside of the circle through a, b, c (counter-clockwise) beyond rounding: flips then end.
bool surely_in_circle(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
    const Vector2 p = a - d, q = b - d, r = c - d;
    const double pq = p.x() * q.y(), qp = p.y() * q.x(), qr = q.x() * r.y(), rq = q.y() * r.x(), rp = r.x() * p.y(), pr = r.y() * p.x();
    const double pp = p.squaredNorm(), qq = q.squaredNorm(), rr = r.squaredNorm();
    const double determinant = pp * (qr - rq) + qq * (rp - pr) + rr * (pq - qp);
    const double size = pp * (std::abs(qr) + std::abs(rq)) + qq * (std::abs(rp) + std::abs(pr)) + rr * (std::abs(pq) + std::abs(qp));
    return determinant > 1e-14 * size;
}

class Delaunay {
public:
    explicit Delaunay(const PlaneRegion& region) : region_(region), points_(region.points) {
        Vector2 low = points_[0], high = points_[0];
        for (const Vector2& p : points_) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        const Vector2 middle = (low + high) / 2;
        const double far = 64 * std::max((high - low).maxCoeff(), 1e-300);
        count_ = count_of(points_);
        points_.push_back(middle + Vector2(-far, -far));
        points_.push_back(middle + Vector2(far, -far));
        points_.push_back(middle + Vector2(0, far));
        triangle_of_.assign(points_.size(), -1);
        add({count_, count_ + 1, count_ + 2}, {-1, -1, -1});
        next_.assign(count_, -1);
        for (const auto& loop : region.loops)
            for (std::size_t k = 0; k < loop.size(); ++k) next_[loop[k]] = loop[(k + 1) % loop.size()];
    }

    void run() {
        for (const auto& loop : region_.loops)
            for (const int p : loop)
                if (triangle_of_[index(p)] < 0) insert(p);
        for (const auto& loop : region_.loops)
            for (std::size_t k = 0; k < loop.size(); ++k) constrain(loop[k], loop[(k + 1) % loop.size()]);
    }

    /// Those to the left of the loops; empty where left and right are not apart.
    std::vector<Triangle> inside() const {
        std::vector<char> state(triangles_.size(), 0);  // 1 in, 2 out
        std::vector<int> stack;
        for (const auto& loop : region_.loops) {
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const auto [t, i] = find_edge(loop[k], loop[(k + 1) % loop.size()]);
                const int other = triangles_[index(t)].neighbours[index(i)];
                if (state[index(t)] == 2 || (other >= 0 && state[index(other)] == 1)) return {};
                state[index(t)] = 1;
                stack.push_back(t);
                if (other < 0) continue;
                state[index(other)] = 2;
                stack.push_back(other);
            }
        }
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int i = 0; i < 3; ++i) {
                const int other = triangles_[index(t)].neighbours[index(i)];
                if (other < 0 || triangles_[index(t)].constrained[index(i)]) continue;
                if (state[index(other)] == state[index(t)]) continue;
                if (state[index(other)] != 0) return {};
                state[index(other)] = state[index(t)];
                stack.push_back(other);
            }
        }
        std::vector<Triangle> out;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (state[t] != 1) continue;
            const auto& v = triangles_[t].corners;
            if (std::max({v[0], v[1], v[2]}) >= count_) return {};
            out.push_back({v[0], v[1], v[2]});
        }
        return out;
    }

private:
    struct Node {
        std::array<int, 3> corners;
        std::array<int, 3> neighbours;  ///< across from corner i
        std::array<bool, 3> constrained{false, false, false};
    };
    struct Place {
        int triangle, side;  ///< side: across from corner `side`
    };

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    static int next(int i) { return (i + 1) % 3; }
    static int previous(int i) { return (i + 2) % 3; }
    const Vector2& at(int p) const { return points_[index(p)]; }
    int turn(int a, int b, int c) const { return orient2d(at(a), at(b), at(c)); }

    int add(const std::array<int, 3>& corners, const std::array<int, 3>& neighbours) {
        triangles_.push_back({corners, neighbours, {false, false, false}});
        const int t = count_of(triangles_) - 1;
        for (const int c : corners) triangle_of_[index(c)] = t;
        return t;
    }

    int corner_of(int t, int p) const {
        const auto& c = triangles_[index(t)].corners;
        return c[0] == p ? 0 : c[1] == p ? 1 : 2;
    }

    void replace_neighbour(int t, int before, int after) {
        if (t < 0) return;
        for (int& n : triangles_[index(t)].neighbours)
            if (n == before) {
                n = after;
                return;
            }
    }

    // Walks towards the point; every orientation on the way is exact.
    int locate(int p) const {
        int t = last_;
        for (std::size_t steps = 0; steps < 4 * triangles_.size() + 16; ++steps) {
            const Node& node = triangles_[index(t)];
            int to = -1;
            for (int k = 0; k < 3; ++k) {
                const int i = (k + static_cast<int>(steps)) % 3;  // another side first each time: no walk in circles
                if (turn(node.corners[index(next(i))], node.corners[index(previous(i))], p) < 0) {
                    to = node.neighbours[index(i)];
                    break;
                }
            }
            if (to < 0) return t;
            t = to;
        }
        for (std::size_t k = 0; k < triangles_.size(); ++k) {
            const auto& c = triangles_[k].corners;
            if (turn(c[0], c[1], p) >= 0 && turn(c[1], c[2], p) >= 0 && turn(c[2], c[0], p) >= 0) return static_cast<int>(k);
        }
        return last_;
    }

    [[noreturn]] void fail_point(int p, int q) const {
        throw Fault{{Edge{p, next_[index(p)]}, q < count_ ? Edge{q, next_[index(q)]} : Edge{p, next_[index(p)]}}};
    }

    void insert(int p) {
        const int t = locate(p);
        const std::array<int, 3> c = triangles_[index(t)].corners, n = triangles_[index(t)].neighbours;
        int on = -1;
        for (int i = 0; i < 3; ++i) {
            if (at(c[index(i)]) == at(p)) fail_point(p, c[index(i)]);
            if (turn(c[index(next(i))], c[index(previous(i))], p) == 0) on = i;
        }
        std::vector<Place> doubtful;
        if (on < 0) {
            triangles_[index(t)] = {{p, c[1], c[2]}, {n[0], -1, -1}, {false, false, false}};
            const int t1 = add({c[0], p, c[2]}, {t, n[1], -1}), t2 = add({c[0], c[1], p}, {t, t1, n[2]});
            triangles_[index(t)].neighbours = {n[0], t1, t2};
            triangles_[index(t1)].neighbours = {t, n[1], t2};
            replace_neighbour(n[1], t, t1);
            replace_neighbour(n[2], t, t2);
            triangle_of_[index(p)] = t;
            triangle_of_[index(c[1])] = triangle_of_[index(c[2])] = t;
            doubtful = {{t, 0}, {t1, 1}, {t2, 2}};
        } else {
            // On the edge a b across from e; f is on the other side.
            const int e = c[index(on)], a = c[index(next(on))], b = c[index(previous(on))];
            const int u = n[index(on)];
            const int beside_b = n[index(next(on))], beside_a = n[index(previous(on))];  // across from a: (b, e); across from b: (e, a)
            if (u < 0) fail_point(p, a);
            const int j = opposite_side(u, t);
            const std::array<int, 3> uc = triangles_[index(u)].corners, un = triangles_[index(u)].neighbours;
            const int f = uc[index(j)];
            const int u_across_b = un[index(corner_in(uc, b))], u_across_a = un[index(corner_in(uc, a))];  // (a, f) and (f, b)
            triangles_[index(t)] = {{e, a, p}, {-1, -1, beside_a}, {false, false, false}};
            triangles_[index(u)] = {{f, p, a}, {-1, u_across_b, -1}, {false, false, false}};
            const int t1 = add({e, p, b}, {-1, beside_b, t}), u1 = add({f, b, p}, {-1, -1, u_across_a});
            triangles_[index(t)].neighbours = {u, t1, beside_a};
            triangles_[index(u)].neighbours = {t, u_across_b, u1};
            triangles_[index(t1)].neighbours = {u1, beside_b, t};
            triangles_[index(u1)].neighbours = {t1, u, u_across_a};
            replace_neighbour(beside_b, t, t1);
            replace_neighbour(u_across_a, u, u1);
            triangle_of_[index(p)] = triangle_of_[index(e)] = triangle_of_[index(a)] = t;
            triangle_of_[index(f)] = u;
            triangle_of_[index(b)] = t1;
            doubtful = {{t, 2}, {u, 1}, {t1, 1}, {u1, 2}};
        }
        last_ = t;
        legalise(doubtful);
    }

    static int corner_in(const std::array<int, 3>& corners, int p) { return corners[0] == p ? 0 : corners[1] == p ? 1 : 2; }
    int opposite_side(int of, int neighbour) const {
        const auto& n = triangles_[index(of)].neighbours;
        return n[0] == neighbour ? 0 : n[1] == neighbour ? 1 : 2;
    }

    // Turns the edge across from corner i of t: it then joins the two corners that were across from it.
    void flip(int t, int i) {
        const int u = triangles_[index(t)].neighbours[index(i)], j = opposite_side(u, t);
        Node &a = triangles_[index(t)], &b = triangles_[index(u)];
        const int p = a.corners[index(i)], q = a.corners[index(next(i))], r = a.corners[index(previous(i))], s = b.corners[index(j)];
        const int across_q = a.neighbours[index(next(i))], across_r = a.neighbours[index(previous(i))];  // (r, p), (p, q)
        const bool fixed_q = a.constrained[index(next(i))], fixed_r = a.constrained[index(previous(i))];
        const int kq = corner_in(b.corners, q), kr = corner_in(b.corners, r);
        const int across_q_b = b.neighbours[index(kq)], across_r_b = b.neighbours[index(kr)];  // (s, r), (q, s)
        const bool fixed_q_b = b.constrained[index(kq)], fixed_r_b = b.constrained[index(kr)];
        a = {{p, q, s}, {across_r_b, u, across_r}, {fixed_r_b, false, fixed_r}};
        b = {{p, s, r}, {across_q_b, across_q, t}, {fixed_q_b, fixed_q, false}};
        replace_neighbour(across_r_b, u, t);
        replace_neighbour(across_q, t, u);
        triangle_of_[index(p)] = triangle_of_[index(q)] = triangle_of_[index(s)] = t;
        triangle_of_[index(r)] = u;
    }

    bool can_flip(int t, int i) const {
        const int u = triangles_[index(t)].neighbours[index(i)];
        if (u < 0 || triangles_[index(t)].constrained[index(i)]) return false;
        const int p = triangles_[index(t)].corners[index(i)], q = triangles_[index(t)].corners[index(next(i))],
                  r = triangles_[index(t)].corners[index(previous(i))], s = triangles_[index(u)].corners[index(opposite_side(u, t))];
        return turn(p, q, s) > 0 && turn(p, s, r) > 0;
    }

    void legalise(std::vector<Place> doubtful) {
        std::size_t flips = 0;
        while (!doubtful.empty() && flips < 100 * points_.size() + 1000) {
            const auto [t, i] = doubtful.back();
            doubtful.pop_back();
            const Node& node = triangles_[index(t)];
            const int u = node.neighbours[index(i)];
            if (u < 0) continue;
            const int s = triangles_[index(u)].corners[index(opposite_side(u, t))];
            if (!surely_in_circle(at(node.corners[0]), at(node.corners[1]), at(node.corners[2]), at(s)) || !can_flip(t, i)) continue;
            flip(t, i);
            ++flips;
            // t = (p, q, s), u = (p, s, r): the four outer sides.
            doubtful.push_back({t, 0});
            doubtful.push_back({u, 0});
            doubtful.push_back({t, 2});
            doubtful.push_back({u, 1});
        }
    }

    // The side that runs from a to b; triangle -1: there is none.
    Place find_edge(int a, int b) const {
        const int first = triangle_of_[index(a)];
        for (const bool forward : {true, false}) {
            int t = first;
            do {
                const auto& c = triangles_[index(t)].corners;
                const int k = corner_of(t, a);
                if (c[index(next(k))] == b) return {t, previous(k)};
                t = triangles_[index(t)].neighbours[index(forward ? next(k) : previous(k))];
            } while (t >= 0 && t != first);
            if (t == first) break;
        }
        return {-1, 0};
    }

    void mark(int a, int b) {
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
            const Place place = find_edge(from, to);
            if (place.triangle >= 0) triangles_[index(place.triangle)].constrained[index(place.side)] = true;
        }
    }

    [[noreturn]] void fail_edges(int a, int b, int c, int d) const {
        // c d as it runs in its loop.
        throw Fault{{Edge{a, b}, c < count_ && next_[index(c)] == d ? Edge{c, d} : Edge{d, c}}};
    }

    void constrain(int a, int b) {
        if (find_edge(a, b).triangle >= 0) return mark(a, b);
        std::deque<Edge> crossed = edges_crossed(a, b);
        std::vector<Edge> made;
        std::size_t rounds = 0;
        while (!crossed.empty()) {
            FETTLE_ASSERT(++rounds < 1000000, "an edge of a triangulation cannot be put in");
            const Edge edge = crossed.front();
            crossed.pop_front();
            const Place place = find_edge(edge[0], edge[1]);
            const int p = triangles_[index(place.triangle)].corners[index(place.side)];
            const int u = triangles_[index(place.triangle)].neighbours[index(place.side)];
            const int s = triangles_[index(u)].corners[index(opposite_side(u, place.triangle))];
            if (!can_flip(place.triangle, place.side)) {
                crossed.push_back(edge);
                continue;
            }
            flip(place.triangle, place.side);
            const bool still = p != a && p != b && s != a && s != b && turn(a, b, p) * turn(a, b, s) < 0;
            if (still)
                crossed.push_back({p, s});
            else
                made.push_back({p, s});
        }
        mark(a, b);
        std::vector<Place> doubtful;
        for (const Edge& edge : made) {
            const Place place = find_edge(edge[0], edge[1]);
            if (place.triangle >= 0) doubtful.push_back(place);
        }
        for (const Place& place : doubtful) legalise({place});
    }

    std::deque<Edge> edges_crossed(int a, int b) const {
        std::deque<Edge> out;
        // The triangle at a that the segment leaves through.
        int t = triangle_of_[index(a)];
        const int first = t;
        int k = 0;
        for (;;) {
            k = corner_of(t, a);
            const auto& c = triangles_[index(t)].corners;
            const int l = c[index(next(k))], r = c[index(previous(k))];
            if (turn(a, b, l) <= 0 && turn(a, b, r) >= 0 && turn(a, l, r) > 0) {
                for (const int on : {l, r})
                    if (turn(a, b, on) == 0 && (at(on) - at(a)).dot(at(b) - at(a)) > 0)
                        fail_edges(a, b, on, on < count_ ? next_[index(on)] : a);
                if (turn(a, b, l) < 0 && turn(a, b, r) > 0) break;
            }
            t = triangles_[index(t)].neighbours[index(next(k))];
            FETTLE_ASSERT(t >= 0 && t != first, "a point of a triangulation is surrounded by triangles");
        }
        for (;;) {
            const auto& c = triangles_[index(t)].corners;
            const int l = c[index(next(k))], r = c[index(previous(k))];
            if (triangles_[index(t)].constrained[index(k)]) fail_edges(a, b, l, r);
            out.push_back({l, r});
            const int u = triangles_[index(t)].neighbours[index(k)];
            const int j = opposite_side(u, t), s = triangles_[index(u)].corners[index(j)];
            if (s == b) return out;
            const int side = turn(a, b, s);
            if (side == 0) fail_edges(a, b, s, s < count_ ? next_[index(s)] : a);
            // Leaves u through the side across from its corner on the same side as s is not.
            t = u;
            k = corner_of(u, side > 0 ? r : l);
        }
    }

    const PlaneRegion& region_;
    std::vector<Vector2> points_;
    std::vector<Node> triangles_;
    std::vector<int> triangle_of_;  ///< per point: one that it is a corner of
    std::vector<int> next_;         ///< per point: the next one in its loop
    int count_ = 0;                 ///< of the region's points; three far ones follow
    int last_ = 0;
};

}  // namespace

Triangulation triangulated(const PlaneRegion& region) {
    if (region.points.size() < 3) return {};
    try {
        Delaunay delaunay(region);
        delaunay.run();
        return {delaunay.inside(), std::nullopt};
    } catch (const Fault& fault) {
        return {{}, fault.edges};
    }
}

bool fits(const PlaneRegion& region, const std::vector<Triangle>& triangles) {
    const int count = count_of(region.points);
    return std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
        for (const int v : t)
            if (v < 0 || v >= count) return false;
        const auto at = [&](int k) -> const Vector2& { return region.points[t[k]]; };
        return orient2d(at(0), at(1), at(2)) > 0;
    });
}

}  // namespace fettle::core::parts
