// SPDX-License-Identifier: MIT
#include "core/solids/self_intersection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"
#include "core/base/rounding.hpp"
#include "core/geometry/close_boxes.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/simple_fan.hpp"

namespace fettle::core::solids {
namespace {

using Corners = std::array<Vector3, 3>;
using TrianglePairs = std::vector<std::pair<int, int>>;

constexpr int triangles_per_piece = 4096;

Corners triangle_corners(const Matrix3X& vertices, const geometry::Triangle& t) {
    return {vertices.col(t[0]), vertices.col(t[1]), vertices.col(t[2])};
}

geometry::Box triangle_box(const Corners& x) { return {x[0].cwiseMin(x[1]).cwiseMin(x[2]), x[0].cwiseMax(x[1]).cwiseMax(x[2])}; }

bool all_on_one_side(const Corners& triangle, const Corners& points) {
    const int side = geometry::orient3d(triangle[0], triangle[1], triangle[2], points[0]);
    return side != 0 && geometry::orient3d(triangle[0], triangle[1], triangle[2], points[1]) == side &&
           geometry::orient3d(triangle[0], triangle[1], triangle[2], points[2]) == side;
}

/// Corners of t in cyclic order such that the ones shared with u come first. Returns how many are shared.
int rotate_shared_first(geometry::Triangle& t, const geometry::Triangle& u) {
    const auto is_shared = [&](int vertex) { return std::find(u.begin(), u.end(), vertex) != u.end(); };
    const int count = static_cast<int>(std::count_if(t.begin(), t.end(), is_shared));
    if (count == 1) {
        while (!is_shared(t[0])) std::rotate(t.begin(), t.begin() + 1, t.end());
    } else if (count == 2) {
        while (is_shared(t[2])) std::rotate(t.begin(), t.begin() + 1, t.end());
    }
    return count;
}

/// Two triangles with an area: do they meet anywhere but in the vertices and the edge that they share by index?
bool intersect_improperly(const Matrix3X& vertices, geometry::Triangle t, geometry::Triangle u) {
    const int shared = rotate_shared_first(t, u);
    rotate_shared_first(u, t);
    const Corners a = triangle_corners(vertices, t), b = triangle_corners(vertices, u);
    if (shared == 0) return triangles_intersect(a, b);
    if (shared == 1) {
        // From a common point x other than the shared vertex v one can go on, away from v, until one of the triangles ends: on its edge
        // opposite to v, still within the other.
        return geometry::segment_intersects_triangle(a[1], a[2], b) || geometry::segment_intersects_triangle(b[1], b[2], a);
    }
    if (shared == 2) {
        // Two half planes bounded by one line meet elsewhere only if they are the same half plane.
        if (geometry::orient3d(a[0], a[1], a[2], b[2]) != 0) return false;
        const int axis = geometry::projection_axis(a[0], a[1], a[2]);
        const auto side = [&](const Vector3& x) {
            return geometry::orient2d(geometry::projected(a[0], axis), geometry::projected(a[1], axis), geometry::projected(x, axis));
        };
        return side(a[2]) == side(b[2]);
    }
    return true;
}

/// orient2d where floating-point arithmetic is sure of it (predicates.cpp has the bound), else 0.
int certain_orient2d(const Vector2& a, const Vector2& b, const Vector2& c) {
    const double left = (b.x() - a.x()) * (c.y() - a.y()), right = (b.y() - a.y()) * (c.x() - a.x());
    const double value = left - right, bound = 5 * unit_roundoff * (std::abs(left) + std::abs(right)) + 0x1p-760;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

bool has_no_area(const Corners& x) {
    for (int axis = 0; axis < 3; ++axis) {
        if (certain_orient2d(geometry::projected(x[0], axis), geometry::projected(x[1], axis), geometry::projected(x[2], axis)) != 0)
            return false;
    }
    return geometry::is_degenerate(x);
}

/// Seen along the axis, is there an edge of t that has all of u strictly on its other side?
bool has_parting_edge(const std::array<Vector2, 3>& t, const std::array<Vector2, 3>& u) {
    const int turn = certain_orient2d(t[0], t[1], t[2]);
    if (turn == 0) return false;
    for (int k = 0; k < 3; ++k) {
        const Vector2 &a = t[k], &b = t[k == 2 ? 0 : k + 1];
        if (std::all_of(u.begin(), u.end(), [&](const Vector2& x) { return certain_orient2d(a, b, x) == -turn; })) return true;
    }
    return false;
}

/// Is there a line that parts them, as seen along the axis in which t is largest? Then they have no point in common. Most neighbours have.
bool are_seen_apart(const Corners& t, const Corners& u) {
    int axis = 0;
    (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs().maxCoeff(&axis);
    const std::array<Vector2, 3> a{geometry::projected(t[0], axis), geometry::projected(t[1], axis), geometry::projected(t[2], axis)};
    const std::array<Vector2, 3> b{geometry::projected(u[0], axis), geometry::projected(u[1], axis), geometry::projected(u[2], axis)};
    return has_parting_edge(a, b) || has_parting_edge(b, a);
}

/// Nine comparisons without a branch: most pairs whose boxes overlap are neighbours, by one vertex or another.
bool share_a_vertex(const geometry::Triangle& t, const geometry::Triangle& u) {
    unsigned shared = 0;
    for (const int v : t)
        for (const int w : u) shared |= static_cast<unsigned>(v == w);
    return shared != 0;
}

/// Those of one mesh, unless there are too many.
class PairFinder {
public:
    PairFinder(const geometry::Mesh& mesh, const std::vector<char>& without_area, int limit)
        : mesh_(mesh), without_area_(without_area), limit_(limit) {}

    /// In order. nullopt: there are `limit` or more.
    std::optional<TrianglePairs> run() {
        TrianglePairs pairs = of_neighbours();
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        if (too_many_ || count_of(pairs) >= limit_) return std::nullopt;
        const TrianglePairs others = of_others();
        if (too_many_ || static_cast<int>(pairs.size() + others.size()) >= limit_) return std::nullopt;
        pairs.insert(pairs.end(), others.begin(), others.end());
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

private:
    static TrianglePairs appended(TrianglePairs&& all, TrianglePairs&& more) {
        all.insert(all.end(), more.begin(), more.end());
        return std::move(all);
    }

    bool cross(int t, int u) const { return intersect_improperly(mesh_.vertices, mesh_.triangles[t], mesh_.triangles[u]); }

    /// Pairs of triangles with a vertex in common; some twice.
    TrianglePairs of_neighbours() {
        const VertexCorners corners(mesh_);
        return base::ordered_reduce(
            static_cast<int>(mesh_.vertices.cols()), triangles_per_piece, TrianglePairs{},
            [&](int begin, int end) {
                TrianglePairs found;
                FanCheck fans(mesh_, corners);
                for (int v = begin; v < end && !too_many_; ++v) {
                    if (corners.end(v) - corners.begin(v) > 1 && !fans.is_simple(v)) add_round(corners, v, found);
                }
                return found;
            },
            appended);
    }

    void add_round(const VertexCorners& corners, int vertex, TrianglePairs& found) {
        for (const int* c = corners.begin(vertex); c != corners.end(vertex); ++c) {
            const int t = *c / 3;
            if (without_area_[t] != 0) continue;
            for (const int* d = c + 1; d != corners.end(vertex); ++d) {
                const int u = *d / 3;
                if (u == t || without_area_[u] != 0 || !cross(t, u)) continue;
                found.emplace_back(std::min(t, u), std::max(t, u));
                // A pair is found at three vertices at most.
                if (static_cast<std::int64_t>(found.size()) > 3 * static_cast<std::int64_t>(limit_)) too_many_ = true;
                if (too_many_) return;
            }
        }
    }

    /// Pairs of triangles without a common vertex.
    TrianglePairs of_others() {
        std::vector<geometry::Box> boxes;
        std::vector<int> triangles;
        boxes.reserve(mesh_.triangles.size());
        triangles.reserve(mesh_.triangles.size());
        for (int t = 0; t < count_of(mesh_.triangles); ++t) {
            if (without_area_[t] != 0) continue;
            boxes.push_back(triangle_box(triangle_corners(mesh_.vertices, mesh_.triangles[t])));
            triangles.push_back(t);
        }
        const geometry::CloseBoxes close(boxes);
        return base::ordered_reduce(
            close.tasks(), 1, TrianglePairs{},
            [&](int begin, int) {
                TrianglePairs found;
                close.visit_task(begin, [&](int i, int j) {
                    const int t = triangles[i], u = triangles[j];
                    if (!share_a_vertex(mesh_.triangles[t], mesh_.triangles[u]) && meet(t, u))
                        found.emplace_back(std::min(t, u), std::max(t, u));
                    if (count_of(found) >= limit_) too_many_ = true;
                    return !too_many_;
                });
                return found;
            },
            appended);
    }

    bool meet(int t, int u) const {
        const Corners a = triangle_corners(mesh_.vertices, mesh_.triangles[t]), b = triangle_corners(mesh_.vertices, mesh_.triangles[u]);
        return !are_seen_apart(a, b) && triangles_intersect(a, b);
    }

    const geometry::Mesh& mesh_;
    const std::vector<char>& without_area_;
    int limit_;
    std::atomic<bool> too_many_ = false;
};

/// The first `max_count` in the order in which one tree meets them.
TrianglePairs first_pairs(const geometry::Mesh& mesh, const std::vector<char>& without_area, int max_count) {
    std::vector<geometry::Box> boxes;
    std::vector<int> triangles;
    for (int t = 0; t < count_of(mesh.triangles); ++t) {
        if (without_area[t] != 0) continue;
        boxes.push_back(triangle_box(triangle_corners(mesh.vertices, mesh.triangles[t])));
        triangles.push_back(t);
    }
    TrianglePairs pairs;
    geometry::visit_overlapping_pairs(boxes, [&](int i, int j) {
        const int t = triangles[i], u = triangles[j];
        if (intersect_improperly(mesh.vertices, mesh.triangles[t], mesh.triangles[u])) pairs.emplace_back(t, u);
        return count_of(pairs) < max_count;
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace

std::vector<char> triangles_without_area(const geometry::Mesh& mesh) {
    std::vector<char> without(mesh.triangles.size(), 0);
    base::parallel_for(count_of(mesh.triangles), triangles_per_piece, [&](int t) {
        const auto at = static_cast<std::size_t>(t);
        without[at] = has_no_area(triangle_corners(mesh.vertices, mesh.triangles[at])) ? 1 : 0;
    });
    return without;
}

std::vector<std::pair<int, int>> self_intersections(const geometry::Mesh& mesh, int max_count) {
    for (const geometry::Triangle& t : mesh.triangles) {
        for (const int v : t) FETTLE_ASSERT(v >= 0 && v < mesh.vertices.cols(), "self_intersections needs vertex indices in range");
    }
    if (max_count <= 0) return {};
    const std::vector<char> without_area = triangles_without_area(mesh);
    if (auto all = PairFinder(mesh, without_area, max_count).run()) return std::move(*all);
    return first_pairs(mesh, without_area, max_count);
}

bool triangles_intersect(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b) {
    if (!triangle_box(a).overlaps(triangle_box(b)) || all_on_one_side(a, b) || all_on_one_side(b, a)) return false;
    // If they meet, then an edge of one meets the other: the ends of their common segment, or a corner within, are on an edge.
    for (int k = 0; k < 3; ++k) {
        if (geometry::segment_intersects_triangle(a[k], a[(k + 1) % 3], b) ||
            geometry::segment_intersects_triangle(b[k], b[(k + 1) % 3], a))
            return true;
    }
    return false;
}

}  // namespace fettle::core::solids
