// SPDX-License-Identifier: MIT
#include "core/parts/short_edges.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/types.hpp"

namespace fettle::core::parts {

namespace {

// The same triangle from either side: its corners in the order of their numbers, and which way round they go.
struct WayRound {
    std::array<int, 3> corners;
    bool is_even;
};

WayRound way_round(std::array<int, 3> corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    const bool is_even = corners[1] < corners[2];
    if (!is_even) std::swap(corners[1], corners[2]);
    return {corners, is_even};
}

// Corners of edges that are at most so long become one; those that are left are `root_of` themselves.
std::vector<int> drawn_together(const SolidCut& cut, const std::vector<double>& worth, double shortest) {
    std::vector<int> root(cut.vertices.size());
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](int v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const CutTriangle& t : cut.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const int one = root_of(t.corners[k]), two = root_of(t.corners[(k + 1) % 3]);
            if (one == two || (cut.points[one] - cut.points[two]).norm() > shortest) continue;
            const bool first = worth[one] != worth[two] ? worth[one] > worth[two] : one < two;
            root[first ? two : one] = first ? one : two;
        }
    for (int v = 0; v < count_of(root); ++v) root[v] = root_of(v);
    return root;
}

// Without those that lie on each other back to back.
std::vector<CutTriangle> without_doubles(const std::vector<CutTriangle>& triangles) {
    std::map<std::array<int, 3>, int> left;  // how many more go round one way than the other
    for (const CutTriangle& t : triangles) left[way_round(t.corners).corners] += way_round(t.corners).is_even ? 1 : -1;
    std::vector<CutTriangle> out;
    for (const CutTriangle& t : triangles) {
        const WayRound way = way_round(t.corners);
        int& more = left[way.corners];
        if (more == 0 || (more > 0) != way.is_even) continue;
        more += way.is_even ? -1 : 1;
        out.push_back(t);
    }
    return out;
}

// Triangles whose three corners lie on one line to within rounding: the middle one is put into the neighbour across the longest side.
class Caps {
public:
    Caps(const std::vector<Vector3>& points, std::vector<CutTriangle> triangles, double lowest)
        : points_(points), triangles_(std::move(triangles)), lowest_(lowest) {
        for (int t = 0; t < count_of(triangles_); ++t) add(t);
    }

    std::vector<CutTriangle> removed() {
        // Each step takes one away and makes one more of its neighbour, which may be one in turn.
        long steps = 8 * static_cast<long>(triangles_.size());
        for (int t = 0; t < count_of(triangles_) && steps > 0; ++t)
            for (int at = t; at >= 0 && steps > 0; --steps) at = remove(at);
        std::vector<CutTriangle> out;
        for (const CutTriangle& t : triangles_)
            if (t.triangle >= 0) out.push_back(t);
        return out;
    }

private:
    void add(int t) {
        for (std::size_t k = 0; k < 3; ++k) left_of_[{triangles_[t].corners[k], triangles_[t].corners[(k + 1) % 3]}] = t;
    }
    void drop(int t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto half = left_of_.find({triangles_[t].corners[k], triangles_[t].corners[(k + 1) % 3]});
            if (half != left_of_.end() && half->second == t) left_of_.erase(half);
        }
        triangles_[t].triangle = -1;
    }

    // The neighbour that took the middle corner, which may have become one too; -1: there is nothing to do.
    int remove(int t) {
        if (triangles_[t].triangle < 0) return -1;
        const std::array<int, 3> c = triangles_[t].corners;
        std::size_t longest = 0;
        double length = 0;
        for (std::size_t k = 0; k < 3; ++k)
            if (const double side = (points_[c[(k + 1) % 3]] - points_[c[k]]).norm(); side > length) {
                length = side;
                longest = k;
            }
        const int from = c[longest], to = c[(longest + 1) % 3], middle = c[(longest + 2) % 3];
        const Vector3 area = (points_[to] - points_[from]).cross(points_[middle] - points_[from]);
        if (area.norm() > lowest_ * length) return -1;
        const auto across = left_of_.find({to, from});
        if (across == left_of_.end() || across->second == t) return -1;
        const int other = across->second;
        const CutTriangle whole = triangles_[other];
        const int apex = whole.corners[0] + whole.corners[1] + whole.corners[2] - from - to;
        drop(t);
        drop(other);
        if (apex == middle) return -1;  // back to back
        CutTriangle one = whole, two = whole;
        one.corners = {to, middle, apex};
        two.corners = {middle, from, apex};
        triangles_[t] = one;
        triangles_[other] = two;
        add(t);
        add(other);
        return is_cap(one) ? t : is_cap(two) ? other : -1;
    }

    bool is_cap(const CutTriangle& t) const {
        double length = 0;
        for (std::size_t k = 0; k < 3; ++k) length = std::max(length, (points_[t.corners[(k + 1) % 3]] - points_[t.corners[k]]).norm());
        const Vector3 from = points_[t.corners[0]];
        return (points_[t.corners[1]] - from).cross(points_[t.corners[2]] - from).norm() <= lowest_ * length;
    }

    const std::vector<Vector3>& points_;
    std::vector<CutTriangle> triangles_;  // `triangle` -1: it is gone
    double lowest_;
    std::map<std::pair<int, int>, int> left_of_;  // half edges
};

// Only corners that triangles have.
SolidCut used(const SolidCut& cut, const std::vector<CutTriangle>& triangles) {
    SolidCut out;
    std::vector<int> place(cut.vertices.size(), -1);
    for (CutTriangle t : triangles) {
        for (int& corner : t.corners) {
            if (place[corner] < 0) {
                place[corner] = count_of(out.vertices);
                out.vertices.push_back(cut.vertices[corner]);
                out.points.push_back(cut.points[corner]);
            }
            corner = place[corner];
        }
        out.triangles.push_back(t);
    }
    return out;
}

}  // namespace

SolidCut without_short_edges(SolidCut cut, const std::vector<double>& worth, double shortest) {
    FETTLE_ASSERT(cut.points.size() == cut.vertices.size() && worth.size() == cut.vertices.size(), "corners have places");
    const std::vector<int> root = drawn_together(cut, worth, shortest);
    std::vector<CutTriangle> triangles;
    for (CutTriangle t : cut.triangles) {
        for (int& corner : t.corners) corner = root[corner];
        if (t.corners[0] != t.corners[1] && t.corners[1] != t.corners[2] && t.corners[2] != t.corners[0]) triangles.push_back(t);
    }
    return used(cut, Caps(cut.points, without_doubles(triangles), shortest).removed());
}

}  // namespace fettle::core::parts
