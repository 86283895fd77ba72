// SPDX-License-Identifier: MIT
/// Closest points and squared distances of point-triangle and edge-edge pairs. The distance's derivatives are built from the
/// weights (contact/contact_pair.hpp): by the envelope theorem d(D)/dx_i = 2 w_i r.
///
/// Accuracy: with L the largest distance of two of the four vertices, 1e-40 <= L <= 1e40, and u = 2^-53,
///   |sqrt(distance_squared) - true distance| <= 64 u L,
/// whatever the pair: parallel, collinear, coplanar, slivers, of no length or area. The worst of the tests' campaigns is 4 u L. The bound
/// is relative to L, not to the distance: what is computed is no proven bound of anything (ccd/separating_plane.hpp has those).
///
/// Why, with a and b the two directions of the pair's plane, theta their angle and h the distance of their lines (or of point and plane):
///  - Differences of vertices are off by u each, which moves the vertices by 3 u L in all. Convex weights of either sign sum to 1 within u,
///    so that |r| is that of two points of the primitives within 11 u L: it is too small by no more, and too large only where the
///    weights are not the best.
///  - Vertex against vertex, d apart, where all edges from there lead away: decided by the signs of products e . d that are off by
///    4 u |e| |d|. A wrong one adds at most 4 u L for each edge: the distance is convex, and falls along it by no more than 4 u of the way.
///  - Vertex against edge: the weights put the point off its best place by 4 u L. Only those edges round the plane's inside are
///    examined that part it from the optimum over the whole plane, where that is sure (sin theta >= 1e-3, differences within 1e4 of one
///    another): the true optimum is in one of them, the others are no nearer.
///  - Inside, by cross products: off by at most 24 u L / sin theta within the plane (+ 3 u h / sin theta). Right-angled to r that adds its
///    square over the distance, less than u L if distance sin^2 theta >= 1024 u L: then it is taken as it is.
///  - Else cross products to 2 units in the last place (Kahan) leave 6 u (L + h / sin theta), which adds at most
///    min(36 u^2 (L + h / sin theta)^2 / h, 6 u (L + h / sin theta)), and the best of the boundary stands beside it, which
///    adds at most min((L sin theta)^2 / (2 h), L sin theta), as from any place within to the boundary is at most L sin theta in the
///    direction that opens. The lesser of the two is at most 12 u L for all h and theta. Below sin theta = 8 u the boundary alone is.
///
/// Direction: the weights alone leave 11 u L of rounding in r, of which a part lies in the pair's plane (or along its edge): at a gap of
/// 1e-9 L that would turn a contact's force by 1e-6. It is taken out: r is what remains along the plane's normal u x v if h <= L sin theta,
/// and normal to the edge where one is met. The normal is off by 4 u / sin theta, which changes the length by less than u L. So r is off by
/// an angle of 4 u / sin theta there, and by 4 u L / h on an edge, about the edge alone.
#pragma once

#include <array>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

/// Closest points of a pair of four vertices x: r = sum_i weight[i] x_i points from the second primitive's closest point to the first's.
/// point-triangle (p t0 t1 t2): weight = (1, -b0, -b1, -b2). edge-edge (ea0 ea1 eb0 eb1): weight = (1-s, s, -(1-t), -t).
struct ClosestPoints {
    std::array<double, 4> weight{};
    int free_count = 0;                                  ///< parameters in the interior: 0, 1 or 2 (point, edge, face or two edges)
    std::array<std::array<double, 4>, 2> free_weight{};  ///< d weight / d parameter, one per interior parameter
    Vector3 difference = Vector3::Zero();                ///< r [m]
    double distance_squared = 0;                         ///< |r|^2 [m^2]
};

/// Closest within the bound above; what is not finite gives a distance that is not. The last bits depend on the vertices' order.
ClosestPoints point_triangle_closest(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2);
ClosestPoints edge_edge_closest(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1);

inline double point_triangle_distance_squared(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2) {
    return point_triangle_closest(p, t0, t1, t2).distance_squared;
}
inline double edge_edge_distance_squared(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    return edge_edge_closest(ea0, ea1, eb0, eb1).distance_squared;
}

}  // namespace fettle::core::geometry
