// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/flat_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fettle/core/geometry/half_edges.hpp"

namespace fettle::core::geometry {
namespace {

// The corner of triangle `t` that is neither end of the edge; -1 if there is none.
int far_corner(const Triangle& t, const HalfEdge& edge) {
    for (const int v : t)
        if (v != edge.low && v != edge.high) return v;
    return -1;
}

// Of `far` from the plane of the edge and `other`; infinity where these are no plane, or both are on the same side of the edge.
double height_over(const Mesh& mesh, const HalfEdge& edge, int other, int far) {
    const Vector3 origin = mesh.vertices.col(edge.low);
    const Vector3 along = mesh.vertices.col(edge.high) - origin;
    const Vector3 u = mesh.vertices.col(other) - origin, v = mesh.vertices.col(far) - origin;
    const Vector3 normal = along.cross(u);
    const bool opposite = normal.dot(along.cross(v)) < 0;
    return opposite ? std::abs(v.dot(normal.normalized())) : std::numeric_limits<double>::infinity();
}

double bend_of(const Mesh& mesh, const std::vector<HalfEdge>& halves, std::size_t first, std::size_t last) {
    constexpr double bent = std::numeric_limits<double>::infinity();
    if (last - first != 2 || halves[first].low == halves[first].high) return bent;
    const int a = far_corner(mesh.triangles[static_cast<std::size_t>(halves[first].triangle)], halves[first]);
    const int b = far_corner(mesh.triangles[static_cast<std::size_t>(halves[first + 1].triangle)], halves[first]);
    if (a < 0 || b < 0) return bent;
    return std::max(height_over(mesh, halves[first], a, b), height_over(mesh, halves[first], b, a));
}

}  // namespace

FlatFeatures flat_features(const Mesh& mesh, double flatness) {
    FlatFeatures out;
    std::vector<std::pair<int, int>> flat;  // edges, sorted as the half edges are
    const std::vector<HalfEdge> halves = sorted_half_edges(mesh);
    visit_edges(halves, [&](std::size_t first, std::size_t last) {
        const double bend = bend_of(mesh, halves, first, last);
        if (!(bend <= flatness)) return;
        flat.emplace_back(halves[first].low, halves[first].high);
        out.height = std::max(out.height, bend);
    });
    if (flat.empty()) return out;
    const auto is_flat = [&flat](int a, int b) {
        return std::binary_search(flat.begin(), flat.end(), std::pair(std::min(a, b), std::max(a, b)));
    };
    std::vector<std::uint8_t> flat_vertex(static_cast<std::size_t>(mesh.vertices.cols()), 1);
    out.edge.resize(mesh.edges.size());
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        const auto [a, b] = mesh.edges[e];
        out.edge[e] = is_flat(a, b) ? 1 : 0;
        if (out.edge[e] == 0) flat_vertex[static_cast<std::size_t>(a)] = flat_vertex[static_cast<std::size_t>(b)] = 0;
    }
    out.face.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        unsigned bits = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            if (is_flat(a, b)) bits |= 1U << k;
            if (flat_vertex[static_cast<std::size_t>(a)] != 0) bits |= 8U << k;
        }
        out.face[t] = static_cast<std::uint8_t>(bits);
    }
    return out;
}

}  // namespace fettle::core::geometry
