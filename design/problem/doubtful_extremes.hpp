// SPDX-License-Identifier: MIT
/// The numbers of a design's objective and constraints that are not as meant, or not well known: those that say so themselves
/// (Quantity::doubt), such as the time of an event that is about to vanish, and extremes over the steps:
/// - the "largest" of a force, torque or velocity with a direction, or the "least", where a step has a larger absolute value of the other
///   sign. The "largest" effort of a motor that drives backwards is its least one; "peak" counts both directions
///   (quantities/step_series.hpp);
/// - one that falls on a single step, which the steps beside it show neither a bend nor a cliff of (quantities/extreme.hpp): between the
///   steps the quantity may be larger, and it jumps from design to design.
#pragma once

#include <string>
#include <vector>

#include "design/problem/design_problem.hpp"

namespace fettle::design::problem {

/// Sentences for each such quantity, in the order of the design's terms and constraints, with the numbers; one that several of them, or
/// several scenarios, ask for is told once. Left out: the "least" of a number that is never negative and the upper bound below 0 of a
/// "largest", which say that something must not turn round; an expression that takes both extremes; what is hidden between steps if it is
/// less than 0.2% of the extreme.
/// @param evaluation  The evaluation of the design; of one that is not usable, or that nothing was simulated for, nothing is said.
std::vector<std::string> doubtful_extremes(const description::Design& design, const DesignEvaluation& evaluation);

}  // namespace fettle::design::problem
