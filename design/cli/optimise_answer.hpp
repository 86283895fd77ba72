// SPDX-License-Identifier: MIT
/// What `fettle optimise` answers: the object of result.json and --json, the text, the exit code.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fettle/design/cli/console.hpp"
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/studies/optimise_design.hpp"

namespace fettle::design::cli {

/// What a run was asked for, and where its files are.
struct RunFacts {
    std::string out;
    std::uint64_t seed = 0;
    bool repair = false;
};

/// Keys: docs/interface.md.
nlohmann::ordered_json outcome_json(const problem::DesignProblem& problem, const studies::OptimiseOutcome& outcome, const RunFacts& run);
std::string outcome_text(const description::Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                         const RunFacts& run);
int exit_code(optimisers::OptimiserStatus status);

}  // namespace fettle::design::cli
