// SPDX-License-Identifier: MIT
/// What an optimisation answers: the object of result.json and --json.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "design/answers/verdict.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::answers {

/// Keys: docs/interface.md.
nlohmann::ordered_json outcome_json(const problem::DesignProblem& problem, const studies::OptimiseOutcome& outcome, const RunFacts& run);

/// The design's own, whatever the run minimised; null if nothing could be evaluated.
nlohmann::ordered_json objective_json(const studies::OptimiseOutcome& outcome, const RunFacts& run);

}  // namespace fettle::design::answers
