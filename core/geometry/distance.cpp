// SPDX-License-Identifier: MIT
#include "core/geometry/distance.hpp"

#include "core/base/rounding.hpp"
#include "core/geometry/accurate_cross.hpp"

namespace fettle::core::geometry {
namespace {

using Vertices = std::array<const Vector3*, 4>;

constexpr unsigned all_sides = ~0U;

// Closest point of vertex `p` (weight sign, index) to the segment of the vertices (i0, i1), whose weights carry the other sign.
struct PointEdge {
    int point, e0, e1;
    double sign;  // of the point's weight
};

// Where on the segment, and how far the point is from there.
struct OnSegment {
    double t;            // closest parameter in [0, 1]
    bool interior;       // strictly between the ends
    Vector3 difference;  // from there to the point
    double distance_squared;
};

// The part of r that is normal to d. What rounding left along d is of the size of the vertices' distances, not of r: near contact it
// would turn r, and with it the force, by far more than rounding does.
Vector3 normal_to(const Vector3& d, double dd, const Vector3& r) { return r - (r.dot(d) / dd) * d; }

OnSegment closest_on_segment(const Vector3& p, const Vector3& e0, const Vector3& e1) {
    const Vector3 e = e1 - e0, w = p - e0;
    const double ee = e.squaredNorm();
    const double pe = w.dot(e);
    if (!(pe > 0) || ee == 0) return {0, false, w, w.squaredNorm()};
    if (pe >= ee) {
        const Vector3 end = p - e1;
        return {1, false, end, end.squaredNorm()};
    }
    const double t = pe / ee;
    const Vector3 r = normal_to(e, ee, w - t * e);
    return {t, true, r, r.squaredNorm()};
}

// From the weights. Differences to one vertex first: r stays accurate far from the origin because the weights sum to zero.
void finish(const Vertices& x, ClosestPoints& c) {
    c.difference = c.weight[0] * (*x[0] - *x[3]) + c.weight[1] * (*x[1] - *x[3]) + c.weight[2] * (*x[2] - *x[3]);
    c.distance_squared = c.difference.squaredNorm();
}

// Turns r onto the pair's normal n = u x v where that is told by n better than by the weights. @param size_squared  L^2, about
void turn_to(const Vector3& n, double nn, double sine_squared, double size_squared, ClosestPoints& c) {
    if (!(c.distance_squared <= sine_squared * size_squared)) return;
    c.difference = (c.difference.dot(n) / nn) * n;
    c.distance_squared = c.difference.squaredNorm();
}

// The least of those cases whose bits are set, one at least; only that one is worked out.
template <std::size_t N>
ClosestPoints best_of(const Vertices& x, const std::array<PointEdge, N>& cases, unsigned wanted = all_sides) {
    std::size_t best = N;
    OnSegment on{};
    for (std::size_t i = 0; i < N; ++i) {
        if ((wanted >> i & 1U) == 0) continue;
        const OnSegment other = closest_on_segment(*x[cases[i].point], *x[cases[i].e0], *x[cases[i].e1]);
        if (best < N && !(other.distance_squared < on.distance_squared)) continue;
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
    c.difference = pe.sign * on.difference;
    c.distance_squared = on.distance_squared + 0 * (*x[0] + *x[1] + *x[2] + *x[3]).sum();  // not finite if a vertex is not
    return c;
}

// w = along_u u + along_v v + something normal to both.
struct InPlane {
    double along_u, along_v;
};

// Are the coordinates sure to 3e-8? Rounding puts them off by at most 24 u |w| / (|u| sine).
bool are_sure(double uu, double vv, double ww, double nn) { return nn >= 1e-6 * (uu * vv) && ww <= 1e8 * std::min(uu, vv); }

// By how much a coordinate has to be on its side of a bound to be so surely.
constexpr double surely = 1e-6;

// The optimum of a convex function over the square or the triangle of parameters lies on its boundary when it is not inside, and there on a
// side that parts it from the optimum over the plane: along the straight way from the one to the other the function falls.
// @param interior  what the coordinates of w make of the closest points; nothing if they are not strictly inside.
// @param sides     of coordinates that are sure: which of the cases of `boundary` may hold the optimum
template <class Interior, class Sides, std::size_t N>
ClosestPoints closest(const Vertices& x, const Vector3& u, const Vector3& v, const Vector3& w, const Interior& interior, const Sides& sides,
                      const std::array<PointEdge, N>& boundary) {
    // By cross products rather than a e - b^2: resolves angles down to rounding instead of its square root.
    const Vector3 n = u.cross(v);
    const double nn = n.squaredNorm(), uu = u.squaredNorm(), vv = v.squaredNorm();
    // Bounds and why they suffice: see the header. What is not a number goes to the boundary.
    constexpr double parallel = 64 * unit_roundoff * unit_roundoff, least_square = 1e-290;
    if (!(nn > parallel * (uu * vv) + least_square)) return best_of(x, boundary);
    ClosestPoints c;
    const double ww = w.squaredNorm();
    const InPlane at{w.cross(v).dot(n) / nn, u.cross(w).dot(n) / nn};
    if (!interior(at, c)) return best_of(x, boundary, are_sure(uu, vv, ww, nn) ? sides(at) : all_sides);
    finish(x, c);
    const double sine_squared = nn / (uu * vv), size_squared = uu + vv + ww;
    constexpr double trusted = 1024 * unit_roundoff;
    if (c.distance_squared * (sine_squared * sine_squared) >= trusted * trusted * size_squared) {
        turn_to(n, nn, sine_squared, size_squared, c);
        return c;
    }
    // Nearly parallel, or nearly touching.
    const ClosestPoints best = best_of(x, boundary);
    const Vector3 accurate = accurate_cross(u, v);
    const double squared = accurate.squaredNorm();
    if (!interior({accurate_cross(w, v).dot(accurate) / squared, accurate_cross(u, w).dot(accurate) / squared}, c)) return best;
    finish(x, c);
    turn_to(accurate, squared, squared / (uu * vv), size_squared, c);
    return c.distance_squared <= best.distance_squared ? c : best;
}

// The corner, 1 to 3, that is closest because the triangle's whole wedge lies behind it; 0: none. `edge`: from corners 1, 2, 3 to the next.
int closest_corner(const std::array<Vector3, 3>& edge, const std::array<Vector3, 3>& from_corner) {
    for (std::size_t k = 0; k < 3; ++k)
        if (edge[k].dot(from_corner[k]) <= 0 && edge[(k + 2) % 3].dot(from_corner[k]) >= 0) return static_cast<int>(k) + 1;
    return 0;
}

// Vertices `first` and `second` of x, of one primitive each; difference: x_first - x_second.
ClosestPoints at_vertices(const Vertices& x, int first, int second, const Vector3& difference) {
    ClosestPoints c;
    c.weight[first] = 1;
    c.weight[second] = -1;
    c.difference = difference;
    c.distance_squared = difference.squaredNorm() + 0 * (*x[0] + *x[1] + *x[2] + *x[3]).sum();  // as in best_of
    return c;
}

// Indices 1, 2, 3 of a triangle's vertices, in order round it, the one across from the longest edge first.
std::array<int, 3> across_from_longest_edge(const std::array<Vector3, 3>& edge) {
    const double e01 = edge[0].squaredNorm(), e12 = edge[1].squaredNorm(), e20 = edge[2].squaredNorm();
    const int first = e12 >= e01 ? (e12 >= e20 ? 0 : 1) : (e01 >= e20 ? 2 : 1);
    return {1 + first, 1 + (first + 1) % 3, 1 + (first + 2) % 3};
}

}  // namespace

ClosestPoints point_triangle_closest(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2) {
    const Vertices x{&p, &t0, &t1, &t2};
    const std::array<Vector3, 3> edge{t1 - t0, t2 - t1, t0 - t2}, from_corner{p - t0, p - t1, p - t2};
    if (const int k = closest_corner(edge, from_corner); k > 0) return at_vertices(x, 0, k, from_corner[static_cast<std::size_t>(k) - 1]);
    // From the vertex that the two shorter edges share: in a sliver the longer ones are parallel to rounding.
    const std::array<int, 3> corner = across_from_longest_edge(edge);
    const Vector3& c0 = *x[corner[0]];
    const auto interior = [&corner](const InPlane& b, ClosestPoints& c) {
        const double b0 = 1 - b.along_u - b.along_v;
        if (!(b0 > 0 && b.along_u > 0 && b.along_v > 0)) return false;
        c.weight[0] = 1;
        c.weight[corner[0]] = -b0;
        c.weight[corner[1]] = -b.along_u;
        c.weight[corner[2]] = -b.along_v;
        c.free_count = 2;
        c.free_weight[0] = {0, 1, -1, 0};
        c.free_weight[1] = {0, 1, 0, -1};
        return true;
    };
    const auto sides = [&corner](const InPlane& b) {
        // Case k lies across from corner k, of corners 1 to 3 that numbered 3 first.
        const double weight[] = {1 - b.along_u - b.along_v, b.along_u, b.along_v};
        unsigned wanted = 0;
        for (std::size_t k = 0; k < 3; ++k)
            if (!(weight[k] > surely)) wanted |= 1U << (corner[k] % 3);
        return wanted;
    };
    return closest<decltype(interior), decltype(sides), 3>(x, *x[corner[1]] - c0, *x[corner[2]] - c0, p - c0, interior, sides,
                                                           {{{0, 1, 2, 1.0}, {0, 2, 3, 1.0}, {0, 3, 1, 1.0}}});
}

ClosestPoints edge_edge_closest(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    const Vertices x{&ea0, &ea1, &eb0, &eb1};
    const auto interior = [](const InPlane& b, ClosestPoints& c) {
        const double s = b.along_u, t = -b.along_v;
        if (!(s > 0 && s < 1 && t > 0 && t < 1)) return false;
        c.weight = {1 - s, s, -(1 - t), -t};
        c.free_count = 2;
        c.free_weight[0] = {-1, 1, 0, 0};
        c.free_weight[1] = {0, 0, 1, -1};
        return true;
    };
    const auto sides = [](const InPlane& b) {
        const double s = b.along_u, t = -b.along_v;
        return unsigned{!(s > surely)} | unsigned{!(1 - s > surely)} << 1 | unsigned{!(t > surely)} << 2 | unsigned{!(1 - t > surely)} << 3;
    };
    // Two ends are closest where both edges lead away from one another there.
    const Vector3 a = ea1 - ea0, b = eb1 - eb0;
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            const Vector3 between = *x[i] - *x[2 + j];
            const double along_a = a.dot(between), along_b = b.dot(between);
            if ((i == 0 ? along_a >= 0 : along_a <= 0) && (j == 0 ? along_b <= 0 : along_b >= 0)) return at_vertices(x, i, 2 + j, between);
        }
    }
    return closest<decltype(interior), decltype(sides), 4>(x, a, b, eb0 - ea0, interior, sides,
                                                           {{{0, 2, 3, 1.0}, {1, 2, 3, 1.0}, {2, 0, 1, -1.0}, {3, 0, 1, -1.0}}});
}

}  // namespace fettle::core::geometry
