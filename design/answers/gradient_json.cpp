// SPDX-License-Identifier: MIT
#include "design/answers/gradient_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "design/answers/answer_json.hpp"
#include "design/answers/check_faults.hpp"
#include "design/description/constraint.hpp"
#include "design/gradient_audit/design_line.hpp"
#include "design/problem/motion_warnings.hpp"

namespace fettle::design::answers {

using description::Design;
using description::Parameter;
using gradient_audit::CheckReport;
using gradient_audit::CheckRow;
using gradient_audit::QuantityRoughness;
using gradient_audit::RoughnessReport;
using problem::DesignEvaluation;
using Json = nlohmann::ordered_json;

const problem::Tie* tie_of(const DesignEvaluation& evaluation, bool of_objective, size_t index) {
    for (const problem::Tie& tie : evaluation.ties)
        if (tie.of_objective == of_objective && tie.index == static_cast<int>(index)) return &tie;
    return nullptr;
}

double parameter_unit(const Design& design, const std::string& parameter) {
    for (const Parameter& p : design.parameters) {
        if (p.name == parameter) return to_si(1, p.unit);
    }
    return 1;
}

gradient_audit::GradientWarnings gradient_warnings(const Design& design, const DesignEvaluation& evaluation) {
    gradient_audit::GradientWarnings found = gradient_audit::gradient_warnings(design, gradient_audit::quantities_of(evaluation),
                                                                               gradient_audit::quantity_gradients(evaluation));
    const std::vector<std::string> motion = problem::motion_warnings(design, evaluation);
    found.warnings.insert(found.warnings.begin(), motion.begin(), motion.end());
    return found;
}

Json not_evaluated_json(const DesignEvaluation& evaluation) {
    Json json;
    json["status"] = evaluation.interrupted ? "interrupted" : "not_evaluated";
    json["message"] = evaluation.reason;
    return json;
}

namespace {

void add_tie(const Design& design, const problem::Tie* tie, Json& entry) {
    if (tie == nullptr) return;
    entry["ties"] = {{"witnesses", tie->branches},
                     {"gradient_least", gradient_json(design, tie->least)},
                     {"gradient_greatest", gradient_json(design, tie->greatest)}};
}

}  // namespace

Json values_json(const Design& design, const DesignEvaluation& evaluation) {
    Json json;
    json["status"] = "ok";
    json["objective"] = evaluation.objective;
    json["gradient"] = gradient_json(design, evaluation.gradient);
    json["units"] = units_json(design);
    Json terms = Json::array();
    for (size_t k = 0; k < design.objective.size(); ++k) {
        terms.push_back({{"name", design.objective[k].name}, {"weight", design.objective[k].weight}, {"value", evaluation.terms[k].value}});
        add_tie(design, tie_of(evaluation, true, k), terms.back());
        if (Json over = over_tolerances_json(design, evaluation, true, k); !over.is_null())
            terms.back()["over_tolerances"] = std::move(over);
    }
    json["terms"] = terms;
    Json list = Json::array();
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const description::Measurement& measured = evaluation.constraints[i];
        Json entry;
        entry["name"] = constraint.name;
        entry["value"] = measured.value;
        entry["proven"] = measured.is_proven;
        entry["certified_lower"] = measured.is_proven ? Json(measured.lower) : Json();
        entry["lower"] = finite_or_null(constraint.bounds.lower);
        entry["upper"] = finite_or_null(constraint.bounds.upper);
        entry["met"] = description::violation(constraint.bounds, measured) <= 0;
        if (!measured.fault.empty()) entry["fault"] = measured.fault;
        if (Json continued = continued_json(evaluation, i); !continued.is_null()) {
            continued["gradient"] = gradient_json(design, search_jacobian(evaluation).row(i).transpose());
            entry["continued"] = std::move(continued);
        }
        if (Json over = over_tolerances_json(design, evaluation, false, i); !over.is_null()) entry["over_tolerances"] = std::move(over);
        entry["gradient"] = gradient_json(design, evaluation.jacobian.row(i).transpose());
        add_tie(design, tie_of(evaluation, false, i), entry);
        list.push_back(std::move(entry));
    }
    json["constraints"] = list;
    json["relations"] = relations_json(design, evaluation.relations);
    const gradient_audit::GradientWarnings found = gradient_warnings(design, evaluation);
    if (!found.warnings.empty()) json["warnings"] = found.warnings;
    if (!found.notes.empty()) json["notes"] = found.notes;
    json["forward_seconds"] = evaluation.forward_seconds;
    json["backward_seconds"] = evaluation.backward_seconds;
    return json;
}

namespace {

Json direction_json(const Design& design, const VectorX& direction) {
    Json json = Json::object();
    for (size_t k = 0; k < design.parameters.size(); ++k) json[design.parameters[k].name] = direction[k];
    return json;
}

Json roughness_json(const Design& design, const RoughnessReport& report) {
    Json json;
    json["measured"] = report.measured;
    if (!report.failures.empty()) json["failures"] = report.failures;
    if (!report.measured) return json;
    json["direction"] = direction_json(design, report.direction);
    json["spacing"] = report.spacing;
    Json list = Json::array();
    for (const QuantityRoughness& quantity : report.quantities) {
        list.push_back({{"quantity", quantity.name},
                        {"noise", quantity.noise.noise},
                        {"noise_status", to_string(quantity.noise.status)},
                        {"rounding", quantity.rounding},
                        {"holds", quantity.holds},
                        {"breaks", finite_or_null(quantity.breaks)},
                        {"tolerance", quantity.tolerance},
                        {"rough", quantity.rough}});
    }
    json["quantities"] = list;
    json["remedies"] = gradient_audit::roughness_remedies(design, report);
    return json;
}

Json contact_changes_json(const Design& design, const CheckReport& report) {
    Json list = Json::array();
    for (const gradient_audit::ContactChange& change : report.contact_changes) {
        const double unit = parameter_unit(design, change.parameter);
        const gradient_audit::ContactState &was = change.at.was, &is = change.at.is;
        list.push_back({{"parameter", change.parameter},
                        {"from", change.from / unit},
                        {"to", change.to / unit},
                        {"event", to_string(change.at.event)},
                        {"a", change.body_a},
                        {"b", change.body_b},
                        {"features", {to_string(is.on_a.kind), to_string(is.on_b.kind)}},
                        {"features_before", {to_string(was.on_a.kind), to_string(was.on_b.kind)}},
                        {"time", change.time},
                        {"place", {is.place.x(), is.place.y(), is.place.z()}},
                        {"contacts", change.count},
                        {"others", change.at.others},
                        {"gradient_jumps", is_kink(change.at.event)}});
        if (!change.scenario.empty()) list.back()["scenario"] = change.scenario;
    }
    return list;
}

}  // namespace

Json check_json(const Design& design, const CheckReport& report, double limit) {
    Json json;
    json["check_faults"] = check_faults(report, limit);
    Json rows = Json::array();
    for (const CheckRow& row : report.rows) {
        const double factor = parameter_unit(design, row.parameter);
        rows.push_back({{"parameter", row.parameter},
                        {"quantity", row.quantity},
                        {"adjoint", row.adjoint * factor},
                        {"difference", row.difference * factor},
                        {"relative_error", row.relative_error},
                        {"difference_error", finite_or_null(row.difference_error)},
                        {"kink", row.kink * factor},
                        {"lies_between", row.lies_between},
                        {"resolved", row.resolved}});
    }
    json["check"] = rows;
    Json along = Json::array();
    for (const gradient_audit::LineRow& row : report.along)
        along.push_back({{"quantity", row.quantity},
                         {"adjoint", row.adjoint},
                         {"difference", row.difference},
                         {"relative_error", row.relative_error},
                         {"difference_error", finite_or_null(row.difference_error)},
                         {"resolved", row.resolved},
                         {"kink", row.kink},
                         {"lies_between", row.lies_between},
                         {"remainder_slope", finite_or_null(row.slope)}});
    json["along_gradient"] = along;
    json["sweeps_disagreement"] = finite_or_null(report.sweeps.disagreement);
    if (!report.sweeps.failure.empty()) json["sweeps_failure"] = report.sweeps.failure;
    json["left_out"] = report.left_out;
    json["largest_relative_error"] = report.largest_relative_error;
    json["check_simulations"] = report.simulations;
    json["first_step"] = report.first_step;
    json["not_checked"] = report.failures;
    json["contact_changes"] = contact_changes_json(design, report);
    json["contacts_reach"] = Json::object();
    for (Eigen::Index k = 0; k < report.contacts_reach.rows(); ++k)
        json["contacts_reach"][design.parameters[k].name] = {report.contacts_reach(k, 0), report.contacts_reach(k, 1)};
    json["roughness"] = roughness_json(design, report.roughness);
    return json;
}

}  // namespace fettle::design::answers
