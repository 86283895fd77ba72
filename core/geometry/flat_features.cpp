// SPDX-License-Identifier: MIT
#include "core/geometry/flat_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/rounding.hpp"
#include "core/geometry/half_edges.hpp"

namespace fettle::core::geometry {
namespace {

// The corner of triangle `t` that is neither end of the edge; -1 if there is none.
int far_corner(const Triangle& t, const HalfEdge& edge) {
    for (const int v : t)
        if (v != edge.low && v != edge.high) return v;
    return -1;
}

// Twice the area times the normal.
Vector3 area_vector(const Mesh& mesh, std::size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vector3 origin = mesh.vertices.col(t[0]);
    return (mesh.vertices.col(t[1]) - origin).cross(mesh.vertices.col(t[2]) - origin);
}

// Two triangles and nothing else at an edge, one on each side of it.
struct Hinge {
    std::size_t edge;  // first of its half edges
    std::array<int, 2> triangle, far;
};

// Facets: triangles joined over hinges, all within `flatness` of the plane of the one that they grow from.
class Facets {
public:
    Facets(const Mesh& mesh, const std::vector<HalfEdge>& halves, double flatness) : mesh_(mesh), flatness_(flatness) {
        hinges_of_.assign(mesh.triangles.size(), {-1, -1, -1});
        hinges_.reserve(halves.size() / 2);
        visit_edges(halves, [&](std::size_t first, std::size_t last) { add_hinge(halves, first, last); });
        facet_.assign(mesh.triangles.size(), -1);
        on_plane_.assign(mesh.triangles.size(), 0);
        size_ = mesh.vertices.size() > 0 ? mesh.vertices.colwise().norm().maxCoeff() : 0;
        for (const int seed : by_area()) grow(seed);
    }

    // Calls visit(first half edge, is plane) for each edge within a facet, in their order.
    template <class Visit>
    void visit_flat_edges(const Visit& visit) const {
        for (const Hinge& hinge : hinges_)
            if (facet_[at(hinge.triangle[0])] == facet_[at(hinge.triangle[1])])
                visit(hinge.edge, on_plane_[at(hinge.triangle[0])] != 0 && on_plane_[at(hinge.triangle[1])] != 0);
    }

    double height() const { return height_; }
    double plane_height() const { return plane_height_ + rounding(); }

private:
    static std::size_t at(int k) { return static_cast<std::size_t>(k); }

    void add_hinge(const std::vector<HalfEdge>& halves, std::size_t first, std::size_t last) {
        const HalfEdge& edge = halves[first];
        if (last - first != 2 || edge.low == edge.high) return;
        const std::array<int, 2> triangle{edge.triangle, halves[first + 1].triangle};
        const std::array<int, 2> far{far_corner(mesh_.triangles[at(triangle[0])], edge),
                                     far_corner(mesh_.triangles[at(triangle[1])], edge)};
        if (far[0] < 0 || far[1] < 0) return;
        const Vector3 origin = mesh_.vertices.col(edge.low), along = mesh_.vertices.col(edge.high) - origin;
        const auto side = [&](int v) { return Vector3(along.cross(mesh_.vertices.col(v) - origin)); };
        if (!(side(far[0]).dot(side(far[1])) < 0)) return;
        for (const int t : triangle) *std::find(hinges_of_[at(t)].begin(), hinges_of_[at(t)].end(), -1) = count_of(hinges_);
        hinges_.push_back({first, triangle, far});
    }

    // The largest first: their planes are the best known.
    std::vector<int> by_area() const {
        std::vector<std::pair<double, int>> order;
        order.reserve(mesh_.triangles.size());
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
            order.emplace_back(-area_vector(mesh_, t).squaredNorm(), static_cast<int>(t));
        std::sort(order.begin(), order.end());
        std::vector<int> triangles;
        for (const auto& [area, t] : order) triangles.push_back(t);
        return triangles;
    }

    // The rounding of distances from planes.
    double rounding() const { return 16 * base::unit_roundoff * size_; }

    // Is the triangle on the plane, and wide enough to lie along it, not across?
    void mark_on_plane(int t, const Vector3& normal, const Vector3& origin) {
        constexpr double wide = 100;  // a triangle on the plane is tilted by no more than a fiftieth
        double height = 0, longest = 0;
        for (int k = 0; k < 3; ++k) {
            const auto x = mesh_.vertices.col(mesh_.triangles[at(t)][at(k)]),
                       y = mesh_.vertices.col(mesh_.triangles[at(t)][at((k + 1) % 3)]);
            height = std::max(height, std::abs(normal.dot(x - origin)));
            longest = std::max(longest, (y - x).norm());
        }
        const double limit = plane * flatness_ + rounding();
        if (!(height <= limit) || !(area_vector(mesh_, at(t)).norm() >= wide * limit * longest)) return;
        on_plane_[at(t)] = 1;
        plane_height_ = std::max(plane_height_, height);
    }

    void grow(int seed) {
        if (facet_[at(seed)] >= 0) return;
        facet_[at(seed)] = seed;
        const Vector3 normal = area_vector(mesh_, at(seed)).normalized();
        const Vector3 origin = mesh_.vertices.col(mesh_.triangles[at(seed)][0]);
        mark_on_plane(seed, normal, origin);
        open_.assign(1, seed);
        while (!open_.empty()) {
            const int t = open_.back();
            open_.pop_back();
            for (const int k : hinges_of_[at(t)]) {
                if (k < 0) break;
                const Hinge& hinge = hinges_[at(k)];
                const int side = hinge.triangle[0] == t ? 1 : 0;
                const double height = std::abs(normal.dot(mesh_.vertices.col(hinge.far[at(side)]) - origin));
                if (facet_[at(hinge.triangle[at(side)])] >= 0 || !(height <= flatness_)) continue;
                facet_[at(hinge.triangle[at(side)])] = seed;
                height_ = std::max(height_, height);
                mark_on_plane(hinge.triangle[at(side)], normal, origin);
                open_.push_back(hinge.triangle[at(side)]);
            }
        }
    }

    const Mesh& mesh_;
    double flatness_, height_ = 0, plane_height_ = 0, size_ = 0;
    std::vector<Hinge> hinges_;
    std::vector<std::array<int, 3>> hinges_of_;  // [triangle]; -1: no more
    std::vector<int> facet_;                     // [triangle] the one it has grown from; -1: none yet
    std::vector<std::uint8_t> on_plane_;         // [triangle] 1: it lies on the plane of its facet
    std::vector<int> open_;                      // triangles of the facet that grows, whose hinges are still to be crossed
};

}  // namespace

FlatFeatures flat_features(const Mesh& mesh, double flatness) {
    FlatFeatures out;
    std::vector<std::pair<int, int>> flat, plane_edges;  // sorted as the half edges are
    const std::vector<HalfEdge> halves = sorted_half_edges(mesh);
    const Facets facets(mesh, halves, flatness);
    facets.visit_flat_edges([&](std::size_t first, bool is_plane) {
        flat.emplace_back(halves[first].low, halves[first].high);
        if (is_plane) plane_edges.push_back(flat.back());
    });
    if (flat.empty()) return out;
    out.height = facets.height();
    out.plane_height = facets.plane_height();
    const auto is_in = [](const std::vector<std::pair<int, int>>& edges, int a, int b) {
        return std::binary_search(edges.begin(), edges.end(), std::pair(std::min(a, b), std::max(a, b)));
    };
    const auto is_flat = [&](int a, int b) { return is_in(flat, a, b); };
    std::vector<std::uint8_t> flat_vertex(mesh.vertices.cols(), 1);
    out.edge.resize(mesh.edges.size());
    out.plane_edge.resize(mesh.edges.size());
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        const auto [a, b] = mesh.edges[e];
        out.edge[e] = is_flat(a, b) ? 1 : 0;
        out.plane_edge[e] = is_in(plane_edges, a, b) ? 1 : 0;
        if (out.edge[e] == 0) flat_vertex[a] = flat_vertex[b] = 0;
    }
    out.face.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        unsigned bits = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            if (is_flat(a, b)) bits |= 1U << k;
            if (flat_vertex[a] != 0) bits |= 8U << k;
        }
        out.face[t] = static_cast<std::uint8_t>(bits);
    }
    return out;
}

}  // namespace fettle::core::geometry
