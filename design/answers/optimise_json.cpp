// SPDX-License-Identifier: MIT
#include "design/answers/optimise_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/judged_json.hpp"
#include "design/answers/summary.hpp"
#include "design/problem/motion_warnings.hpp"

namespace fettle::design::answers {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using problem::DesignEvaluation;
using problem::DesignProblem;
using studies::OptimiseOutcome;

Json stages_json(const optimisers::OptimiserReport& report) {
    Json list = Json::array();
    for (const optimisers::StageReport& stage : report.stages) {
        list.push_back({{"model", stage.model.empty() ? "as written" : stage.model},
                        {"evaluations", stage.evaluations},
                        {"objective", stage.objective},
                        {"constraint_violation", stage.violation},
                        {"message", stage.message}});
    }
    return list;
}

Json optimality_json(const Design& design, const optimisers::Optimality& o) {
    Json residual = Json::object(), held = Json::object(), improvable = Json::array();
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        residual[design.parameters[k].name] = o.residual[k];
        held[design.parameters[k].name] = optimisers::to_string(o.held[k]);
    }
    for (const int k : o.improvable) {
        const description::Parameter& p = design.parameters[k];
        improvable.push_back({{"parameter", p.name}, {"step", description::from_si(o.step[k], p.unit)}});
    }
    Json multipliers = Json::object();
    for (size_t i = 0; i < design.constraints.size(); ++i)
        multipliers[design.constraints[i].name] = o.multipliers[i] * design.constraints[i].bounds.unit;
    Json of_relations = Json::object();
    const size_t m = design.constraints.size();
    for (size_t i = 0; i < design.relations.size() && m + i < static_cast<size_t>(o.multipliers.size()); ++i)
        if (!design.relations[i].by_choices)  // no parameter changes it
            of_relations[design.relations[i].name] = o.multipliers[static_cast<Eigen::Index>(m + i)] * design.relations[i].bounds.unit;
    Json json{{"multipliers", multipliers},
              {"relation_multipliers", of_relations},
              {"predicted_gain", o.predicted_gain},
              {"worth", o.worth},
              {"radius", o.radius},
              {"residual", residual},
              {"held_by", held},
              {"improvable", improvable},
              {"noise_in_objective", o.noise_in_objective},
              {"judged", o.judged}};
    if (o.noise.size() > 0) {
        json["noise"] = {{"objective", o.noise[0]}};
        for (size_t i = 0; i < design.constraints.size(); ++i)
            json["noise"][design.constraints[i].name] = o.noise[static_cast<Eigen::Index>(i) + 1] / design.constraints[i].bounds.unit;
    }
    json["refused"] = o.refused.empty() ? Json() : Json(o.refused);
    json["rough"] = o.roughest < 0 ? Json() : o.roughest == 0 ? Json("objective") : Json(roughest_name(design, o));
    return json;
}

// Names what limits a design: for an infeasible one the limits found; else requirements that cost something, the dearest first, then
// bounds.
std::vector<std::string> limited_by(const Design& design, const OptimiseOutcome& outcome) {
    const optimisers::Optimality& o = outcome.report.optimality;
    if (!outcome.report.feasible) return outcome.limits;
    std::vector<std::string> names;
    for (const Cost& cost : costs_of(design, o)) names.push_back(cost.requirement);
    for (size_t k = 0; k < o.held.size(); ++k) {
        if (o.held[k] != optimisers::Held::lower_bound && o.held[k] != optimisers::Held::upper_bound) continue;
        names.push_back(design.parameters[k].name + " (" + optimisers::to_string(o.held[k]) + ")");
    }
    return names;
}

Json repair_json(const Design& design, const optimisers::OptimiserReport& report) {
    Json changes = Json::object();
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        changes[p.name] = description::from_si(report.point[k], p.unit) - description::from_si(p.value, p.unit);
    }
    return {{"changes", changes}, {"distance", std::sqrt(report.best.objective)}};
}

}  // namespace

Json objective_json(const OptimiseOutcome& outcome, const RunFacts& run) {
    if (!outcome.report.best.usable) return {};
    return run.repair ? outcome.final.objective : outcome.report.best.objective;
}

Json outcome_json(const DesignProblem& problem, const OptimiseOutcome& outcome, const RunFacts& run) {
    const Design& design = problem.design();
    const optimisers::OptimiserReport& report = outcome.report;
    Json json;
    json["status"] = optimisers::to_string(report.status);
    json["message"] = report.message;
    const std::string why = why_not_optimal(design, outcome, run);
    json["why_not_optimal"] = why.empty() ? Json() : Json(why);
    json["summary"] = summary_json(summary_of(design, outcome, run));
    json["objective_start"] = outcome.objective_start ? Json(*outcome.objective_start) : Json();
    json["objective"] = objective_json(outcome, run);
    if (run.repair && report.best.usable) json["repair"] = repair_json(design, report);
    json["seed"] = run.seed;
    for (const core::model::JointSide& side : outcome.sides) json["sides"][side.joint] = core::model::to_string(side.assemble.side);
    json["parameters_start"] = parameters_json(design, outcome.start);
    json["parameters"] = parameters_json(design, report.point);
    json["units"] = units_json(design);
    json["evaluations"] = report.evaluations;
    json["failed_evaluations"] = report.failures;
    json["replayed_evaluations"] = outcome.replayed;
    json["iterations"] = report.iterations;
    json["optimality"] = report.best.usable && report.optimality.step.size() > 0 ? optimality_json(design, report.optimality) : Json();
    json["stages"] = stages_json(report);
    json["budget_spent"] = report.budget_spent;
    json["constraint_violation_start"] = report.start.usable ? Json(report.start.violation) : Json();
    json["constraint_violation"] = report.best.usable ? Json(report.best.violation) : Json();
    add_judged(design, outcome, json);
    for (size_t k = 0; k < outcome.finer.runs.size(); ++k)
        json["resolution"]["runs"][k]["change_of_best"] = finite_or_null(change_of_best(outcome, run, outcome.finer.runs[k]));
    json["unbuildable"] = outcome.unbuildable;
    std::vector<std::string> warnings = outcome.at_start.warnings;
    for (const std::string& warning : problem::motion_warnings(design, outcome.final)) warnings.push_back(warning);
    if (!warnings.empty()) json["warnings"] = warnings;
    if (!outcome.at_start.notes.empty()) json["notes"] = outcome.at_start.notes;
    if (!outcome.limits.empty()) json["limits"] = outcome.limits;
    json["limited_by"] = report.best.usable ? Json(limited_by(design, outcome)) : Json::array();
    json["out"] = run.out;
    return json;
}

}  // namespace fettle::design::answers
