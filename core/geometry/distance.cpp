// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/distance.hpp"

namespace fettle::core::geometry {
namespace {

// Closest point of vertex `p` (weight sign, index) to the segment of the vertices (i0, i1), whose weights carry the other sign.
struct PointEdge {
    int point, e0, e1;
    double sign;  // of the point's weight
};

// Where on the segment, and how far the point is from there.
struct OnSegment {
    double t;       // closest parameter in [0, 1]
    bool interior;  // strictly between the ends
    double distance_squared;
};

OnSegment closest_on_segment(const Vector3& p, const Vector3& e0, const Vector3& e1) {
    const Vector3 e = e1 - e0, w = p - e0;
    const double ee = e.squaredNorm();
    const double pe = w.dot(e);
    if (!(pe > 0) || ee == 0) return {0, false, w.squaredNorm()};
    if (pe >= ee) return {1, false, (p - e1).squaredNorm()};
    const double t = pe / ee;
    return {t, true, (w - t * e).squaredNorm()};
}

void finish(const std::array<const Vector3*, 4>& x, ClosestPoints& c) {
    // Differences to one vertex first: r stays accurate far from the origin because the weights sum to zero.
    c.difference = c.weight[0] * (*x[0] - *x[3]) + c.weight[1] * (*x[1] - *x[3]) + c.weight[2] * (*x[2] - *x[3]);
    c.distance_squared = c.difference.squaredNorm();
}

// The least of the cases; only that one is worked out.
template <std::size_t N>
ClosestPoints best_of(const std::array<const Vector3*, 4>& x, const std::array<PointEdge, N>& cases) {
    std::size_t best = 0;
    OnSegment on{};
    for (std::size_t i = 0; i < N; ++i) {
        const OnSegment other = closest_on_segment(*x[cases[i].point], *x[cases[i].e0], *x[cases[i].e1]);
        if (i > 0 && !(other.distance_squared < on.distance_squared)) continue;
        best = i;
        on = other;
    }
    const PointEdge& pe = cases[best];
    ClosestPoints c;
    c.weight[pe.point] = pe.sign;
    c.weight[pe.e0] = -pe.sign * (1 - on.t);
    c.weight[pe.e1] = -pe.sign * on.t;
    if (on.interior) {
        c.free_count = 1;
        c.free_weight[0][pe.e0] = pe.sign;
        c.free_weight[0][pe.e1] = -pe.sign;
    }
    finish(x, c);
    return c;
}

// Indices 1, 2, 3 of a triangle's vertices, in order round it, the one across from the longest edge first.
std::array<int, 3> across_from_longest_edge(const Vector3& t0, const Vector3& t1, const Vector3& t2) {
    const double e01 = (t1 - t0).squaredNorm(), e12 = (t2 - t1).squaredNorm(), e20 = (t0 - t2).squaredNorm();
    const int first = e12 >= e01 ? (e12 >= e20 ? 0 : 1) : (e01 >= e20 ? 2 : 1);
    return {1 + first, 1 + (first + 1) % 3, 1 + (first + 2) % 3};
}

}  // namespace

ClosestPoints point_triangle_closest(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2) {
    const std::array<const Vector3*, 4> x{&p, &t0, &t1, &t2};
    // From the vertex that the two shorter edges share: in a sliver the longer ones are parallel to rounding.
    const std::array<int, 3> corner = across_from_longest_edge(t0, t1, t2);
    const Vector3& c0 = *x[corner[0]];
    const Vector3 u = *x[corner[1]] - c0, v = *x[corner[2]] - c0, w = p - c0;
    const Vector3 n = u.cross(v);
    const double nn = n.squaredNorm();
    if (nn > 0) {
        const double b1 = w.cross(v).dot(n) / nn;
        const double b2 = u.cross(w).dot(n) / nn;
        const double b0 = 1 - b1 - b2;
        if (b0 > 0 && b1 > 0 && b2 > 0) {
            ClosestPoints c;
            c.weight[0] = 1;
            c.weight[corner[0]] = -b0;
            c.weight[corner[1]] = -b1;
            c.weight[corner[2]] = -b2;
            c.free_count = 2;
            c.free_weight[0] = {0, 1, -1, 0};
            c.free_weight[1] = {0, 1, 0, -1};
            finish(x, c);
            return c;
        }
    }
    return best_of<3>(x, {{{0, 1, 2, 1.0}, {0, 2, 3, 1.0}, {0, 3, 1, 1.0}}});
}

ClosestPoints edge_edge_closest(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    const std::array<const Vector3*, 4> x{&ea0, &ea1, &eb0, &eb1};
    const Vector3 u = ea1 - ea0, v = eb1 - eb0, w = eb0 - ea0;
    // By cross products rather than a e - b^2: resolves angles down to rounding instead of its square root.
    const Vector3 n = u.cross(v);
    const double nn = n.squaredNorm();
    if (nn > 0) {
        const double s = w.cross(v).dot(n) / nn;
        const double t = w.cross(u).dot(n) / nn;
        if (s > 0 && s < 1 && t > 0 && t < 1) {
            ClosestPoints c;
            c.weight = {1 - s, s, -(1 - t), -t};
            c.free_count = 2;
            c.free_weight[0] = {-1, 1, 0, 0};
            c.free_weight[1] = {0, 0, 1, -1};
            finish(x, c);
            return c;
        }
    }
    // The optimum of a convex function over the square lies on its boundary when it is not inside.
    return best_of<4>(x, {{{0, 2, 3, 1.0}, {1, 2, 3, 1.0}, {2, 0, 1, -1.0}, {3, 0, 1, -1.0}}});
}

}  // namespace fettle::core::geometry
