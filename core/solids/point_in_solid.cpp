// SPDX-License-Identifier: MIT
#include "core/solids/point_in_solid.hpp"

#include <array>

#include "core/base/contract.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"

namespace fettle::core::solids {
namespace {

using Corners = std::array<Vector3, 3>;

/// Sign of orient2d(a, b, p') with p' = p + (epsilon, epsilon^2) for every small enough epsilon > 0: never 0 unless a = b.
int orient2d_perturbed(const Vector2& a, const Vector2& b, const Vector2& p) {
    const int sign = geometry::orient2d(a, b, p);
    if (sign != 0) return sign;
    if (a.y() != b.y()) return b.y() < a.y() ? 1 : -1;
    return (b.x() > a.x()) - (b.x() < a.x());
}

}  // namespace

std::optional<int> winding_number(const Vector3& point, const Matrix3X& vertices, const std::vector<geometry::Triangle>& triangles) {
    // Ray in direction +x, moved by (epsilon, epsilon^2) in y and z so that it meets no edge and no vertex. A point in the plane of a
    // triangle that the moved ray crosses is on the triangle (it is in its closed projection), which the first test has excluded.
    const Vector2 p = geometry::projected(point, 0);
    int winding = 0;
    for (const geometry::Triangle& triangle : triangles) {
        const Corners x{vertices.col(triangle[0]), vertices.col(triangle[1]), vertices.col(triangle[2])};
        const geometry::Box box{x[0].cwiseMin(x[1]).cwiseMin(x[2]), x[0].cwiseMax(x[1]).cwiseMax(x[2])};
        const bool in_projection = (box.low.tail<2>().array() <= p.array()).all() && (p.array() <= box.high.tail<2>().array()).all();
        if (!in_projection || box.high.x() < point.x()) continue;
        if (box.contains(point) && geometry::segment_intersects_triangle(point, point, x)) return std::nullopt;
        const Vector2 a = geometry::projected(x[0], 0), b = geometry::projected(x[1], 0), c = geometry::projected(x[2], 0);
        const int side = orient2d_perturbed(a, b, p);
        if (side == 0 || orient2d_perturbed(b, c, p) != side || orient2d_perturbed(c, a, p) != side) continue;
        // Crossed; ahead if the point is on the side from which the +x direction goes through the plane. Seen from +x a triangle that is
        // counter-clockwise (side 1) is where the ray leaves.
        if (geometry::orient3d(x[0], x[1], x[2], point) == -side) winding += side;
    }
    return winding;
}

bool point_in_solid(const Vector3& point, const Matrix3X& vertices, const std::vector<geometry::Triangle>& triangles) {
    return winding_number(point, vertices, triangles).value_or(0) != 0;
}

std::vector<int> samples_of(const geometry::Mesh& mesh) {
    FETTLE_ASSERT(mesh.triangle_shell.size() >= mesh.triangles.size(), "samples need a mesh with connectivity (build_connectivity)");
    std::vector<int> out = mesh.codimensional_points;
    std::vector<bool> seen(mesh.shell_names.size(), false), on_triangle(static_cast<std::size_t>(mesh.vertices.cols()), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const int v : mesh.triangles[t]) on_triangle[v] = true;
        const auto shell = static_cast<std::size_t>(mesh.triangle_shell[t]);
        if (!seen[shell]) out.push_back(mesh.triangles[t][0]);
        seen[shell] = true;
    }
    for (const geometry::Edge& edge : mesh.edges)
        if (!on_triangle[edge[0]]) out.push_back(edge[0]);
    return out;
}

bool bounds_a_solid(const geometry::Mesh& mesh) { return bounds_a_solid(geometry::sorted_half_edges(mesh)); }

bool bounds_a_solid(const std::vector<geometry::HalfEdge>& halves) {
    bool balanced = !halves.empty();
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        int balance = 0;
        for (std::size_t i = first; i < last; ++i) balance += halves[i].forward ? 1 : -1;
        balanced = balanced && (balance == 0 || halves[first].low == halves[first].high);
    });
    return balanced;
}

}  // namespace fettle::core::solids
