// SPDX-License-Identifier: MIT
/// The run of an optimiser: start, native optimiser, our own verdict. A native return code is never the verdict:
/// NLopt can return a wrong answer with a success code, Ipopt a good one with a failure's. Feasibility is judged by the evaluation's
/// `violation` (certificates), optimality by the residual of the Karush-Kuhn-Tucker conditions at the best point.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/optimisers/optimality.hpp"
#include "fettle/design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

/// Of the best design: `feasible` is a violation of 0, `optimal` an optimality residual of at most nearly_optimal (optimality.hpp).
/// However the native optimiser ended, a run that was not cut short is one of converged, not_converged and infeasible.
enum class OptimiserStatus {
    converged,          ///< feasible and optimal
    not_converged,      ///< feasible, but not optimal
    infeasible,         ///< a requirement is violated
    budget_spent,       ///< max_evaluations ended the run; feasible, optimal or not
    infeasible_budget,  ///< max_evaluations ended the run before a feasible design was found
    interrupted,        ///< should_stop ended the run; the best design so far
    start_failed        ///< the start cannot be evaluated
};
const char* to_string(OptimiserStatus status);

struct OptimiserReport {
    OptimiserStatus status = OptimiserStatus::start_failed;
    std::string message;  ///< for people: what ended it, in the native optimiser's words too
    Evaluation start;
    VectorX point;  ///< the best design (the start if nothing could be evaluated)
    Evaluation best;
    bool feasible = false;  ///< best.violation <= 0
    double optimality = 0;  ///< residual of the optimality conditions at the best point, scaled; see optimality_residual
    int evaluations = 0, failures = 0, iterations = 0;
};

/// Deterministic: the same problem and options give the same sequence of evaluations.
/// Throws what Problem::evaluate throws (Interrupted excepted).
OptimiserReport optimise(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options);

const std::vector<std::string>& optimiser_names();
/// Errors: an unknown name (out_of_range), the message lists those known.
Result<std::unique_ptr<Optimiser>> make_optimiser(const std::string& name, const std::string& where = {});

}  // namespace fettle::design::optimisers
