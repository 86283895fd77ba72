// SPDX-License-Identifier: MIT
/// What an optimisation answers: the object of result.json and --json.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/studies/optimise_design.hpp"

namespace fettle::design::answers {

/// What a run was asked for, and where its files are.
struct RunFacts {
    std::string out;
    std::uint64_t seed = 0;
    bool repair = false;
};

/// Keys: docs/interface.md.
nlohmann::ordered_json outcome_json(const problem::DesignProblem& problem, const studies::OptimiseOutcome& outcome, const RunFacts& run);

/// The design's own, whatever the run minimised; null if nothing could be evaluated.
nlohmann::ordered_json objective_json(const studies::OptimiseOutcome& outcome, const RunFacts& run);

struct Cost {
    std::size_t constraint;  ///< of the design's
    std::string requirement;
    double per_unit;  ///< in the objective; > 0: a lower bound that is raised costs, < 0: an upper one that is lowered
};

/// The costs of the requirements whose hundredth of a unit is worth a tenth of what counts; the dearest first.
std::vector<Cost> costs_of(const description::Design& design, const optimisers::Optimality& o);

/// Why a design that meets every requirement ("feasible") is not shown to be the best near by: for the text, result.json and the report
/// alike. Clauses without a full stop at the end; empty where the status is another one.
std::string why_not_optimal(const description::Design& design, const studies::OptimiseOutcome& outcome, const RunFacts& run);

}  // namespace fettle::design::answers
