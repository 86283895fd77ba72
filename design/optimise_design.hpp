// SPDX-License-Identifier: MIT
/// Optimises a design: optimiser, history, final evaluation with certificates, files. The one-call form of what optimisers/, history.hpp
/// and design_problem.hpp do; `fettle optimise` is this and its printing.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/design_problem.hpp"
#include "fettle/design/optimisers/optimisation.hpp"

namespace fettle::design {

struct OptimiseOptions {
    std::string directory;                            ///< for history.jsonl, design.final.json, trajectory.json; made if it is not there
    bool resume = false;                              ///< replay an existing history
    std::string optimiser;                            ///< empty: what the design says
    std::function<bool()> should_stop;                ///< optional
    std::function<void(const std::string&)> narrate;  ///< optional: a line per evaluation
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
};

struct OptimiseOutcome {
    optimisers::OptimiserReport report;
    DesignEvaluation final;                                 ///< of report.point, without gradients; not usable if the start was not
    std::vector<core::clearance::PairClearance> clearance;  ///< the certificates of all clearance constraints, in their order
    std::vector<std::string> limits;  ///< what holds an infeasible design back: violated requirements, parameters at their bounds
    int replayed = 0;                 ///< evaluations that the history answered
    std::string history_kept_as;      ///< of an earlier run, if one was moved away
};

/// A killed run, resumed with the same design and options, ends with the same outcome, bit for bit.
/// Errors: the optimiser's name, the history (another design's, in use), files that cannot be written.
Result<OptimiseOutcome> optimise_design(const DesignProblem& problem, const OptimiseOptions& options);

}  // namespace fettle::design
