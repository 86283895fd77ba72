// SPDX-License-Identifier: MIT
#include "core/geometry/half_edges.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

namespace fettle::core::geometry {
namespace {

/// Up to this many entries are sorted by insertion, and looked through one by one.
constexpr std::ptrdiff_t few = 16;

/// A side of triangle `side / 3`, from its corner `side % 3` to the next, or an edge of a list, of which `side` is the position.
struct Side {
    int low, high, side;
};

bool comes_before(const Side& a, const Side& b) { return std::tie(a.high, a.side) < std::tie(b.high, b.side); }

/// Sorts the sides of one smaller index; they come in the order of their positions.
void sort_bucket(Side* first, Side* last) {
    if (last - first > few) return std::sort(first, last, comes_before);
    for (Side* at = first; at < last; ++at) {
        const Side moved = *at;
        Side* to = at;
        for (; to > first && moved.high < to[-1].high; --to) *to = to[-1];
        *to = moved;
    }
}

struct SortedSides {
    std::vector<Side> sides;  ///< by smaller index, larger index, position
    int lowest = 0;
    std::vector<int>
        first;  ///< per smaller index, from lowest: where its sides begin, and one more for the end; empty if they are too thin
};

/// @param ends  (position) -> the two indices; for positions from 0 to count - 1.
template <class Ends>
SortedSides sorted_sides(std::size_t count, const Ends& ends) {
    SortedSides out;
    out.sides.resize(count);
    if (count == 0) return out;
    int lowest = ends(0)[0], highest = lowest;
    for (std::size_t i = 0; i < count; ++i) {
        const Edge e = ends(i);
        const int low = std::min(e[0], e[1]);
        lowest = std::min(lowest, low);
        highest = std::max(highest, low);
    }
    const std::int64_t range = static_cast<std::int64_t>(highest) - lowest + 1;
    const auto side_at = [&](std::size_t i) {
        const Edge e = ends(i);
        return Side{std::min(e[0], e[1]), std::max(e[0], e[1]), static_cast<int>(i)};
    };
    if (range > static_cast<std::int64_t>(4 * count) + 1024) {
        for (std::size_t i = 0; i < count; ++i) out.sides[i] = side_at(i);
        std::sort(out.sides.begin(), out.sides.end(),
                  [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : comes_before(a, b); });
        return out;
    }
    out.lowest = lowest;
    out.first.assign(static_cast<std::size_t>(range) + 1, 0);
    for (std::size_t i = 0; i < count; ++i) ++out.first[static_cast<std::size_t>(side_at(i).low - lowest) + 1];
    for (std::size_t v = 1; v < out.first.size(); ++v) out.first[v] += out.first[v - 1];
    std::vector<int> next(out.first.begin(), out.first.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const Side side = side_at(i);
        out.sides[next[side.low - lowest]++] = side;
    }
    for (std::size_t v = 0; v + 1 < out.first.size(); ++v)
        sort_bucket(out.sides.data() + out.first[v], out.sides.data() + out.first[v + 1]);
    return out;
}

/// From corner k of a triangle to the next, by 3 t + k.
Edge ends_of_side(const std::vector<Triangle>& triangles, std::size_t side) {
    const Triangle& t = triangles[side / 3];
    const std::size_t k = side % 3;
    return {t[k], t[k == 2 ? 0 : k + 1]};
}

SortedSides sorted_sides(const std::vector<Triangle>& triangles) {
    return sorted_sides(3 * triangles.size(), [&](std::size_t side) { return ends_of_side(triangles, side); });
}

}  // namespace

std::vector<HalfEdge> sorted_half_edges(const std::vector<Triangle>& triangles) {
    const SortedSides sorted = sorted_sides(triangles);
    std::vector<HalfEdge> halves;
    halves.reserve(sorted.sides.size());
    for (const Side& s : sorted.sides) {
        const bool forward = s.low != s.high && ends_of_side(triangles, static_cast<std::size_t>(s.side))[0] == s.low;
        halves.push_back({s.low, s.high, forward, s.side / 3});
    }
    return halves;
}

TriangleEdges triangle_edges(const std::vector<Triangle>& triangles) {
    const SortedSides sorted = sorted_sides(triangles);
    const std::vector<Side>& sides = sorted.sides;
    TriangleEdges out;
    out.of_side.assign(sides.size(), -1);
    // First the position of each edge's first side, then its number.
    std::size_t count = 0;
    for (std::size_t i = 0, last = 0; i < sides.size(); i = last) {
        for (last = i; last < sides.size() && sides[last].low == sides[i].low && sides[last].high == sides[i].high; ++last)
            if (sides[i].low != sides[i].high) out.of_side[sides[last].side] = sides[i].side;
        if (sides[i].low != sides[i].high) ++count;
    }
    out.edges.reserve(count);
    for (std::size_t side = 0; side < sides.size(); ++side) {
        const int first = out.of_side[side];
        if (first < 0) continue;
        if (static_cast<std::size_t>(first) == side) {
            out.of_side[side] = count_of(out.edges);
            out.edges.push_back(ends_of_side(triangles, side));
        } else {
            out.of_side[side] = out.of_side[first];
        }
    }
    return out;
}

EdgeIndex::EdgeIndex(const std::vector<Edge>& edges) {
    SortedSides sorted = sorted_sides(edges.size(), [&](std::size_t e) { return edges[e]; });
    lowest_ = sorted.lowest;
    first_ = std::move(sorted.first);
    entries_.reserve(sorted.sides.size());
    for (const Side& s : sorted.sides) entries_.push_back({s.low, s.high, s.side});
}

int EdgeIndex::find(int a, int b) const {
    const auto [low, high] = std::minmax(a, b);
    auto begin = entries_.begin(), end = entries_.end();
    if (!first_.empty()) {
        const std::int64_t place = static_cast<std::int64_t>(low) - lowest_;
        if (place < 0 || place + 1 >= static_cast<std::int64_t>(first_.size())) return -1;
        begin = entries_.begin() + first_[place];
        end = entries_.begin() + first_[static_cast<std::size_t>(place) + 1];
    }
    // Behind the last one that is not larger.
    if (first_.empty() || end - begin > few) {
        const Entry wanted{low, high, 0};
        end = std::upper_bound(begin, end, wanted,
                               [](const Entry& x, const Entry& y) { return std::tie(x.low, x.high) < std::tie(y.low, y.high); });
    } else {
        while (end != begin && high < (end - 1)->high) --end;
    }
    const bool found = end != begin && (end - 1)->low == low && (end - 1)->high == high;
    return found ? (end - 1)->edge : -1;
}

}  // namespace fettle::core::geometry
