// SPDX-License-Identifier: MIT
/// Distance of two elements (triangles, loose edges, loose points) of two bodies at one instant, with the two primitives that attain it.
/// Triangles that intersect, or that an edge pierces, are at distance 0 (up to rounding), which no pair of primitives shows.
#pragma once

#include "core/base/types.hpp"
#include "core/certificate/certificate.hpp"

namespace fettle::core::clearance {

using certificate::Primitive;

/// Corners of an element, one a column; those beyond `count` repeat the last, so that what holds for all columns holds for the element.
struct Corners {
    Matrix3 x = Matrix3::Zero();
    int count = 3;  ///< 3: triangle, 2: edge, 1: point
};

/// Which features: edge: corners (corner, corner + 1 mod 3); vertex: corner; triangle: all.
struct ElementPairDistance {
    double distance = 0;  ///< of the two points [m], as evaluated
    Vector3 point_a = Vector3::Zero();
    Vector3 point_b = Vector3::Zero();
    Vector3 difference = Vector3::Zero();  ///< point_a - point_b without the cancellation
    Primitive kind_a = Primitive::vertex, kind_b = Primitive::vertex;
    int corner_a = 0, corner_b = 0;
    double depth = 0;           ///< if intersecting: by how much corners may be off without undoing it; 0: a matter of rounding [m]
    bool intersecting = false;  ///< an edge of one passes through the other, or touches it; the features are then those next to the point
};

/// `a`, `b` in one frame. Degenerate triangles are the segments or points that they are.
/// @param before  of the same elements elsewhere, or null: its features are looked at first, and where the plane across them keeps the
///                elements apart, they alone. If features tie, the ones examined first are returned.
ElementPairDistance element_pair_distance(const Corners& a, const Corners& b, const ElementPairDistance* before = nullptr);

}  // namespace fettle::core::clearance
