// SPDX-License-Identifier: MIT
#include "core/ccd/four_separations.hpp"

#include <cstddef>
#include <limits>

#include "core/base/rounding.hpp"

namespace fettle::core::ccd {
namespace {

using base::Four;
using base::lanes;
using geometry::PairType;

constexpr double least_sine_squared = 1e-10;                          // square of a sine: below it cross products cancel
constexpr double shortest_squared = 1e-280, longest_squared = 1e280;  // of lengths, which neither overflow nor lose bits between these
constexpr double largest_coordinate = 1e150;

constexpr Four zero{0, 0, 0, 0}, one{1, 1, 1, 1}, least_divisor{1e-300, 1e-300, 1e-300, 1e-300};

using Vector = std::array<Four, 3>;

#define FETTLE_INLINE [[gnu::always_inline]] inline

FETTLE_INLINE void subtract(const Vector& a, const Vector& b, Vector& out) {
    for (std::size_t k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}
// In one order, whatever the instructions.
FETTLE_INLINE void dot(const Vector& a, const Vector& b, Four& out) { out = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
FETTLE_INLINE void cross(const Vector& a, const Vector& b, Vector& out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
FETTLE_INLINE void smaller(const Four& a, const Four& b, Four& out) { out = a < b ? a : b; }
FETTLE_INLINE void larger(const Four& a, const Four& b, Four& out) { out = a > b ? a : b; }

// The difference of the closest points so far: its square is the least.
struct Closest {
    Vector direction;
    Four square;
};

// Closest points of a vertex and an edge; `to_start` leads from the edge's start to the vertex.
FETTLE_INLINE void meet_edge(const Vector& to_start, const Vector& edge, const Four& edge_square, Closest& closest) {
    Four along;
    dot(to_start, edge, along);
    Four s = along / (edge_square > 1e-300 ? edge_square : least_divisor);
    s = s > 0.0 ? s : zero;
    s = s < 1.0 ? s : one;
    Vector difference;
    for (std::size_t k = 0; k < 3; ++k) difference[k] = to_start[k] - s * edge[k];
    Four square;
    dot(difference, difference, square);
    const auto is_less = square < closest.square;
    closest.square = is_less ? square : closest.square;
    for (std::size_t k = 0; k < 3; ++k) closest.direction[k] = is_less ? difference[k] : closest.direction[k];
}

// The normal a x b of a face or two edges, where the closest points lie within both; w from one to the other.
template <PairType type>
FETTLE_INLINE void meet_inside(const Vector& w, const Vector& a, const Vector& b, const Four& aa, const Four& bb, Closest& closest) {
    Vector n, wb, aw;
    Four nn, first, second;
    cross(a, b, n);
    cross(w, b, wb);
    cross(a, w, aw);
    dot(n, n, nn);
    dot(wb, n, first);
    dot(aw, n, second);
    auto is_inside = nn > least_sine_squared * (aa * bb);
    if constexpr (type == PairType::point_triangle)
        is_inside &= (first > 0.0) & (second > 0.0) & (nn - first - second > 0.0);
    else
        is_inside &= (-first > 0.0) & (-first < nn) & (second > 0.0) & (second < nn);
    for (std::size_t k = 0; k < 3; ++k) closest.direction[k] = is_inside ? n[k] : closest.direction[k];
    closest.square = is_inside ? nn : closest.square;
}

// `r`: differences of vertices. Triangle: the point less each corner. Edges: a0 b0, a0 b1, a1 b0, a1 b1.
template <PairType type>
FETTLE_INLINE void meet_all(const std::array<Vector, 4>& r, Closest& closest) {
    closest.square = one * std::numeric_limits<double>::infinity();
    closest.direction = {zero, zero, zero};
    if constexpr (type == PairType::point_triangle) {
        Vector e01, e12, e20, e02;
        Four s01, s12, s20;
        subtract(r[0], r[1], e01);
        subtract(r[1], r[2], e12);
        subtract(r[2], r[0], e20);
        subtract(r[0], r[2], e02);
        dot(e01, e01, s01);
        dot(e12, e12, s12);
        dot(e20, e20, s20);
        meet_edge(r[0], e01, s01, closest);
        meet_edge(r[1], e12, s12, closest);
        meet_edge(r[2], e20, s20, closest);
        meet_inside<type>(r[0], e01, e02, s01, s20, closest);
    } else {
        Vector a, b, back0, back1;
        Four aa, bb;
        subtract(r[2], r[0], a);
        subtract(r[0], r[1], b);
        dot(a, a, aa);
        dot(b, b, bb);
        for (std::size_t k = 0; k < 3; ++k) {
            back0[k] = -r[0][k];
            back1[k] = -r[1][k];
        }
        meet_edge(r[0], b, bb, closest);
        meet_edge(r[2], b, bb, closest);
        meet_edge(back0, a, aa, closest);
        meet_edge(back1, a, aa, closest);
        meet_inside<type>(r[0], a, b, aa, bb, closest);
    }
}

// Where each difference of vertices comes from.
template <PairType type>
constexpr std::array<std::array<std::size_t, 2>, 4> lane_ends() {
    if constexpr (type == PairType::point_triangle) return {{{0, 1}, {0, 2}, {0, 3}, {0, 3}}};
    return {{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};
}

template <PairType type>
FETTLE_INLINE void separate(const FourPairs& x, std::array<double, lanes>& out) {
    constexpr std::size_t count = type == PairType::point_triangle ? 3 : 4;
    std::array<std::array<Four, 6>, 4> at;
    for (std::size_t i = 0; i < 4; ++i) base::gather(x[i], at[i]);
    std::array<Vector, 4> start, end, middle;
    Vector largest{zero, zero, zero};
    Four check = zero;  // stays zero unless something is not finite
    for (std::size_t i = 0; i < count; ++i) {
        const auto [first, second] = lane_ends<type>()[i];
        for (std::size_t k = 0; k < 3; ++k) {
            start[i][k] = at[first][k] - at[second][k];
            end[i][k] = at[first][k + 3] - at[second][k + 3];
            middle[i][k] = 0.5 * start[i][k] + 0.5 * end[i][k];
            Four size;
            base::magnitude(start[i][k], size);
            larger(size, largest[k], largest[k]);
            base::magnitude(end[i][k], size);
            larger(size, largest[k], largest[k]);
            check += (start[i][k] - start[i][k]) + (end[i][k] - end[i][k]);
        }
    }
    Closest closest;
    meet_all<type>(middle, closest);
    // The direction gets length 1 within 6u, or is zero.
    Four square, length;
    dot(closest.direction, closest.direction, square);
    base::square_root(square, length);
    const Four factor = ((square >= shortest_squared) & (square <= longest_squared)) ? 1.0 / length : zero;
    Vector n;
    for (std::size_t k = 0; k < 3; ++k) n[k] = closest.direction[k] * factor;
    Four low = zero + longest_squared, high = zero - longest_squared;
    for (std::size_t i = 0; i < count; ++i) {
        for (const Vector& r : {start[i], end[i]}) {
            Four value;
            dot(n, r, value);
            smaller(value, low, low);
            larger(value, high, high);
        }
    }
    // The limit of SeparatingPlane where dmin is 0.
    Four sum = zero;
    for (std::size_t k = 0; k < 3; ++k) {
        Four size;
        base::magnitude(n[k], size);
        sum += size * largest[k];
    }
    const Four limit = 1.01 * (8 * unit_roundoff * sum + 1e-290);
    Four apart;
    larger(low, -high, apart);
    apart -= limit;
    const auto is_sure = (check == 0.0) & (largest[0] < largest_coordinate) & (largest[1] < largest_coordinate) &
                         (largest[2] < largest_coordinate) & (apart > 0.0);
    base::store(is_sure ? apart : zero, out.data());
}

template <PairType type>
FETTLE_WIDE void separate_wide(const FourPairs& x, std::array<double, lanes>& out) {
    separate<type>(x, out);
}

template <PairType type>
void separate_any(const FourPairs& x, std::array<double, lanes>& out) {
    base::has_wide_instructions() ? separate_wide<type>(x, out) : separate<type>(x, out);
}

#undef FETTLE_INLINE

}  // namespace

std::array<double, lanes> four_separations(PairType type, const FourPairs& x) {
    std::array<double, lanes> out;
    type == PairType::point_triangle ? separate_any<PairType::point_triangle>(x, out) : separate_any<PairType::edge_edge>(x, out);
    return out;
}

}  // namespace fettle::core::ccd
