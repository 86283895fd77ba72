// SPDX-License-Identifier: MIT
#include "fettle/design/studies/optimise_design.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "fettle/design/optimisers/nearest_design.hpp"
#include "fettle/design/problem/buildable.hpp"
#include "fettle/design/problem/optimiser_problem.hpp"
#include "fettle/design/problem/smoother_models.hpp"
#include "fettle/design/studies/limits.hpp"
#include "fettle/design/studies/random_start.hpp"

namespace fettle::design::studies {

namespace {

using description::Design;
using problem::DesignEvaluation;

std::string evaluation_line(int number, const optimisers::Evaluation& e, bool best) {
    char line[200];
    if (!e.usable) {
        std::snprintf(line, sizeof line, "%4d  cannot be evaluated: ", number);
        return line + e.reason;
    }
    std::snprintf(line, sizeof line, "%4d  objective %-13.8g violation %-11.4g%s", number, e.objective, e.violation, best ? " best" : "");
    return line;
}

constexpr double repair_tolerance = 1e-2;  // of the squared change: half a percent of the change

using Compute = std::function<HistoryEntry(const problem::DesignProblem&, const VectorX&, Recorded)>;

// Of one model: from the history, if there is one that has it, else computed. `model` and `compute` must outlive it.
std::function<optimisers::Evaluation(const VectorX&)> answered(const problem::DesignProblem& model, const std::string& name,
                                                               const Compute& compute, History* history, Recorded wanted) {
    const auto entry = [&model, &compute, wanted](const VectorX& p) { return compute(model, p, wanted); };
    if (history != nullptr) return recorded(*history, entry, name, wanted);
    return [entry](const VectorX& p) { return entry(p).evaluation; };
}

}  // namespace

HistoryEntry history_entry(const Design& design, const VectorX& p, const DesignEvaluation& evaluation) {
    HistoryEntry entry;
    entry.point = p;
    entry.forward_seconds = evaluation.forward_seconds;
    entry.backward_seconds = evaluation.backward_seconds;
    entry.evaluation = problem::optimiser_evaluation(evaluation);
    if (!entry.evaluation.usable) return entry;
    for (size_t i = 0; i < evaluation.constraints.size(); ++i)
        entry.certified.emplace_back(design.constraints[i].name, evaluation.constraints[i].lower);
    for (size_t k = 0; k < evaluation.terms.size(); ++k) entry.terms.emplace_back(design.objective[k].name, evaluation.terms[k].value);
    return entry;
}

Result<OptimiseOutcome> optimise_design(const problem::DesignProblem& problem, const OptimiseOptions& options) {
    const Design& design = problem.design();
    const auto optimiser = optimisers::make_optimiser(options.optimiser.empty() ? design.optimiser.name : options.optimiser, "optimiser");
    if (!optimiser) return optimiser.errors();

    problem::EvaluateOptions evaluate;
    evaluate.should_stop = options.should_stop;
    evaluate.on_step = options.on_step;
    optimisers::Problem seen = problem::optimiser_problem(problem, evaluate);
    seen.start = start_of_seed(design, options.seed);
    int computed = 0;
    const problem::EvaluateOptions values = problem::without_gradients(evaluate);
    const Compute compute = [&](const problem::DesignProblem& model, const VectorX& p, Recorded wanted) {
        ++computed;
        return history_entry(design, p, model.evaluate(p, wanted == Recorded::values ? values : evaluate));
    };
    seen.evaluate = answered(problem, {}, compute, options.history, Recorded::with_derivatives);
    seen.values = answered(problem, {}, compute, options.history, Recorded::values);
    OptimiseOutcome outcome;
    outcome.start = seen.start;
    seen.evaluate = [&outcome, evaluate_own = seen.evaluate](const VectorX& p) {
        optimisers::Evaluation e = evaluate_own(p);
        if (e.usable && p == outcome.start) outcome.objective_start = e.objective;
        return e;
    };
    const std::vector<problem::SmootherDesign> smoother =
        problem::smoother_models(problem, seen.prepared ? seen.prepared(seen.start) : seen.start);
    for (const problem::SmootherDesign& model : smoother) {
        seen.smoother.push_back({model.name, answered(model.problem, model.name, compute, options.history, Recorded::with_derivatives),
                                 answered(model.problem, model.name, compute, options.history, Recorded::values)});
        if (options.narrate) options.narrate("to begin with: " + model.name);
    }
    optimisers::OptimiserOptions settings;
    settings.max_evaluations = design.optimiser.max_evaluations;
    settings.tolerance = options.repair ? std::max(repair_tolerance, design.optimiser.tolerance) : design.optimiser.tolerance;
    settings.should_stop = options.should_stop;
    std::vector<FailedTrial> failures;
    settings.on_evaluation = [&](int number, const VectorX& p, const optimisers::Evaluation& e, bool best) {
        if (!e.usable) failures.push_back({p, e.reason});
        if (options.narrate) options.narrate(evaluation_line(number, e, best));
    };

    int refused = 0;
    seen.refusal = [&, ask = seen.refusal](const VectorX& p) {
        std::string reason = ask(p);
        if (!reason.empty()) {
            ++refused;
            failures.push_back({p, reason});
        }
        return reason;
    };

    outcome.unbuildable = problem::described(design, problem::try_bounds(problem));
    for (const std::string& line : outcome.unbuildable) {
        if (options.narrate) options.narrate("bounds: " + line);
    }
    if (options.repair) seen = optimisers::nearest_to(description::values_of(design.parameters), std::move(seen));
    outcome.report = optimisers::optimise(seen, **optimiser, settings);
    outcome.replayed = outcome.report.evaluations - computed;
    if (!outcome.report.best.usable) return outcome;
    problem::EvaluateOptions last;  // not interruptible: it is what makes the result of an interrupted run usable
    last.gradients = false;
    outcome.final = problem.evaluate(outcome.report.point, last);
    if (!smoother.empty()) {
        last.should_stop = options.should_stop;
        outcome.play_taken_up_by = smoother.front().name;
        outcome.play_taken_up = smoother.front().problem.evaluate(outcome.report.point, last);
    }
    for (const description::Measurement& measured : outcome.final.constraints) {
        if (measured.clearance) outcome.clearance.push_back(*measured.clearance);
    }
    if (outcome.report.feasible) return outcome;
    outcome.limits = limits_of(problem, outcome.report.point, outcome.final, outcome.report.best.jacobian, failures,
                               outcome.report.evaluations + refused);
    return outcome;
}

}  // namespace fettle::design::studies
