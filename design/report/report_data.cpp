// SPDX-License-Identifier: MIT
#include "design/report/report_data.hpp"

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/json_dump.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/design_rows.hpp"
#include "design/report/moving_parts.hpp"
#include "design/report/pair_rows.hpp"
#include "design/report/quantity_curves.hpp"
#include "design/report/search_curves.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;

const char* word(ReportKind kind) {
    switch (kind) {
        case ReportKind::optimise:
            return "optimise";
        case ReportKind::clearance:
            return "clearance";
        case ReportKind::simulate:
            break;
    }
    return "simulate";
}

void add_head(Json& data, const ReportSource& source) {
    const Json& result = source.result;
    const std::string own = core::base::version();
    data["format"] = 1;
    data["program"] = result.value("program", own);
    if (data["program"] != own) data["made_by_other"] = own;
    data["command"] = member(result, "command");
    data["kind"] = word(source.kind);
    data["name"] = source.name;
    data["folder"] = source.folder;
    data["description"] = source.description.empty() ? Json() : Json(source.description);
    const Vector3 up = source.gravity.norm() > 0 ? Vector3(-source.gravity.normalized()) : Vector3(Vector3::UnitZ());
    data["up"] = {up.x(), up.y(), up.z()};
    data["status"] = member(result, "status");
    data["message"] = member(result, "message");
    const Json least = member(result, "minimum_distance");
    data["least"] = least.is_number() ? Json(least.get<double>() / millimetre) : Json();
}

void add_optimisation(Json& data, const ReportSource& source) {
    const Json& result = source.result;
    data["objective"] = {{"start", member(result, "objective_start")}, {"end", member(result, "objective")}};
    data["summary"] = member(result, "summary");
    data["evaluations"] = member(result, "evaluations");
    data["failed"] = member(result, "failed_evaluations");
    data["violation"] = member(result, "constraint_violation");
    data["repair"] = member(result, "repair");
    data["why_not_optimal"] = member(result, "why_not_optimal");
    const Json starts = member(result, "starts"), optimality = member(result, "optimality");
    if (starts.is_array())
        data["notices"].push_back("The best of " + std::to_string(starts.size()) + " starts, seed " +
                                  core::files::dumped(member(result, "seed")) + "; the table of starts has all.");
    const Json choices = member(result, "choices"), best = member(choices, "best");
    if (best.is_object()) {
        std::string options;
        for (const auto& [name, option] : best.items())
            options += ", " + name + " " + (option.is_string() ? option.get<std::string>() : core::files::dumped(option));
        data["notices"].push_back("The best of " + std::to_string(member(choices, "tried").size()) + " combinations" + options +
                                  "; result.json has all.");
    }
    data["optimality"] = optimality.is_object() ? Json{{"worth", member(optimality, "worth")}} : Json();
}

bool is_of_faces(const quantities::ClearanceRange& range) { return !range.faces_a.empty() || !range.faces_b.empty(); }

constexpr int shown_scenario = 0;  // whose motion the picture begins with

// The steps of the motion that an answer's pairs are about; none for pairs whose margin over the motion is not that of the two bodies.
std::vector<StepRange> steps_of(const ReportSource& source, std::size_t pairs) {
    const auto all = count_of(source.motion->trajectory.steps);
    if (source.kind == ReportKind::clearance) return std::vector<StepRange>(pairs, {0, member(source.result, "motion") == true ? all : 0});
    std::vector<StepRange> steps;
    for (const auto& constraint : source.design ? source.design->constraints : std::vector<description::Constraint>()) {
        const quantities::ClearanceRange* clearance = quantities::clearance_of(*constraint.quantity);
        if (clearance == nullptr) continue;
        const quantities::ClearanceRange& range = *clearance;
        if (!range.motion || is_of_faces(range) || quantities::scenario_of(*constraint.quantity) != shown_scenario) {
            steps.emplace_back();
            continue;
        }
        const auto [first, last] = quantities::steps_of(range, source.motion->trajectory.timestep, all);
        steps.push_back({first, last});
    }
    return steps;
}

void add_note(Json& row, const std::string& note) {
    row["note"] = row["note"].is_string() ? row["note"].get<std::string>() + "; " + note : note;
}

// What a design's rows are about that are not about two whole bodies on the path that is shown.
void note_ranges(const description::Design& design, Json& rows) {
    std::size_t k = 0;
    for (const description::Constraint& constraint : design.constraints) {
        const quantities::ClearanceRange* clearance = quantities::clearance_of(*constraint.quantity);
        if (clearance == nullptr || k >= rows.size()) continue;
        Json& row = rows[k++];
        const quantities::ClearanceRange& range = *clearance;
        const int scenario = range.motion ? quantities::scenario_of(*constraint.quantity) : shown_scenario;
        const bool is_elsewhere = range.ranges || scenario != shown_scenario;  // than on the path
        if (is_elsewhere) row["point_a"] = row["point_b"] = Json();
        if (scenario != shown_scenario) add_note(row, "in the scenario " + design.scenarios[static_cast<std::size_t>(scenario)].name);
        if (!range.ranges && !is_of_faces(range)) continue;
        const auto faces = [](const std::string& body, const std::vector<std::string>& names) {
            return names.empty() ? body : body + " " + core::base::joined(names);
        };
        const std::string pair = faces(row["a"], range.faces_a) + " and " + faces(row["b"], range.faces_b);
        const std::string note = (is_of_faces(range) ? "between " + pair + " alone" : std::string()) +
                                 (range.ranges ? std::string(is_of_faces(range) ? ", " : "") + "over all positions of the joints" : "");
        add_note(row, note);
    }
}

Json pairs_of(const ReportSource& source, const std::function<bool()>& should_stop) {
    if (source.kind == ReportKind::simulate) {
        if (should_stop()) return Json::array();
        const Json least = member(source.result, "minimum_distance");
        return nearest_pairs(source.motion->model, source.motion->trajectory, least.is_number() ? least.get<double>() : 0, should_stop);
    }
    const Json& result = source.result;
    const Json pairs = member(source.kind == ReportKind::clearance ? result : member(result, "clearance"), "pairs");
    if (!pairs.is_array()) return Json::array();
    Json rows = told_pairs(pairs, source.motion->model, steps_of(source, pairs.size()));
    if (source.kind == ReportKind::optimise && source.design) note_ranges(*source.design, rows);
    return rows;
}

Json scenario_data(const ReportSource& source, const Json& name, const std::string& view, const Motion& motion, const StepCurves& steps) {
    Json curves = Json::array();
    if (source.design)
        curves = quantity_curves(source.quantities, {motion.model, motion.trajectory, source.design->clearance_tolerance,
                                                     description::names_of(source.design->parameters), source.values});
    return {{"name", name}, {"view", view}, {"quantities", curves}, {"series", steps.charts()}};
}

void add_motion(Json& data, const ReportSource& source, const std::function<bool()>& should_stop) {
    const core::stepper::Trajectory& trajectory = source.motion->trajectory;
    const auto steps = count_of(trajectory.steps);
    data["motion"] = steps > 0;
    data["steps"] = steps;
    data["step"] = steps > 0 ? trajectory.timestep : 0.0;
    data["duration"] = core::stepper::time_at(trajectory, steps) - core::stepper::time_at(trajectory, 0);
    if (source.before) add_view(data, "before", source.before->model, source.before->trajectory);
    add_view(data, "after", source.motion->model, trajectory);
    const Json& every = data["views"].back()["every"];
    if (every > 1) data["notices"].push_back("The picture shows every " + std::to_string(every.get<int>()) + "th step.");
    data["pairs"] = pairs_of(source, should_stop);
    const Json all = source.kind == ReportKind::clearance ? member(source.result, "pairs") : Json();
    data["pair_count"] = all.is_array() ? all.size() : data["pairs"].size();
    data["margins"] = should_stop() ? Json() : margin_curves(data["pairs"], source.motion->model, trajectory, should_stop);
    leave_out_distances(data["pairs"]);
    data["scenarios"] = Json::array();
    const Json name = source.scenario.empty() ? Json() : Json(source.scenario);
    data["scenarios"].push_back(scenario_data(source, name, "after", *source.motion, source.steps));
    for (const ScenarioMotion& other : source.others) {
        const std::string view = "scenario " + other.name;
        add_view(data, view, other.motion.model, other.motion.trajectory);
        data["scenarios"].push_back(scenario_data(source, other.name, view, other.motion, other.steps));
    }
}

}  // namespace

std::optional<ReportKind> kind_of(const Json& result) {
    if (!result.is_object() || !result.contains("status")) return std::nullopt;
    if (result.contains("parameters_start")) return ReportKind::optimise;
    if (result.contains("certification")) return ReportKind::simulate;
    if (result.contains("pairs") && result.contains("source")) return ReportKind::clearance;
    return std::nullopt;
}

Json report_data(const ReportSource& source, const std::function<bool()>& should_stop) {
    Json data;
    add_head(data, source);
    data["notices"] = source.notices;
    for (const char* key : {"warnings", "notes", "unbuildable"})
        for (const Json& text : member(source.result, key)) data["notices"].push_back(text);
    data["motion"] = false;
    data["steps"] = 0;
    data["step"] = data["duration"] = 0.0;
    data["meshes"] = data["views"] = data["pairs"] = data["scenarios"] = Json::array();
    data["pair_count"] = 0;
    data["margins"] = data["history"] = data["series_note"] = Json();
    data["requirements"] = source.design ? requirement_rows(*source.design, source.result) : Json::array();
    data["parameters"] = source.design ? parameter_rows(*source.design, source.result) : Json::array();
    data["resolution"] = source.design ? resolution_data(*source.design, source.result) : Json();
    data["starts"] = source.design ? start_rows(*source.design, source.result) : Json::array();
    data["ranges"] = member(source.result, "source") == "over the ranges of the joints";
    data["files"] = source.files;
    const Json limits = member(source.result, "limits");
    data["limits"] = limits.is_array() ? limits : Json::array();
    if (source.kind == ReportKind::optimise) add_optimisation(data, source);
    if (source.design && !source.history.empty()) data["history"] = search_curves(source.history, *source.design);
    if (source.motion) add_motion(data, source, should_stop);
    if (!source.motion)  // their gaps have no picture
        for (Json& row : data["requirements"]) row["pair"] = Json();
    return data;
}

}  // namespace fettle::design::report
