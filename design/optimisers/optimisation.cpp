// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/optimisation.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/design/optimisers/ipopt_optimiser.hpp"
#include "fettle/design/optimisers/nlopt_optimiser.hpp"

namespace fettle::design::optimisers {

const char* to_string(OptimiserStatus status) {
    switch (status) {
        case OptimiserStatus::converged:
            return "converged";
        case OptimiserStatus::budget_spent:
            return "budget_spent";
        case OptimiserStatus::infeasible:
            return "infeasible";
        case OptimiserStatus::infeasible_budget:
            return "infeasible_budget_spent";
        case OptimiserStatus::not_converged:
            return "not_converged";
        case OptimiserStatus::interrupted:
            return "interrupted";
        case OptimiserStatus::start_failed:
            return "start_failed";
    }
    return "unknown";
}

const std::vector<std::string>& optimiser_names() {
    static const std::vector<std::string> names{"ipopt", "mma", "ccsaq", "slsqp", "cobyla"};
    return names;
}

Result<std::unique_ptr<Optimiser>> make_optimiser(const std::string& name, const std::string& where) {
    if (name == "ipopt") return std::unique_ptr<Optimiser>(std::make_unique<IpoptOptimiser>());
    if (name == "mma") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::mma));
    if (name == "ccsaq") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::ccsaq));
    if (name == "slsqp") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::slsqp));
    if (name == "cobyla") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::cobyla));
    return Error{ErrorCode::out_of_range, where, "unknown optimiser \"" + name + "\"; known are ipopt, mma, ccsaq, slsqp, cobyla"};
}

namespace {

// What stopped the run, and the best design's feasibility and optimality, as one verdict.
OptimiserStatus verdict(const Evaluator& evaluator, double optimality, bool feasible) {
    switch (evaluator.stop_reason()) {
        case StopReason::interrupted:
            return OptimiserStatus::interrupted;
        case StopReason::budget:
            return feasible ? OptimiserStatus::budget_spent : OptimiserStatus::infeasible_budget;
        default:
            break;
    }
    if (!feasible) return OptimiserStatus::infeasible;
    return optimality <= nearly_optimal ? OptimiserStatus::converged : OptimiserStatus::not_converged;
}

}  // namespace

OptimiserReport optimise(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options) {
    Evaluator evaluator(problem, {options.max_evaluations, options.should_stop, options.on_evaluation});
    OptimiserReport report;
    report.start = evaluator.start_evaluation();
    report.point = problem.start;
    NativeOutcome native;
    if (report.start.usable) {
        try {
            native = optimiser.minimise(evaluator, options);
        } catch (const StopOptimisation&) {  // thrown in the optimiser's own evaluations, outside its native callbacks
        }
        evaluator.rethrow();
    }
    report.evaluations = evaluator.evaluations();
    report.failures = evaluator.failures();
    report.iterations = native.iterations;
    if (!report.start.usable) {
        const bool interrupted = evaluator.stop_reason() == StopReason::interrupted;
        report.status = interrupted ? OptimiserStatus::interrupted : OptimiserStatus::start_failed;
        report.message = "the start cannot be evaluated: " + report.start.reason;
        return report;
    }
    report.point = evaluator.best_point();
    report.best = evaluator.best_evaluation();
    report.feasible = report.best.violation <= 0;
    report.optimality = optimality_residual(evaluator, evaluator.best_scaled_point(), evaluator.best_scaled_evaluation(), nearly_active);
    report.status = verdict(evaluator, report.optimality, report.feasible);
    report.message = optimiser.name() + ": " + native.message;
    if (evaluator.stop_reason() == StopReason::budget)
        report.message = "stopped after max_evaluations = " + std::to_string(options.max_evaluations);
    if (evaluator.stop_reason() == StopReason::interrupted)
        report.message = "stopped as asked after " + std::to_string(report.evaluations) + " evaluations";
    return report;
}

}  // namespace fettle::design::optimisers
