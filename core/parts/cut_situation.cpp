// SPDX-License-Identifier: MIT
#include "core/parts/cut_situation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/geometry/distance.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Mesh;

// Which sides of each of two triangles meet the other: six bits; 0 if they have no point in common.
int meeting_sides(const TriangleCorners& a, const TriangleCorners& b) {
    int bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (geometry::segment_intersects_triangle(a[k], a[(k + 1) % 3], b)) bits |= 1 << k;
        if (geometry::segment_intersects_triangle(b[k], b[(k + 1) % 3], a)) bits |= 8 << k;
    }
    return bits;
}

// Points far from everything, which most are, are told by the box.
class Inside {
public:
    explicit Inside(const Mesh& mesh) : mesh_(mesh), box_{mesh.vertices.rowwise().minCoeff(), mesh.vertices.rowwise().maxCoeff()} {}
    bool operator()(const Vector3& p) const { return box_.contains(p) && solids::point_in_solid(p, mesh_.vertices, mesh_.triangles); }

private:
    const Mesh& mesh_;
    geometry::Box box_;
};

double squared_distance(const TriangleCorners& a, const TriangleCorners& b) {
    double least = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
        least = std::min(least, geometry::point_triangle_distance_squared(a[i], b[0], b[1], b[2]));
        least = std::min(least, geometry::point_triangle_distance_squared(b[i], a[0], a[1], a[2]));
        for (std::size_t k = 0; k < 3; ++k)
            least = std::min(least, geometry::edge_edge_distance_squared(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
    }
    return least;
}

}  // namespace

TriangleCorners corners_of(const Mesh& mesh, int triangle) {
    const auto& t = mesh.triangles[triangle];
    return {Vector3(mesh.vertices.col(t[0])), Vector3(mesh.vertices.col(t[1])), Vector3(mesh.vertices.col(t[2]))};
}

std::vector<int> situation_of(const Mesh& a, const Mesh& b) {
    const int count_a = count_of(a.triangles);
    std::vector<geometry::Box> boxes;
    for (const Mesh* mesh : {&a, &b}) {
        for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
            const TriangleCorners c = corners_of(*mesh, static_cast<int>(t));
            boxes.push_back({c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])});
        }
    }
    const auto pairs = geometry::overlapping_pairs(boxes, [&](int i, int j) {
        return i < count_a && j >= count_a && meeting_sides(corners_of(a, i), corners_of(b, j - count_a)) != 0;
    });
    std::vector<int> out{count_of(pairs)};
    std::vector<char> met_a(a.shell_names.size(), 0), met_b(b.shell_names.size(), 0);
    for (const auto& [i, j] : pairs) {
        out.insert(out.end(), {i, j - count_a, meeting_sides(corners_of(a, i), corners_of(b, j - count_a))});
        met_a[a.triangle_shell[i]] = 1;
        met_b[b.triangle_shell[j - count_a]] = 1;
    }
    const auto add_shells = [&](const Mesh& mesh, const std::vector<char>& met, const Mesh& other) {
        const Inside is_inside(other);
        std::vector<char> done(met);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto shell = static_cast<std::size_t>(mesh.triangle_shell[t]);
            if (done[shell]) continue;
            done[shell] = 1;
            out.push_back(is_inside(mesh.vertices.col(mesh.triangles[t][0])) ? 1 : 0);
        }
    };
    add_shells(a, met_a, b);
    add_shells(b, met_b, a);
    return out;
}

bool touch(const Mesh& a, const Mesh& b, double rounding) {
    const int count_a = count_of(a.triangles);
    std::vector<geometry::Box> boxes;
    for (const Mesh* mesh : {&a, &b})
        for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
            const TriangleCorners c = corners_of(*mesh, static_cast<int>(t));
            const Vector3 margin = Vector3::Constant(rounding);
            boxes.push_back({c[0].cwiseMin(c[1]).cwiseMin(c[2]) - margin, c[0].cwiseMax(c[1]).cwiseMax(c[2]) + margin});
        }
    bool found = false;
    geometry::visit_overlapping_pairs(boxes, [&](int i, int j) {
        if (i < count_a && j >= count_a) found = squared_distance(corners_of(a, i), corners_of(b, j - count_a)) <= rounding * rounding;
        return !found;
    });
    return found;
}

SolidCut shells_of(const Mesh& a, const Mesh& b, Combination combination) {
    SolidCut cut;
    const auto add = [&](const Mesh& mesh, const Mesh& other, bool of_a) {
        const Inside is_inside(other);
        std::map<int, bool> is_kept;
        std::map<int, int> index;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const int shell = mesh.triangle_shell[t];
            if (!is_kept.contains(shell)) {
                const bool inside = is_inside(mesh.vertices.col(mesh.triangles[t][0]));
                is_kept[shell] = inside == (combination == Combination::intersect || (combination == Combination::subtract && !of_a));
            }
            if (!is_kept[shell]) continue;
            CutTriangle out{{}, of_a, static_cast<int>(t)};
            for (std::size_t k = 0; k < 3; ++k) {
                const int v = mesh.triangles[t][k];
                const auto [place, is_new] = index.emplace(v, count_of(cut.vertices));
                if (is_new) cut.vertices.push_back({of_a ? VertexOrigin::Kind::vertex_of_a : VertexOrigin::Kind::vertex_of_b, v, v, 0});
                out.corners[k] = place->second;
            }
            if (combination == Combination::subtract && !of_a) std::swap(out.corners[1], out.corners[2]);
            cut.triangles.push_back(out);
        }
    };
    add(a, b, true);
    add(b, a, false);
    return cut;
}

}  // namespace fettle::core::parts
