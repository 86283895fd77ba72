// SPDX-License-Identifier: MIT
/// Which bodies come near each other, and when: proven by boxes that hold whole bodies for a while, before any of their elements is looked
/// at. What is left to search is in proportion to the pairs that come near, not to all pairs.
///
/// A span of time is a few consecutive segments of the path. In a segment a point is at x(s) = R(s) X + q(s), q linear, and
///   |x(s) - ((1 - s) x(0) + s x(1))| <= |w|^2 |base X| / 8,   w = rotation_vector_step   (interpolation; |R''| <= |w|^2)
/// and at most 2 |base X|. So the boxes at both ends of all its segments, grown by that with the body's largest |X|, hold the body
/// throughout: center R c + q, half extents |R| h, of the box (c, h) of the mesh in the body's frame.
/// Of a segment that turns little the box at its middle is as good, and cheaper: |x(s) - (base X + q(1/2))| <= |theta| |base X| with the
/// largest |theta| <= |theta_0| + |w|, and half of q's step along each axis.
/// Rounding: 64u of the size of positions and (64 + 48|theta|)u of the radius, as segment_bound.hpp has it, twice.
#pragma once

#include <functional>
#include <vector>

#include "fettle/core/clearance/body_motions.hpp"

namespace fettle::core::clearance {

/// Which pairs are looked at, of bodies a < b. Called on any thread.
using PairFilter = std::function<bool(int a, int b)>;

/// Bodies a < b, which are wanted and may be nearer than the reach in segments [first, last) of the path.
struct NearWindow {
    int a = 0, b = 0, first = 0, last = 0;
    bool measurable = true;  ///< false: numbers of a body's path are of no use (have_usable_numbers); then the window is the whole path
};

struct NearWindows {
    std::vector<NearWindow> windows;  ///< by (a, b), then by time; windows of a pair neither overlap nor touch
    bool everything = false;          ///< they are all pairs that are wanted, over the whole path
};

/// Same result for any number of threads. Contract: reach >= 0; infinity is allowed.
NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach, const PairFilter& wanted);
/// Of pairs that may collide.
NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach);

/// The two bodies during a window.
/// @param shapes  of both, at least.
PairMotion window_motion(const std::vector<BodyShape>& shapes, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         const NearWindow& window);

}  // namespace fettle::core::clearance
