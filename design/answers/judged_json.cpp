// SPDX-License-Identifier: MIT
#include "design/answers/judged_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "design/answers/answer_json.hpp"

namespace fettle::design::answers {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using problem::DesignEvaluation;
using studies::JudgedDesign;

Json constraints_json(const Design& design, const DesignEvaluation& final) {
    Json list = Json::array();
    for (size_t i = 0; i < final.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const description::Measurement& measured = final.constraints[i];
        list.push_back({{"name", constraint.name},
                        {"value", measured.value},
                        {"lower", measured.lower},
                        {"upper", measured.upper},
                        {"proven", measured.is_proven},
                        {"met", description::violation(constraint.bounds, measured) <= 0}});
        if (!measured.fault.empty()) list.back()["fault"] = measured.fault;
        if (Json continued = continued_json(final, i); !continued.is_null()) list.back()["continued"] = std::move(continued);
        if (Json over = over_tolerances_json(design, final, false, i); !over.is_null()) list.back()["over_tolerances"] = std::move(over);
    }
    return list;
}

Json terms_json(const Design& design, const DesignEvaluation& final) {
    Json list = Json::array();
    for (size_t k = 0; k < final.terms.size(); ++k) {
        list.push_back({{"name", design.objective[k].name}, {"value", final.terms[k].value}});
        if (Json over = over_tolerances_json(design, final, true, k); !over.is_null()) list.back()["over_tolerances"] = std::move(over);
    }
    return list;
}

// What the design measures by its own model and with the play of its fits taken up, SI.
// @param quantity  what no motion changes has no other value
Json measured_json(const std::string& name, const description::Quantity& quantity, const description::Measurement& own,
                   const description::Measurement& other) {
    return {{"name", name}, {"as_written", own.value}, {"play_taken_up", quantity.is_at_rest() ? Json() : Json(other.value)}};
}

Json by_models_json(const Design& design, const JudgedDesign& judged) {
    const DesignEvaluation &own = judged.final, &other = judged.play_taken_up;
    if (!other.usable) return {};
    Json terms = Json::array(), constraints = Json::array();
    for (size_t k = 0; k < own.terms.size(); ++k)
        terms.push_back(measured_json(design.objective[k].name, *design.objective[k].quantity, own.terms[k], other.terms[k]));
    for (size_t i = 0; i < own.constraints.size(); ++i)
        constraints.push_back(
            measured_json(design.constraints[i].name, *design.constraints[i].quantity, own.constraints[i], other.constraints[i]));
    Json in_doubt = Json::array();
    for (const size_t i : judged.in_doubt) in_doubt.push_back(design.constraints[i].name);
    return {{"model", judged.play_taken_up_by}, {"terms", terms}, {"constraints", constraints}, {"in_doubt", in_doubt}};
}

// What the design that was found owes to its facets and its time step; null: not known.
Json resolution_json(const Design& design, const JudgedDesign& judged) {
    const studies::FinerReport& report = judged.finer;
    if (report.runs.empty()) return {};
    Json runs = Json::array(), terms = Json::array(), constraints = Json::array(), flips = Json::array();
    for (const studies::FinerRun& run : report.runs) {
        runs.push_back({{"run", run.key}, {"objective", finite_or_null(run.objective)}});
        if (!run.failure.empty()) runs.back()["failure"] = run.failure;
    }
    for (const studies::FinerValue& value : studies::finer_values(design, judged.final, report)) {
        Json entry{{"name", value.name}, {"found", value.found}};
        for (const studies::FinerRun& run : report.runs) {
            const auto& measured = value.of_objective ? run.terms : run.constraints;
            entry[run.key] = run.failure.empty() ? Json(measured[static_cast<size_t>(value.index)].value) : Json();
        }
        entry["change"] = finite_or_null(value.share);
        if (!value.of_objective) {
            entry["met"] = value.is_met;
            entry["met_finer"] = value.is_met_finer;
            if (studies::is_flip(value)) flips.push_back(value.name);
        }
        (value.of_objective ? terms : constraints).push_back(std::move(entry));
    }
    return {{"runs", runs}, {"terms", terms}, {"constraints", constraints}, {"flips", flips}};
}

}  // namespace

void add_judged(const Design& design, const JudgedDesign& judged, Json& json) {
    json["by_models"] = by_models_json(design, judged);
    if (!judged.play_not_compared.empty()) json["play_not_compared"] = judged.play_not_compared;
    json["resolution"] = resolution_json(design, judged);
    json["terms"] = terms_json(design, judged.final);
    json["constraints"] = constraints_json(design, judged.final);
    json["relations"] = relations_json(design, judged.final.relations);
    std::vector<std::string> names;
    for (const core::scene::Body& body : design.scene.bodies) names.push_back(body.name);
    json["clearance"] = clearance_json(judged.clearance, names);
}

}  // namespace fettle::design::answers
