// SPDX-License-Identifier: MIT
#include "exact_ccd.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/exact_system.hpp"

namespace fettle::tests {

using core::geometry::PairType;
using core::geometry::PairVertices;
using Number = Rational;

namespace {

template <class Integer>
using Point = std::array<Polynomial<Integer>, 3>;

template <class Integer>
Point<Integer> operator-(const Point<Integer>& a, const Point<Integer>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Integer>
Polynomial<Integer> dot(const Point<Integer>& a, const Point<Integer>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Integer>
Point<Integer> cross(const Point<Integer>& a, const Point<Integer>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// One of the two ways to decide a system.
struct Decide {
    bool by_algebra;
    template <class Integer>
    bool operator()(const System<Integer>& system) const {
        return by_algebra ? system.has_solution_by_algebra() : system.has_solution();
    }
};

template <class Integer>
bool vertices_meet(const Point<Integer>& a, const Point<Integer>& b, Decide decide) {
    const Point<Integer> d = a - b;
    System<Integer> same;
    for (const auto& p : d) same.add(Role::zero, p);
    return decide(same);
}

template <class Integer>
bool vertex_meets_edge(const Point<Integer>& p, const Point<Integer>& a, const Point<Integer>& b, Decide decide) {
    const Point<Integer> e = b - a, w = p - a;
    const Polynomial<Integer> along = dot(e, w), length = dot(e, e);
    System<Integer> inside;
    for (const auto& n : cross(e, w)) inside.add(Role::zero, n);
    inside.add(Role::not_negative, along);
    inside.add(Role::not_negative, length - along);
    inside.add(Role::not_zero, length);
    return decide(inside) || vertices_meet(p, a, decide) || vertices_meet(p, b, decide);
}

/// Is there a time at which the normal vanishes? Only then do vertices on edges matter beyond what the interior's system says.
template <class Integer>
bool vanishes(const Point<Integer>& n, Decide decide) {
    System<Integer> zero;
    for (const auto& p : n) zero.add(Role::zero, p);
    return decide(zero);
}

template <class Integer>
bool vertex_meets_triangle(const std::array<Point<Integer>, 4>& x, Decide decide) {
    const Point<Integer> n = cross(x[2] - x[1], x[3] - x[1]);
    System<Integer> face;
    face.add(Role::zero, dot(n, x[0] - x[1]));
    for (std::size_t i = 0; i < 3; ++i) {
        const Point<Integer>&a = x[1 + i], &b = x[1 + (i + 1) % 3];
        face.add(Role::not_negative, dot(n, cross(b - a, x[0] - a)));
    }
    face.add(Role::not_zero, dot(n, n));
    if (decide(face)) return true;
    return vanishes(n, decide) && (vertex_meets_edge(x[0], x[1], x[2], decide) || vertex_meets_edge(x[0], x[2], x[3], decide) ||
                                   vertex_meets_edge(x[0], x[3], x[1], decide));
}

template <class Integer>
bool edges_meet(const std::array<Point<Integer>, 4>& x, Decide decide) {
    const Point<Integer> p = x[1] - x[0], q = x[3] - x[2], w = x[2] - x[0], n = cross(p, q);
    const Polynomial<Integer> nn = dot(n, n), s = dot(cross(w, q), n), t = dot(cross(w, p), n);
    System<Integer> interior;
    interior.add(Role::zero, dot(n, w));
    for (const auto& h : {s, nn - s, t, nn - t}) interior.add(Role::not_negative, h);
    interior.add(Role::not_zero, nn);
    if (decide(interior)) return true;
    return vanishes(n, decide) && (vertex_meets_edge(x[0], x[2], x[3], decide) || vertex_meets_edge(x[1], x[2], x[3], decide) ||
                                   vertex_meets_edge(x[2], x[0], x[1], decide) || vertex_meets_edge(x[3], x[0], x[1], decide));
}

/// The power of two that makes a whole number of every coordinate, and how many bits the largest then has.
struct Scale {
    int exponent = 0, bits = 0;
};
Scale scale_of(const PairVertices& t0, const PairVertices& t1) {
    int least = 0, most = 0;
    bool first = true;
    for (const PairVertices* x : {&t0, &t1})
        for (const Vector3& v : *x)
            for (int k = 0; k < 3; ++k) {
                if (v[k] == 0) continue;
                int exponent = 0;
                const auto mantissa = static_cast<long long>(std::ldexp(std::frexp(v[k], &exponent), 53));
                const int low = exponent - 53 + __builtin_ctzll(static_cast<unsigned long long>(std::abs(mantissa)));
                least = first ? low : std::min(least, low);
                most = first ? exponent : std::max(most, exponent);
                first = false;
            }
    return {-least, most - least};
}

WideInteger scaled(double x, int exponent, WideInteger) { return static_cast<WideInteger>(std::ldexp(x, exponent)); }
BigInteger scaled(double x, int exponent, const BigInteger&) {
    int own = 0;
    const auto mantissa = static_cast<long long>(std::ldexp(std::frexp(x, &own), 53));
    const int shift = own - 53 + exponent;
    return shift >= 0 ? BigInteger(mantissa) << shift : BigInteger(mantissa) / (BigInteger(1) << -shift);
}

template <class Integer>
bool contact(PairType type, const PairVertices& t0, const PairVertices& t1, int exponent, Decide decide) {
    std::array<Point<Integer>, 4> x;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            const Integer a = scaled(t0[i][k], exponent, Integer()), b = scaled(t1[i][k], exponent, Integer());
            Polynomial<Integer>& p = x[i][k];
            p.c[0] = a;
            p.c[1] = b - a;
            p.size = 2;
        }
    return type == PairType::point_triangle ? vertex_meets_triangle(x, decide) : edges_meet(x, decide);
}

using Fixed = std::array<Number, 3>;
Fixed operator-(const Fixed& a, const Fixed& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Number dot(const Fixed& a, const Fixed& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Fixed cross(const Fixed& a, const Fixed& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

Number vertex_edge_squared(const Fixed& p, const Fixed& a, const Fixed& b) {
    const Fixed e = b - a, w = p - a;
    const Number along = dot(e, w), length = dot(e, e);
    if (along <= 0 || length == 0) return dot(w, w);
    if (along >= length) return dot(p - b, p - b);
    return dot(w, w) - along * along / length;
}

Number distance_squared(PairType type, const std::array<Fixed, 4>& x) {
    if (type == PairType::point_triangle) {
        const Fixed n = cross(x[2] - x[1], x[3] - x[1]);
        const Number nn = dot(n, n), off = dot(n, x[0] - x[1]);
        bool inside = nn > 0;
        for (std::size_t i = 0; i < 3; ++i) inside = inside && dot(n, cross(x[1 + (i + 1) % 3] - x[1 + i], x[0] - x[1 + i])) >= 0;
        if (inside) return off * off / nn;
        return std::min(
            {vertex_edge_squared(x[0], x[1], x[2]), vertex_edge_squared(x[0], x[2], x[3]), vertex_edge_squared(x[0], x[3], x[1])});
    }
    const Fixed p = x[1] - x[0], q = x[3] - x[2], w = x[2] - x[0], n = cross(p, q);
    const Number nn = dot(n, n), s = dot(cross(w, q), n), t = dot(cross(w, p), n), off = dot(n, w);
    if (nn > 0 && s >= 0 && s <= nn && t >= 0 && t <= nn) return off * off / nn;
    return std::min({vertex_edge_squared(x[0], x[2], x[3]), vertex_edge_squared(x[1], x[2], x[3]), vertex_edge_squared(x[2], x[0], x[1]),
                     vertex_edge_squared(x[3], x[0], x[1])});
}

// ---- a filter in 64-bit floats: directions along which the pair is apart by more than the distance and all rounding

using Real = long double;
using RealPoint = std::array<Real, 3>;
RealPoint operator-(const RealPoint& a, const RealPoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const RealPoint& a, const RealPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
RealPoint cross(const RealPoint& a, const RealPoint& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Along n, whatever it is: the vertices of one primitive all beyond those of the other by more than distance |n|. With vertices off by
/// 4 units of 2^-64 of `size`, values and their difference are off by less than 2^-58 size |n|_1.
bool apart_along(const RealPoint& n, const std::array<RealPoint, 4>& x, std::size_t first_count, Real size, Real distance) {
    Real low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (std::size_t i = 0; i < 4; ++i) {
        const Real value = dot(n, x[i]);
        const int side = i < first_count ? 0 : 1;
        low[side] = std::min(low[side], value);
        high[side] = std::max(high[side], value);
    }
    const Real error = size * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2])) * 0x1p-58L;
    const Real needed = distance * std::sqrt(dot(n, n)) * (1 + 0x1p-58L) + error;
    return low[0] - high[1] > needed || low[1] - high[0] > needed;
}

bool surely_farther(PairType type, const PairVertices& t0, const PairVertices& t1, double t, double distance) {
    std::array<RealPoint, 4> x;
    Real size = 0x1p-900L;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            const Real a = t0[i][k], b = t1[i][k];
            x[i][k] = a + static_cast<Real>(t) * (b - a);
            size = std::max({size, std::abs(a), std::abs(b)});
        }
    const std::size_t first_count = type == PairType::point_triangle ? 1 : 2;
    const auto apart = [&](const RealPoint& n) { return apart_along(n, x, first_count, size, distance); };
    const auto apart_from_edge = [&](std::size_t p, std::size_t a, std::size_t b) {
        const RealPoint e = x[b] - x[a];
        RealPoint w = x[p] - x[a];
        const Real ee = dot(e, e), s = ee > 0 ? std::clamp(dot(w, e) / ee, Real(0), Real(1)) : Real(0);
        for (std::size_t k = 0; k < 3; ++k) w[k] -= s * e[k];
        return apart(w);
    };
    if (type == PairType::point_triangle) {
        return apart(cross(x[2] - x[1], x[3] - x[1])) || apart_from_edge(0, 1, 2) || apart_from_edge(0, 2, 3) || apart_from_edge(0, 3, 1);
    }
    return apart(cross(x[1] - x[0], x[3] - x[2])) || apart_from_edge(0, 2, 3) || apart_from_edge(1, 2, 3) || apart_from_edge(2, 0, 1) ||
           apart_from_edge(3, 0, 1);
}

}  // namespace

bool exact_linear_contact(PairType type, const PairVertices& t0, const PairVertices& t1) {
    const Scale scale = scale_of(t0, t1);
    // Below 2^11 all coefficients are below 2^62: degree 4 makes 2^(4 * 11 + 17).
    if (scale.bits <= 11) return contact<WideInteger>(type, t0, t1, scale.exponent, {false});
    return contact<BigInteger>(type, t0, t1, scale.exponent, {false});
}

bool exact_linear_contact_by_algebra(PairType type, const PairVertices& t0, const PairVertices& t1) {
    return contact<BigInteger>(type, t0, t1, scale_of(t0, t1).exponent, {true});
}

bool exact_distance_at_most(PairType type, const PairVertices& t0, const PairVertices& t1, double t, double distance) {
    if (surely_farther(type, t0, t1, t, distance)) return false;
    std::array<Fixed, 4> x;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) x[i][k] = Number(t0[i][k]) + Number(t) * (Number(t1[i][k]) - Number(t0[i][k]));
    return distance_squared(type, x) <= Number(distance) * Number(distance);
}

}  // namespace fettle::tests
