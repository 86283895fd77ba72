// SPDX-License-Identifier: MIT
/// How much nearer two bodies' points can be than they were, in metres: upper bounds, rounding of the formulas included. Points of a body
/// lie within its radius of its reference point.
#pragma once

#include <array>

#include "core/kinematics/path.hpp"

namespace fettle::core::ccd {

/// Along their segments.
double most_relative_motion(const kinematics::PathSegment& a, const kinematics::PathSegment& b, double radius_a, double radius_b);

/// Between two pairs of poses. Distances of points do not change when both bodies move alike: the least of what is seen from the world and
/// from each body.
double most_relative_motion(const kinematics::Pose& a1, const kinematics::Pose& b1, const kinematics::Pose& a2, const kinematics::Pose& b2,
                            double radius_a, double radius_b);

/// Distances are taken at rounded vertices: what two poses add.
double rounding_of(const kinematics::Pose& a, const kinematics::Pose& b, double radius_a, double radius_b);

/// Anywhere on the segments a and b, from somewhere along `from`; infinite if they are not in its chart (have another base).
double deviation_in_chart(const std::array<kinematics::PathSegment, 2>& from, const kinematics::PathSegment& a,
                          const kinematics::PathSegment& b, double radius_a, double radius_b);

/// The same whatever the charts (docs/method/collision.md#broad-phase): each end is held against the place on `from` that is about nearest.
double deviation_in_space(const std::array<kinematics::PathSegment, 2>& from, const kinematics::PathSegment& a,
                          const kinematics::PathSegment& b, double radius_a, double radius_b);

}  // namespace fettle::core::ccd
