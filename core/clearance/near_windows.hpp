// SPDX-License-Identifier: MIT
/// Which bodies come near each other, and when: proven by boxes that hold whole bodies for a while, before any of their elements is looked
/// at. What is left to search is in proportion to the pairs that come near, not to all pairs.
///
/// A span of time is a few consecutive segments of the path; the boxes: swept_boxes.hpp.
#pragma once

#include <functional>
#include <vector>

#include "core/clearance/body_motions.hpp"

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
/// The windows of pairs that may collide.
NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach);

/// The two bodies during a window.
/// @param shapes  of both, at least.
PairMotion window_motion(const std::vector<BodyShape>& shapes, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         const NearWindow& window);

}  // namespace fettle::core::clearance
