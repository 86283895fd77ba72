// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/triangle_pair.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <optional>

#include "fettle/core/geometry/distance.hpp"

namespace fettle::core::clearance {
namespace {

struct Piercing {
    Vector3 on_edge, on_triangle;
    int corner = 0;  // the edge's end next to the triangle
};

// Where edge k of `edges` passes through the triangle's plane, moved into the triangle by clamping: both points belong to their
// pieces whatever rounding did, so their distance is an honest upper bound.
std::optional<Piercing> piercing(const Matrix3& edges, int k, const Matrix3& triangle) {
    const Vector3 p = edges.col(k), q = edges.col((k + 1) % 3);
    const Vector3 u = triangle.col(1) - triangle.col(0), v = triangle.col(2) - triangle.col(0);
    const Vector3 normal = u.cross(v);
    const double hp = normal.dot(p - triangle.col(0)), hq = normal.dot(q - triangle.col(0));
    const double squared = normal.squaredNorm();
    if (!(squared > 0) || hp * hq > 0 || hp == hq) return std::nullopt;
    const double s = hp / (hp - hq);
    Piercing result;
    result.on_edge = p + s * (q - p);
    result.corner = s < 0.5 ? k : (k + 1) % 3;
    const Vector3 w = result.on_edge - triangle.col(0);
    Vector3 weight;
    weight[1] = w.cross(v).dot(normal) / squared;
    weight[2] = u.cross(w).dot(normal) / squared;
    weight[0] = 1 - weight[1] - weight[2];
    weight = weight.cwiseMax(0);
    weight /= weight.sum();
    result.on_triangle = triangle * weight;
    return result;
}

// Separation of the triangles along the candidate's direction: its distance if they are disjoint, far from it if one pierces the other.
bool separates(const TrianglePairDistance& candidate, const Matrix3& a, const Matrix3& b) {
    if (!(candidate.distance > 0)) return true;
    const Vector3 n = candidate.difference / candidate.distance;
    return (n.transpose() * a).minCoeff() - (n.transpose() * b).maxCoeff() > 0.5 * candidate.distance;
}

void look_for_piercing(const Matrix3& a, const Matrix3& b, TrianglePairDistance& best) {
    for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < 3; ++k) {
            const std::optional<Piercing> found = side == 0 ? piercing(a, k, b) : piercing(b, k, a);
            if (!found) continue;
            const double distance = (found->on_edge - found->on_triangle).norm();
            if (distance >= best.distance) continue;
            best.distance = distance;
            best.intersecting = true;
            best.edge_edge = false;
            best.vertex_on_a = side == 0;
            (side == 0 ? best.corner_a : best.corner_b) = found->corner;
            best.point_a = side == 0 ? found->on_edge : found->on_triangle;
            best.point_b = side == 0 ? found->on_triangle : found->on_edge;
            best.difference = best.point_a - best.point_b;
        }
    }
}

}  // namespace

TrianglePairDistance triangle_pair_distance(const Matrix3& a, const Matrix3& b) {
    TrianglePairDistance best;
    geometry::ClosestPoints closest;
    closest.distance_squared = std::numeric_limits<double>::infinity();
    const auto take = [&](const geometry::ClosestPoints& c, bool edge_edge, bool vertex_on_a, int i, int j) {
        if (!(c.distance_squared < closest.distance_squared)) return;
        closest = c;
        best.edge_edge = edge_edge;
        best.vertex_on_a = vertex_on_a;
        best.corner_a = i;
        best.corner_b = j;
    };
    for (int i = 0; i < 3; ++i) {
        take(geometry::point_triangle_closest(a.col(i), b.col(0), b.col(1), b.col(2)), false, true, i, 0);
        take(geometry::point_triangle_closest(b.col(i), a.col(0), a.col(1), a.col(2)), false, false, 0, i);
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            take(geometry::edge_edge_closest(a.col(i), a.col((i + 1) % 3), b.col(j), b.col((j + 1) % 3)), true, false, i, j);
    const auto& w = closest.weight;
    best.difference = closest.difference;
    best.distance = closest.difference.norm();
    if (best.edge_edge) {
        best.point_a = w[0] * a.col(best.corner_a) + w[1] * a.col((best.corner_a + 1) % 3);
        best.point_b = -w[2] * b.col(best.corner_b) - w[3] * b.col((best.corner_b + 1) % 3);
    } else if (best.vertex_on_a) {
        best.point_a = a.col(best.corner_a);
        best.point_b = -(b * Vector3(w[1], w[2], w[3]));
    } else {
        best.point_b = b.col(best.corner_b);
        best.point_a = -(a * Vector3(w[1], w[2], w[3]));
        best.difference = -best.difference;
    }
    if (!separates(best, a, b)) look_for_piercing(a, b, best);
    return best;
}

}  // namespace fettle::core::clearance
