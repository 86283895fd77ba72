// SPDX-License-Identifier: MIT
#include "fettle/design/cli/optimise_answer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using description::Design;
using optimisers::OptimiserStatus;
using studies::OptimiseOutcome;

// Where the two tell different things, by more than a ten thousandth.
std::string by_models_text(const Design& design, const OptimiseOutcome& outcome) {
    std::string text;
    for (size_t i = 0; outcome.play_taken_up.usable && i < outcome.final.constraints.size(); ++i) {
        const double unit = design.constraints[i].bounds.unit, own = outcome.final.constraints[i].value / unit;
        const double other = outcome.play_taken_up.constraints[i].value / unit;
        if (std::abs(own - other) <= 1e-4 * std::abs(own)) continue;
        text += formatted("  %-40s %.7g as written, %.7g with the play taken up\n", design.constraints[i].name.c_str(), own, other);
    }
    if (!text.empty()) text = "where the motion within the play matters (play taken up: " + outcome.play_taken_up_by + "):\n" + text;
    return text;
}

// What each requirement that holds costs, the dearest first; what could still move; what is too rough to tell.
std::string verdict_text(const Design& design, const optimisers::Optimality& o, const std::string& minimised) {
    std::string text;
    const std::vector<answers::Cost> costs = answers::costs_of(design, o);
    if (!costs.empty()) text += "what the requirements cost, in " + minimised + ", per hundredth of their unit:\n";
    for (const answers::Cost& cost : costs) {
        const double worth = 0.01 * std::abs(cost.per_unit);
        text += formatted("  %s: 0.01 %s is worth %.3g\n", cost.requirement.c_str(), cost.per_unit > 0 ? "less" : "more", worth);
    }
    for (const int k : o.improvable) {
        const description::Parameter& p = design.parameters[static_cast<size_t>(k)];
        text += formatted("could still move: %s by %.4g %s\n", p.name.c_str(), description::from_si(o.step[k], p.unit),
                          std::string(p.unit.name).c_str());
    }
    if (!o.improvable.empty()) text += formatted("predicted gain %.3g, %.3g counts\n", o.predicted_gain, o.worth);
    if (!o.refused.empty()) text += "but designs there cannot be evaluated: " + o.refused + "\n";
    if (o.roughest >= 0) {
        text += formatted("too rough to tell an optimum: noise of %.3g in the objective, most of it by %s, %.3g counts; ",
                          o.noise_in_objective, answers::roughest_name(design, o).c_str(), o.worth);
        text += "wider contact (dhat) or damping would help\n";
    }
    return text;
}

// Of --repair.
std::string changes_text(const Design& design, const optimisers::OptimiserReport& report) {
    std::string text =
        formatted("smallest change found that meets every requirement: %.4g of the ranges\n", std::sqrt(report.best.objective));
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        const double change = description::from_si(report.point[static_cast<Eigen::Index>(k)] - p.value, p.unit);
        if (change != 0) text += formatted("  %-24s %+.5g %s\n", p.name.c_str(), change, std::string(p.unit.name).c_str());
    }
    return text;
}

}  // namespace

std::string outcome_text(const Design& design, const OptimiseOutcome& outcome, const Console& console, const answers::RunFacts& run) {
    const optimisers::OptimiserReport& report = outcome.report;
    const bool good = report.status == OptimiserStatus::optimal;
    std::string text = console.coloured(optimisers::to_string(report.status), good) + ": " + report.message + "\n";
    if (!report.best.usable) return text;
    text += formatted("objective %.8g, ", answers::objective_json(outcome, run).get<double>());
    text +=
        outcome.objective_start ? formatted("from %.8g at the start; ", *outcome.objective_start) : "the start could not be evaluated; ";
    text += formatted("%d evaluations (%d failed), %d iterations\n", report.evaluations, report.failures, report.iterations);
    if (run.repair && report.feasible) text += changes_text(design, report);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        const bool told = k < report.optimality.held.size();
        text += formatted("  %-24s %12.7g -> %12.7g %s%s%s\n", p.name.c_str(),
                          description::from_si(outcome.start[static_cast<Eigen::Index>(k)], p.unit),
                          description::from_si(report.point[static_cast<Eigen::Index>(k)], p.unit), std::string(p.unit.name).c_str(),
                          told ? ", held by: " : "", told ? optimisers::to_string(report.optimality.held[k]) : "");
    }
    for (size_t i = 0; i < outcome.final.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = outcome.final.constraints[i];
        const bool met = description::violation(bounds, measured) <= 0;
        text += formatted("  %-40s proven [%.7g, %.7g], required [%g, %g]: ", name.c_str(), measured.lower / bounds.unit,
                          measured.upper / bounds.unit, bounds.lower / bounds.unit, bounds.upper / bounds.unit) +
                console.coloured(met ? "met" : "VIOLATED", met) + (measured.fault.empty() ? "" : ": " + measured.fault) + "\n";
    }
    text += relations_text(design, outcome.final.relations, console);
    text += by_models_text(design, outcome);
    text += verdict_text(design, report.optimality, run.repair ? "the squared change" : "the objective");
    for (const std::string& limit : outcome.limits) text += "limited by: " + limit + "\n";
    return text + "written to " + run.out + ": design.final.json, trajectory.json, motion.glb, history.jsonl, result.json\n";
}

int exit_code(OptimiserStatus status) {
    switch (status) {
        case OptimiserStatus::optimal:
            return exit_done;
        case OptimiserStatus::infeasible:
            return exit_violated;
        default:
            return exit_undecided;
    }
}

}  // namespace fettle::design::cli
