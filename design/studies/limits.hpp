// SPDX-License-Identifier: MIT
/// What holds an infeasible design back, for people. In this order:
///   1. parameters that would have to go further to meet what is violated, and cannot: at a bound, or because no part can be made there
///   2. trials that failed, by their reasons
///   3. the violated requirements themselves, unless parts that cannot be made have been named: then those are to blame
#pragma once

#include <string>
#include <vector>

#include "design/optimisers/problem.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::studies {

/// A trial that could not be evaluated, or was refused before (optimisers::Problem::refusal).
struct FailedTrial {
    VectorX point;
    std::string reason;
};

/// @param point      The best design, infeasible.
/// @param final      Evaluated there.
/// @param jacobian   of the constraints there; without rows: not known, then 1 covers bounds alone.
/// @param failures   The failures of the whole run.  @param trials  How many there were in all.
std::vector<std::string> limits_of(const problem::DesignProblem& problem, const VectorX& point, const problem::DesignEvaluation& final,
                                   const MatrixX& jacobian, const std::vector<FailedTrial>& failures, int trials);

}  // namespace fettle::design::studies
