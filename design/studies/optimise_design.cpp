// SPDX-License-Identifier: MIT
#include "fettle/design/studies/optimise_design.hpp"

#include <cmath>
#include <cstdio>

#include "fettle/design/problem/optimiser_problem.hpp"
#include "fettle/design/problem/smoother_models.hpp"

namespace fettle::design::studies {

namespace {

using description::Bounds;
using description::Design;
using description::Parameter;
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

std::vector<std::string> limits_of(const Design& design, const VectorX& point, const DesignEvaluation& final) {
    std::vector<std::string> limits;
    char text[300];
    for (size_t i = 0; i < design.constraints.size() && i < final.constraints.size(); ++i) {
        const description::Measurement& measured = final.constraints[i];
        const Bounds& bounds = design.constraints[i].bounds;
        if (description::violation(bounds, measured) <= 0) continue;
        const double unit = bounds.unit;
        std::snprintf(text, sizeof text, "%s is proven within [%.6g, %.6g], required is [%.6g, %.6g]", design.constraints[i].name.c_str(),
                      measured.lower / unit, measured.upper / unit, bounds.lower / unit, bounds.upper / unit);
        limits.push_back(text + (measured.fault.empty() ? "" : ": " + measured.fault));
    }
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& p = design.parameters[k];
        const double value = point[static_cast<Eigen::Index>(k)], near = 1e-3 * (p.upper - p.lower);
        const bool at_lower = value <= p.lower + near, at_upper = value >= p.upper - near;
        if (!at_lower && !at_upper) continue;
        std::snprintf(text, sizeof text, "parameter %s is at its %s bound %.6g %s", p.name.c_str(), at_lower ? "lower" : "upper",
                      description::from_si(at_lower ? p.lower : p.upper, p.unit), std::string(p.unit.name).c_str());
        limits.emplace_back(text);
    }
    return limits;
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
    int computed = 0;
    const auto compute = [&](const VectorX& p) {
        ++computed;
        return history_entry(design, p, problem.evaluate(p, evaluate));
    };
    const auto answered = [&](const auto& compute_entry,
                              const std::string& model) -> std::function<optimisers::Evaluation(const VectorX&)> {
        if (options.history != nullptr) return recorded(*options.history, compute_entry, model);
        return [compute_entry](const VectorX& p) { return compute_entry(p).evaluation; };
    };
    seen.evaluate = answered(compute, {});
    const VectorX first = seen.prepared ? seen.prepared(seen.start) : seen.start;
    const std::vector<problem::SmootherDesign> smoother = problem::smoother_models(problem, first);
    for (const problem::SmootherDesign& model : smoother) {
        const auto compute_smoother = [&](const VectorX& p) {
            ++computed;
            return history_entry(design, p, model.problem.evaluate(p, evaluate));
        };
        seen.smoother.push_back({model.name, answered(compute_smoother, model.name)});
        if (options.narrate) options.narrate("to begin with: " + model.name);
    }
    optimisers::OptimiserOptions settings;
    settings.max_evaluations = design.optimiser.max_evaluations;
    settings.tolerance = design.optimiser.tolerance;
    settings.should_stop = options.should_stop;
    settings.on_evaluation = [&](int number, const VectorX&, const optimisers::Evaluation& e, bool best) {
        if (options.narrate) options.narrate(evaluation_line(number, e, best));
    };

    OptimiseOutcome outcome;
    outcome.report = optimisers::optimise(seen, **optimiser, settings);
    outcome.replayed = outcome.report.evaluations - computed;
    if (!outcome.report.best.usable) return outcome;
    problem::EvaluateOptions last;  // not interruptible: it is what makes the result of an interrupted run usable
    last.gradients = false;
    outcome.final = problem.evaluate(outcome.report.point, last);
    for (const description::Measurement& measured : outcome.final.constraints) {
        if (measured.clearance) outcome.clearance.push_back(*measured.clearance);
    }
    if (!outcome.report.feasible) outcome.limits = limits_of(design, outcome.report.point, outcome.final);
    return outcome;
}

}  // namespace fettle::design::studies
