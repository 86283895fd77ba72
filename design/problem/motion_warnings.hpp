// SPDX-License-Identifier: MIT
/// What is to be said about the motions of a design that was evaluated, besides its numbers.
#pragma once

#include <string>
#include <vector>

#include "design/problem/design_problem.hpp"

namespace fettle::design::problem {

/// Linkages that leave the branch that they were assembled on (core/stepper/branch_warnings.hpp), of each scenario that was simulated;
/// energy that comes from nowhere and angular momentum that goes astray, where they were looked at (EvaluateOptions::balance,
/// core/stepper/balance.hpp); extremes that are hardly meant, or fall on one step alone (problem/doubtful_extremes.hpp).
std::vector<std::string> motion_warnings(const description::Design& design, const DesignEvaluation& evaluation);

}  // namespace fettle::design::problem
