// SPDX-License-Identifier: MIT
/// What of a design's objective and constraints is hardly meant: the "largest" of a force, torque or velocity with a direction, or the
/// "least", where a step has a larger absolute value of the other sign. Of a motor that drives backwards the "largest" effort is its least
/// one; "peak" counts both directions (quantities/step_series.hpp).
#pragma once

#include <string>
#include <vector>

#include "fettle/design/problem/design_problem.hpp"

namespace fettle::design::problem {

/// A sentence for each such quantity, in the order of the design's terms and constraints, with the numbers; one that several of them, or
/// several scenarios, ask for is told once. Left out: the "least" of what is never negative and the upper bound below 0 of a "largest",
/// which say that something must not turn round; an expression that takes both extremes.
/// @param evaluation  Of the design; of one that is not usable nothing is said.
std::vector<std::string> overlooked_peaks(const description::Design& design, const DesignEvaluation& evaluation);

}  // namespace fettle::design::problem
