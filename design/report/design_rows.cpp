// SPDX-License-Identifier: MIT
#include "design/report/design_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "design/description/requirement_text.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/report/answer_values.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;

Json in_unit(double si, double unit) { return std::isfinite(si) ? Json(si / unit) : Json(); }
Json in_unit(const Json& si, double unit) { return si.is_number() ? in_unit(si.get<double>(), unit) : Json(); }

// A row of `result` with the bounds that it is judged by.
Json row_json(const std::string& name, const Json& told, const description::Bounds& bounds, double unit) {
    return {{"name", name},
            {"unit", ""},
            {"lower", in_unit(member(told, "lower"), unit)},
            {"upper", in_unit(member(told, "upper"), unit)},
            {"proven", member(told, "proven") == true},
            {"required_lower", in_unit(bounds.lower, unit)},
            {"required_upper", in_unit(bounds.upper, unit)},
            {"met", member(told, "met").is_boolean() && told["met"].get<bool>()},
            {"fault", told.contains("fault") ? told["fault"] : member(member(told, "continued"), "reason")},
            {"cost", Json()},
            {"counts", false},
            {"pair", Json()},
            {"play_taken_up", Json()},
            {"in_doubt", false}};
}

bool is_clearance(const description::Constraint& constraint) { return quantities::clearance_of(*constraint.quantity) != nullptr; }

// How many of the constraints are clearances: each has a pair in the result, in their order.
bool pairs_match(const description::Design& design, const Json& result) {
    std::size_t clearances = 0;
    for (const auto& constraint : design.constraints) clearances += is_clearance(constraint) ? 1 : 0;
    const Json pairs = member(member(result, "clearance"), "pairs");
    return pairs.is_array() && pairs.size() == clearances;
}

// The largest difference of a parameter, in its range.
Json away(const description::Design& design, const Json& from, const Json& to) {
    double most = 0;
    for (const description::Parameter& p : design.parameters) {
        const Json a = member(from, p.name), b = member(to, p.name);
        if (!a.is_number() || !b.is_number()) return {};
        const double range = description::from_si(p.upper, p.unit) - description::from_si(p.lower, p.unit);
        most = std::max(most, std::abs(a.get<double>() - b.get<double>()) / range);
    }
    return in_unit(most, 1);
}

// The numbers of all runs of one entry of `resolution`, and whether they are met.
Json resolved_row(const Json& entry, const char* of, double unit, Dimension dimension, const Json& runs, const Json& flips) {
    Json finer = Json::array();
    for (const Json& run : runs) finer.push_back(in_unit(member(entry, run["run"].get<std::string>()), unit));
    return {{"name", member(entry, "name")},
            {"of", of},
            {"unit", core::base::unit_name(dimension, unit)},
            {"found", in_unit(member(entry, "found"), unit)},
            {"finer", finer},
            {"change", in_unit(member(entry, "change"), 1)},
            {"met", member(entry, "met")},
            {"met_finer", member(entry, "met_finer")},
            {"flips", flips.is_array() && std::find(flips.begin(), flips.end(), member(entry, "name")) != flips.end()}};
}

// The objective, which the check tells by run.
Json resolved_objective(const Json& result, const Json& told) {
    const Json found = member(result, "objective");
    Json finer = Json::array(), change;
    for (const Json& run : told) {
        finer.push_back(in_unit(member(run, "objective"), 1));
        if (!finer.back().is_number() || !found.is_number()) continue;
        const double a = found.get<double>(), b = finer.back().get<double>(), size = std::max(std::abs(a), std::abs(b));
        const double share = size > 0 ? std::abs(a - b) / size : 0;
        change = change.is_number() ? std::max(change.get<double>(), share) : share;
    }
    return {{"name", "objective"}, {"of", "objective"}, {"unit", ""},    {"found", in_unit(found, 1)},
            {"finer", finer},      {"change", change},  {"met", Json()}, {"met_finer", Json()},
            {"flips", false}};
}

double number_or_infinity(const Json& json) { return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity(); }

// As the best one is chosen: what is minimised, of those that meet all requirements, else the violation.
std::tuple<double, double, double> rank_of_start(const Json& row) {
    const Json& minimised = row["distance"].is_number() ? row["distance"] : row["objective"];
    return {row["taken"].get<bool>() ? 0 : 1, std::max(0.0, number_or_infinity(row["violation"])), number_or_infinity(minimised)};
}

}  // namespace

double shown_unit(Dimension dimension, double unit) { return dimension == Dimension::length ? millimetre : unit; }

Json requirement_rows(const description::Design& design, const Json& result) {
    Json rows = Json::array();
    const Json others = member(member(result, "by_models"), "constraints"), in_doubt = member(member(result, "by_models"), "in_doubt");
    const Json told = member(result, "constraints"), optimality = member(result, "optimality"), costs = member(optimality, "multipliers");
    const Json worth = member(optimality, "worth");
    const auto counts = [&](double per_unit) {
        return worth.is_number() && per_unit != 0 && std::abs(per_unit) * 0.01 >= worth.get<double>() * 0.1;
    };
    const bool matched = pairs_match(design, result);
    int pair = 0;
    for (std::size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const Dimension dimension = constraint.quantity->dimension();
        const double unit = shown_unit(dimension, constraint.bounds.unit);
        Json row = row_json(constraint.name, i < told.size() ? told[i] : Json(), constraint.bounds, unit);
        row["unit"] = core::base::unit_name(dimension, unit);
        row["play_taken_up"] = i < others.size() ? in_unit(member(others[i], "play_taken_up"), unit) : Json();
        row["in_doubt"] = in_doubt.is_array() && std::find(in_doubt.begin(), in_doubt.end(), Json(constraint.name)) != in_doubt.end();
        if (const Json cost = member(costs, constraint.name); cost.is_number()) {
            const double per_unit = cost.get<double>() * unit / constraint.bounds.unit;
            row["cost"] = per_unit;
            row["counts"] = counts(per_unit);
        }
        if (matched && is_clearance(constraint)) row["pair"] = pair++;
        rows.push_back(std::move(row));
    }
    const Json relations = member(result, "relations"), of_relations = member(optimality, "relation_multipliers");
    for (std::size_t i = 0; i < design.relations.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        Json row = row_json(relation.name, i < relations.size() ? relations[i] : Json(), relation.bounds, relation.bounds.unit);
        const Json value = in_unit(member(i < relations.size() ? relations[i] : Json(), "value"), relation.bounds.unit);
        row["unit"] = description::unit_name(relation);
        row["lower"] = row["upper"] = value;  // known, not bounded
        if (const Json cost = member(of_relations, relation.name); cost.is_number()) {
            row["cost"] = cost;
            row["counts"] = counts(cost.get<double>());
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

Json resolution_data(const description::Design& design, const Json& result) {
    const Json resolution = member(result, "resolution"), told = member(resolution, "runs");
    Json runs = Json::array(), rows = Json::array();
    if (!told.is_array()) return {};
    for (const Json& run : told) {
        if (!member(run, "run").is_string()) return {};
        const Json failure = member(run, "failure");
        runs.push_back({{"run", run["run"]},
                        {"failure", failure.is_string() ? failure : Json()},
                        {"change_of_best", in_unit(member(run, "change_of_best"), 1)}});
    }
    const Json terms = member(resolution, "terms"), constraints = member(resolution, "constraints"), flips = member(resolution, "flips");
    if (runs.empty() || !terms.is_array() || !constraints.is_array()) return {};
    const Json none{{"runs", runs}, {"rows", rows}};  // no run has numbers
    if (terms.size() != design.objective.size() || constraints.size() != design.constraints.size()) return none;
    if (design.objective.size() > 1) rows.push_back(resolved_objective(result, told));
    for (std::size_t k = 0; k < design.objective.size(); ++k) {
        const Dimension dimension = design.objective[k].quantity->dimension();
        rows.push_back(resolved_row(terms[k], "term", shown_unit(dimension, design.objective[k].unit), dimension, runs, flips));
    }
    for (std::size_t i = 0; i < design.constraints.size(); ++i) {
        const Dimension dimension = design.constraints[i].quantity->dimension();
        rows.push_back(
            resolved_row(constraints[i], "constraint", shown_unit(dimension, design.constraints[i].bounds.unit), dimension, runs, flips));
    }
    return {{"runs", runs}, {"rows", rows}};
}

Json parameter_rows(const description::Design& design, const Json& result) {
    Json rows = Json::array();
    const Json optimality = member(result, "optimality"), held = member(optimality, "held_by"),
               improvable = member(optimality, "improvable");
    for (const description::Parameter& p : design.parameters) {
        Json step;
        for (const Json& each : improvable)
            if (each.is_object() && each.value("parameter", "") == p.name) step = member(each, "step");
        rows.push_back({{"name", p.name},
                        {"unit", p.unit.dimension == Dimension::number ? std::string() : std::string(p.unit.name)},
                        {"start", member(member(result, "parameters_start"), p.name)},
                        {"end", member(member(result, "parameters"), p.name)},
                        {"lower", description::from_si(p.lower, p.unit)},
                        {"upper", description::from_si(p.upper, p.unit)},
                        {"held", member(held, p.name)},
                        {"step", step}});
    }
    return rows;
}

Json start_rows(const description::Design& design, const Json& result) {
    Json rows = Json::array();
    const Json starts = member(result, "starts"), seed = member(result, "seed"), parameters = member(result, "parameters");
    if (!starts.is_array()) return rows;
    for (const Json& start : starts) {
        const Json limits = member(start, "limited_by");
        rows.push_back({{"seed", member(start, "seed")},
                        {"status", member(start, "status")},
                        {"taken", member(start, "seed") == seed},
                        {"objective", member(start, "objective")},
                        {"violation", member(start, "constraint_violation")},
                        {"evaluations", member(start, "evaluations")},
                        {"distance", member(member(start, "repair"), "distance")},
                        {"away", away(design, member(start, "parameters"), parameters)},
                        {"limits", limits.is_array() ? limits : Json::array()},
                        {"message", member(start, "message")}});
    }
    std::stable_sort(rows.begin(), rows.end(), [](const Json& x, const Json& y) { return rank_of_start(x) < rank_of_start(y); });
    return rows;
}

}  // namespace fettle::design::report
