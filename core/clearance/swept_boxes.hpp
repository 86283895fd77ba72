// SPDX-License-Identifier: MIT
/// Boxes that hold whole bodies during some segments of their path, before any of their elements is looked at.
///
/// In a segment a point is at x(s) = R(s) X + q(s), q linear, and
///   |x(s) - ((1 - s) x(0) + s x(1))| <= |w|^2 |base X| / 8,   w = rotation_vector_step   (interpolation; |R''| <= |w|^2)
/// and at most 2 |base X|. So the boxes at both ends of all its segments, grown by that with the body's largest |X|, hold the body
/// throughout: center R c + q, half extents |R| h, of the box (c, h) of the mesh in the body's frame.
/// For a segment that turns little the box at its middle is as good, and cheaper: |x(s) - (base X + q(1/2))| <= |theta| |base X| with the
/// largest |theta| <= |theta_0| + |w|, and half of q's step along each axis. These are found for four bodies at a time.
/// Bases may be rotations up to rounding only: |base X| <= sqrt(1 + |base^T base - I|) |X|.
/// Rounding: 64u of the size of positions and (64 + 48|theta|)u of the radius, as segment_bound.hpp has it, twice.
#pragma once

#include <span>
#include <vector>

#include "core/clearance/body_motions.hpp"
#include "core/geometry/box_sweep.hpp"

namespace fettle::core::clearance {

/// The box of a mesh, in its body's frame.
struct BodyBox {
    Vector3 center = Vector3::Zero(), half = Vector3::Zero();
    double size = 0;    ///< from the center to a corner
    double radius = 0;  ///< of the mesh, about the body's reference point
};
BodyBox box_of(const geometry::Mesh& mesh);

/// Bodies [first, last), at these places one after another. Those whose numbers are of no use (have_usable_numbers) get boxes of no use.
struct BodyRange {
    const stepper::Trajectory& trajectory;
    std::span<const PathPlace> places;
    int first = 0, last = 0;
};

/// The swept boxes of the bodies of the range.
/// @param boxes  of all bodies
/// @param out    of the first of the range and those after it
void sweep(const BodyRange& range, const std::vector<BodyBox>& boxes, geometry::Box* out);
/// How far points of the bodies go, about: the sum of |q_step| + radius |w|.
void measure_ways(const BodyRange& range, const std::vector<BodyBox>& boxes, double* out);

}  // namespace fettle::core::clearance
