// SPDX-License-Identifier: MIT
/// The run of an optimiser: a start that can be evaluated, the smoother models one after another (each begun where the last one ended),
/// then the problem itself, and our own verdict on its best point, which is never worse than the start: where the way through the smoother
/// models ends in a worse one, the problem itself is searched from the start, too. A native return code is never the verdict: NLopt can
/// return a wrong answer with a success code. Feasibility is judged by the evaluation's `violation` (certificates), optimality as
/// optimality.hpp says.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/optimisers/optimality.hpp"
#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

enum class OptimiserStatus {
    optimal,      ///< every requirement is met, and no gain above the tolerance is in sight (Optimality::is_optimal)
    feasible,     ///< every requirement is met; more could be gained, or it is not known
    infeasible,   ///< a requirement is violated
    interrupted,  ///< should_stop ended the run; the best design so far
    start_failed  ///< neither the start nor a point on the way to the middle of the bounds can be evaluated
};
const char* to_string(OptimiserStatus status);

/// One model, optimised.
struct StageReport {
    std::string model;     ///< empty: the problem itself
    int evaluations = 0;   ///< 0: it was left out, see `message`
    double objective = 0;  ///< at its best point, by its own values
    double violation = 0;
    std::string message;
};

struct OptimiserReport {
    OptimiserStatus status = OptimiserStatus::start_failed;
    std::string message;  ///< for people: of a feasible design the verdict's words, else the native optimiser's; or what else ended the run
    Evaluation start;     ///< of the problem itself, at its start
    VectorX point;        ///< the best design (the start if nothing could be evaluated)
    Evaluation best;
    double objective = std::numeric_limits<double>::quiet_NaN();  ///< of `best`; NaN: nothing could be evaluated
    double violation = std::numeric_limits<double>::quiet_NaN();
    bool feasible = false;  ///< violation <= 0
    Optimality optimality;
    int evaluations = 0, failures = 0, iterations = 0;
    bool budget_spent = false;  ///< max_evaluations ended the run
    /// Where the smoother models have led to, if the run ended before the problem itself was evaluated there: it may be better than `best`.
    /// Empty: it was, or there are none.
    VectorX untried;
    /// The stages of the smoother models, then of the problem itself: from where they led to and, if that ended worse than the start, from
    /// the start.
    std::vector<StageReport> stages;
};

/// Deterministic: the same problem and options give the same sequence of evaluations.
/// Throws what Problem::evaluate throws (Interrupted excepted).
OptimiserReport optimise(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options);

/// Gives the report this end, which was evaluated after the run, in place of `best` where it is better.
void take_if_better(OptimiserReport& report, const VectorX& point, const Evaluation& evaluation);

/// Two searches of one problem, one after the other, as one: the start of the first, the end of the better one (the later one, where they
/// are equal) and its verdict, evaluations of both. Interrupted if the later one was.
OptimiserReport better_of(OptimiserReport first, OptimiserReport later);

struct OptimiserInfo {
    std::string name, description;
};
/// All there are; the first is the default.
const std::vector<OptimiserInfo>& optimiser_table();
const std::vector<std::string>& optimiser_names();  ///< of the table
/// Errors: an unknown name (out_of_range), the message lists those known.
Result<std::unique_ptr<Optimiser>> make_optimiser(const std::string& name, const std::string& where = {});

}  // namespace fettle::design::optimisers
