// SPDX-License-Identifier: MIT
/// Closest points and squared distances of point-triangle and edge-edge pairs. The distance's derivatives are built from the
/// weights (contact/contact_stencil.hpp): by the envelope theorem d(D)/dx_i = 2 w_i r.
#pragma once

#include <array>

#include "fettle/core/base/types.hpp"

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

/// Robust for degenerate (zero-area, zero-length, parallel) input: always the true closest points up to rounding.
ClosestPoints point_triangle_closest(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2);
ClosestPoints edge_edge_closest(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1);

inline double point_triangle_distance_squared(const Vector3& p, const Vector3& t0, const Vector3& t1, const Vector3& t2) {
    return point_triangle_closest(p, t0, t1, t2).distance_squared;
}
inline double edge_edge_distance_squared(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    return edge_edge_closest(ea0, ea1, eb0, eb1).distance_squared;
}

}  // namespace fettle::core::geometry
