// SPDX-License-Identifier: MIT
/// Where joints and scripted bodies go over a prescribed motion, from the start on for some time, as ranges (looped_ranges.hpp):
///   one thing moves       its coordinate, over all that its curve comes to in that time: the same set of positions as over time
///   several at even speed one coordinate, time [s], that all of them follow in their own rates
/// A coordinate that nothing drives must follow by a loop from one that is driven. A body without joints that nothing drives stays where it
/// starts, and is named.
#pragma once

#include "core/base/result.hpp"
#include "core/clearance/looped_ranges.hpp"

namespace fettle::core::clearance {

/// @param duration  [s] > 0
/// Errors, by name: those of looped_ranges; nothing that moves; a joint that nothing drives; several things of which one goes by a table;
/// poses at times; curves whose extent is not known exactly (cubic, control_points).
base::Result<LoopedRanges> driven_ranges(const model::Model& model, double duration);

/// When a curve may turn back in that time, and its last moment: between two of these it goes one way. Contract: it is linear, or a
/// trapezoid alone.
std::vector<double> turning_times(const scene::Curve& curve, double duration);

}  // namespace fettle::core::clearance
