// SPDX-License-Identifier: MIT
#include "core/solids/overlap_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/half_edges.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::solids {
namespace {

constexpr std::size_t most_patches = 200;    // each costs a look at every triangle
constexpr std::size_t most_clusters = 1000;  // joined pairwise

struct Cluster {
    geometry::Box box;
    int triangles = 1;
};

std::vector<bool> involved(const geometry::Mesh& mesh, const std::vector<std::pair<int, int>>& pairs) {
    std::vector<bool> out(mesh.triangles.size(), false);
    for (const auto& [t, u] : pairs) out[t] = out[u] = true;
    return out;
}

struct Patches {
    std::vector<std::size_t> of;       ///< per triangle: its patch
    std::vector<std::size_t> largest;  ///< per patch: its largest triangle; the number of triangles if there is none with an area
};

/// Triangles of no pair, joined over edges that two of them share.
Patches patches_of(const geometry::Mesh& mesh, const std::vector<bool>& crossed) {
    std::vector<int> parent(mesh.triangles.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    };
    const std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        // Over an edge of more than two triangles the sides need not be the same.
        if (last - first != 2) return;
        const int a = halves[first].triangle, b = halves[last - 1].triangle;
        if (!crossed[a] && !crossed[b]) parent[root(a)] = root(b);
    });
    std::vector<double> areas(mesh.triangles.size(), 0);
    Patches patches{std::vector<std::size_t>(mesh.triangles.size(), 0),
                    std::vector<std::size_t>(mesh.triangles.size(), mesh.triangles.size())};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const geometry::Triangle& v = mesh.triangles[t];
        const Vector3 a = mesh.vertices.col(v[0]), b = mesh.vertices.col(v[1]), c = mesh.vertices.col(v[2]);
        const auto patch = patches.of[t] = static_cast<std::size_t>(root(static_cast<int>(t)));
        const double area = (b - a).cross(c - a).norm();
        if (crossed[t] || area <= areas[patch]) continue;
        areas[patch] = area;
        patches.largest[patch] = t;
    }
    return patches;
}

/// Is one side of the triangle outside (wound 0 times) and the other, inner one inside (1)?
bool has_plain_sides(const geometry::Mesh& mesh, std::size_t triangle) {
    // Along x the ray must cross the triangle: the axes are permuted so that x is the largest component of its normal.
    const geometry::Triangle& v = mesh.triangles[triangle];
    const Vector3 normal = (mesh.vertices.col(v[1]) - mesh.vertices.col(v[0])).cross(mesh.vertices.col(v[2]) - mesh.vertices.col(v[0]));
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const std::array<Eigen::Index, 3> order{axis, (axis + 1) % 3, (axis + 2) % 3};
    const Matrix3X vertices = mesh.vertices(order, Eigen::all);
    std::vector<geometry::Triangle> others = mesh.triangles;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(triangle));
    const Vector3 centre = (vertices.col(v[0]) + vertices.col(v[1]) + vertices.col(v[2])) / 3;
    // Without the triangle itself: what the side has from which the ray leaves. Towards +x that is outside if the normal points there.
    const auto winding = winding_number(centre, vertices, others);
    return winding && *winding == (normal[axis] > 0 ? 0 : 1);
}

/// Boxes of the triangles, joined until no two overlap.
std::vector<Cluster> clusters_of(const geometry::Mesh& mesh, const std::vector<bool>& crossed) {
    std::vector<Cluster> clusters;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!crossed[t]) continue;
        const Matrix3 x = mesh.vertices(Eigen::all, mesh.triangles[t]);
        Cluster fresh{{x.rowwise().minCoeff(), x.rowwise().maxCoeff()}, 1};
        if (clusters.size() >= most_clusters) return {};
        for (std::size_t i = 0; i < clusters.size();) {
            if (!clusters[i].box.overlaps(fresh.box)) {
                ++i;
                continue;
            }
            fresh.box = {fresh.box.low.cwiseMin(clusters[i].box.low), fresh.box.high.cwiseMax(clusters[i].box.high)};
            fresh.triangles += clusters[i].triangles;
            clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(i));
            i = 0;  // the larger box may overlap an earlier one
        }
        clusters.push_back(fresh);
    }
    return clusters;
}

std::optional<double> all_but_largest_shell(const geometry::Mesh& mesh, const std::vector<std::pair<int, int>>& pairs) {
    for (const auto& [t, u] : pairs) {
        if (mesh.triangle_shell[t] == mesh.triangle_shell[u]) return std::nullopt;
    }
    std::vector<std::vector<geometry::Triangle>> shells(mesh.shell_names.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) shells[mesh.triangle_shell[t]].push_back(mesh.triangles[t]);
    double sum = 0, largest = 0;
    for (const auto& shell : shells) {
        geometry::Mesh alone;
        alone.triangles = shell;
        if (!bounds_a_solid(alone)) return std::nullopt;
        const double volume = std::abs(geometry::solid_moments(mesh.vertices, shell)(3, 3));
        sum += volume;
        largest = std::max(largest, volume);
    }
    return sum - largest;
}

}  // namespace

std::optional<double> overlap_volume_bound(const geometry::Mesh& mesh, const std::vector<std::pair<int, int>>& pairs) {
    if (pairs.empty()) return 0;
    std::vector<bool> doubtful = involved(mesh, pairs);
    const Patches patches = patches_of(mesh, doubtful);
    std::size_t looked_at = 0;
    for (std::size_t patch = 0; patch < patches.largest.size(); ++patch) {
        const std::size_t t = patches.largest[patch];
        if (t == mesh.triangles.size()) continue;
        if (++looked_at <= most_patches && has_plain_sides(mesh, t)) continue;
        for (std::size_t other = 0; other < patches.of.size(); ++other)
            if (patches.of[other] == patch) doubtful[other] = true;
    }
    const std::vector<Cluster> clusters = clusters_of(mesh, doubtful);
    if (clusters.empty()) return all_but_largest_shell(mesh, pairs);
    double bound = 0;
    for (const Cluster& cluster : clusters) bound += (cluster.box.high - cluster.box.low).prod() * cluster.triangles;
    const std::optional<double> by_shells = all_but_largest_shell(mesh, pairs);
    return by_shells ? std::min(bound, *by_shells) : bound;
}

}  // namespace fettle::core::solids
