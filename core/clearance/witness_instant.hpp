// SPDX-License-Identifier: MIT
/// Where along a segment two triangles are closest, to rounding: makes the witness of a certificate exact in time. Proves nothing.
#pragma once

#include "fettle/core/clearance/segment_bound.hpp"
#include "fettle/core/clearance/triangle_pair.hpp"

namespace fettle::core::clearance {

/// Distance of two triangles (corners in their bodies' frames) at an instant; points relative to body b's reference point.
TrianglePairDistance placed_distance(const Instant& at, const Matrix3& corners_a, const Matrix3& corners_b);

/// Its derivative in s: n.(velocity of a's closest point - that of b's), n from b to a. Zero at distance 0.
double distance_rate(const PairSegment& segment, const Matrix3& corners_a, const Matrix3& corners_b, double s);

/// The local minimum of the distance next to `s`, by bisection of its derivative, in [0, 1]: an end, or a place where the rate changes
/// sign.
double least_distance_near(const PairSegment& segment, const Matrix3& corners_a, const Matrix3& corners_b, double s);

}  // namespace fettle::core::clearance
