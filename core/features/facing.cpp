// SPDX-License-Identifier: MIT
#include "core/features/facing.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

namespace fettle::core::features {

namespace {

using Vector2 = Eigen::Vector2d;
using Flat = std::array<Vector2, 3>;  // a triangle in the plane, counter-clockwise

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector3 outward(const geometry::Mesh& mesh, const Feature& plane) {
    Vector3 area = Vector3::Zero();
    for (const int t : plane.triangles) {
        const auto& corner = mesh.triangles[t];
        const Vector3 p = mesh.vertices.col(corner[0]);
        area += (mesh.vertices.col(corner[1]) - p).cross(mesh.vertices.col(corner[2]) - p);
    }
    return area.dot(plane.surface.axis) < 0 ? Vector3(-plane.surface.axis) : plane.surface.axis;
}

std::vector<Flat> seen_along(const geometry::Mesh& mesh, const Feature& plane, const Across& across) {
    std::vector<Flat> out;
    for (const int t : plane.triangles) {
        Flat flat;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 x = mesh.vertices.col(mesh.triangles[t][k]);
            flat[k] = {across.u.dot(x), across.v.dot(x)};
        }
        if (cross(flat[1] - flat[0], flat[2] - flat[0]) < 0) std::swap(flat[1], flat[2]);
        out.push_back(flat);
    }
    return out;
}

// Is all of b on the outer side of one of a's edges?
bool parted_by_edge(const Flat& a, const Flat& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector2 &from = a[k], along = a[(k + 1) % 3] - from;
        if (std::all_of(b.begin(), b.end(), [&](const Vector2& x) { return cross(along, x - from) <= 0; })) return true;
    }
    return false;
}

bool overlap(const std::vector<Flat>& a, const std::vector<Flat>& b) {
    return std::any_of(a.begin(), a.end(), [&](const Flat& x) {
        return std::any_of(b.begin(), b.end(), [&](const Flat& y) { return !parted_by_edge(x, y) && !parted_by_edge(y, x); });
    });
}

bool is_plane(const Feature& feature) { return feature.surface.kind == SurfaceKind::plane && !feature.triangles.empty(); }

}  // namespace

std::vector<Facing> facing_planes(const geometry::Mesh& mesh_a, const Features& a, const geometry::Mesh& mesh_b, const Features& b,
                                  double most) {
    constexpr double degree = 0.01745;
    std::vector<Facing> out;
    const double tolerance = 2 * std::max(a.tolerance, b.tolerance);
    for (int f = 0; f < count_of(a.features); ++f) {
        const Feature& of_a = a.features[f];
        if (!is_plane(of_a)) continue;
        const Vector3 n = outward(mesh_a, of_a);
        std::vector<Flat> seen;
        for (int g = 0; g < count_of(b.features); ++g) {
            const Feature& of_b = b.features[g];
            if (!is_plane(of_b) || of_b.surface.axis.cross(n).norm() > degree || outward(mesh_b, of_b).dot(n) > 0) continue;
            const double gap = n.dot(of_b.centre - of_a.centre);
            if (gap > most || gap < -tolerance) continue;
            const Across across = across_of(n);
            if (seen.empty()) seen = seen_along(mesh_a, of_a, across);
            if (overlap(seen, seen_along(mesh_b, of_b, across))) out.push_back({f, g, n, gap});
        }
    }
    return out;
}

}  // namespace fettle::core::features
