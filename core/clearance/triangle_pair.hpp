// SPDX-License-Identifier: MIT
/// Distance of two triangles of two bodies at one instant, with the two primitives that attain it. Triangles that intersect are at
/// distance 0 (up to rounding), which no vertex-triangle or edge-edge pair shows.
#pragma once

#include <array>

#include "fettle/core/base/types.hpp"

namespace fettle::core::clearance {

/// Which features: edge_edge: corners (corner_a, corner_a + 1 mod 3) against the same of b; else corner `corner` of the triangle
/// that `vertex_on_a` tells against the whole other triangle.
struct TrianglePairDistance {
    double distance = 0;  ///< of the two points [m], as evaluated
    Vector3 point_a = Vector3::Zero();
    Vector3 point_b = Vector3::Zero();
    Vector3 difference = Vector3::Zero();  ///< point_a - point_b without the cancellation
    bool edge_edge = false;
    bool vertex_on_a = true;
    int corner_a = 0, corner_b = 0;
    bool intersecting = false;  ///< an edge of one passes through the other; the features are then those next to the point
};

/// `a`, `b`: corners, one a column, in one frame.
TrianglePairDistance triangle_pair_distance(const Matrix3& a, const Matrix3& b);

}  // namespace fettle::core::clearance
