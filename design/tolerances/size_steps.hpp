// SPDX-License-Identifier: MIT
/// The steps of nominal size in which standards tabulate tolerances.
#pragma once

#include <algorithm>
#include <iterator>

namespace fettle::design::tolerances {

/// A size that exceeds the end of a step by less than this still lies in it: 0.1 + 0.2 mm is 0.3 mm [m].
inline constexpr double size_rounding = 1e-12;

/// Steps hold the sizes over the end of the step before, up to and including their own.
/// @param steps  Sorted; each has a member up_to, its end [mm].
/// @param size   [m], not NaN.
/// @return       The step that holds the size; end(steps) where the size lies beyond the last.
template <class Steps>
auto step_of(const Steps& steps, double size) {
    return std::find_if(std::begin(steps), std::end(steps), [&](const auto& step) { return size <= step.up_to / 1e3 + size_rounding; });
}

}  // namespace fettle::design::tolerances
