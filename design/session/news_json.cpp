// SPDX-License-Identifier: MIT
#include "design/session/news_json.hpp"

#include <algorithm>
#include <filesystem>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/clearance/clearance.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/judged_json.hpp"
#include "design/answers/summary.hpp"
#include "design/problem/motion_warnings.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/design_rows.hpp"
#include "design/report/moving_parts.hpp"
#include "design/report/packed_numbers.hpp"
#include "design/report/pair_rows.hpp"
#include "design/report/quantity_curves.hpp"
#include "design/report/report_data.hpp"

namespace fettle::design::session {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using description::Parameter;
using problem::DesignEvaluation;
using studies::JudgedDesign;

// "slider_crank.design.json" -> "slider_crank"
std::string name_of(const std::string& path) {
    const std::string file = std::filesystem::path(path).filename().string();
    return file.substr(0, file.find('.'));
}

// What the page's tables are made of: the answer of `fettle check`.
Json answer_of(const Design& design, const JudgedDesign& judged) {
    Json json;
    json["status"] = "ok";
    answers::add_judged(design, judged, json);
    return json;
}

Json requirements_of(const Design& design, const JudgedDesign& judged) {
    return report::requirement_rows(design, answer_of(design, judged));
}

Json parameter_json(const Parameter& parameter) {
    const auto shown = [&](double si) { return description::from_si(si, parameter.unit); };
    return {{"name", parameter.name},
            {"unit", parameter.unit.dimension == Dimension::number ? "" : std::string(parameter.unit.name)},
            {"value", shown(parameter.value)},
            {"lower", shown(parameter.lower)},
            {"upper", shown(parameter.upper)}};
}

Json objective_json(const Design& design) {
    Json list = Json::array();
    for (const description::ObjectiveTerm& term : design.objective)
        list.push_back(
            {{"name", term.name}, {"unit", core::base::unit_name(term.quantity->dimension(), term.unit)}, {"weight", term.weight}});
    return list;
}

void add_place_in_history(const News& news, Json& json) {
    json["values"] = answers::parameters_json(news.opened->design(), news.values);
    json["saved"] = news.is_as_in_file;
    json["can_undo"] = news.can_undo;
    json["can_redo"] = news.can_redo;
}

void add_motion(const std::shared_ptr<const core::model::Model>& model, const core::stepper::Trajectory& trajectory, Json& json) {
    const auto steps = count_of(trajectory.steps);
    json["motion"] = steps > 0;
    json["steps"] = steps;
    json["step"] = steps > 0 ? trajectory.timestep : 0.0;
    json["duration"] = core::stepper::time_at(trajectory, steps) - core::stepper::time_at(trajectory, 0);
    json["meshes"] = json["views"] = Json::array();
    report::add_view(json, "after", *model, trajectory);
    json["joints"] = Json::array();
    const Result<Posing> posing = Posing::of(model);
    if (posing) json["joints"] = handles_json(*posing);
}

// The parts as assembled at these values; where that cannot be made, as the file has it.
void add_start(const News& news, Json& json) {
    const problem::DesignProblem& problem = *news.opened->problem;
    Result<core::model::Model> model =
        problem.obstacles(news.values).empty() ? problem.model_at(news.values) : problem.model_at(news.opened->values());
    if (!model) return;
    const auto shared = std::make_shared<const core::model::Model>(std::move(model).value());
    add_motion(shared, core::clearance::as_assembled(*shared), json);
}

// The head that every page has, then the studio's own keys.
Json opened_json(const News& news) {
    const Opened& opened = *news.opened;
    const std::filesystem::path path = opened.file.path;
    report::ReportSource source;
    source.kind = report::ReportKind::optimise;
    source.folder = path.parent_path().string();
    source.name = name_of(opened.file.path);
    source.description = opened.is_scene ? "" : report::description_of(opened.file.text);
    source.gravity = opened.design().scene.gravity;
    source.result = {{"status", "ok"}, {"command", "fettle studio " + answers::shell_word(opened.file.path)}};
    source.design = opened.design();
    source.notices = opened.warnings;
    Json json = report::report_data(source);
    json["kind"] = "studio";
    json["file"] = path.filename().string();
    json["is_scene"] = opened.is_scene;
    json["revision"] = news.revision;
    json["parameters"] = Json::array();
    for (const Parameter& parameter : opened.design().parameters) json["parameters"].push_back(parameter_json(parameter));
    json["objective"] = objective_json(opened.design());
    json["joints"] = Json::array();
    add_place_in_history(news, json);
    add_start(news, json);
    return json;
}

Json faults_json(const News& news) {
    Json errors = Json::array();
    for (const Error& error : news.errors) errors.push_back({{"where", error.where}, {"message", error.message}});
    return {{"errors", errors}};
}

Json motion_json(const News& news) {
    const problem::Run& run = news.evaluation->runs.front();
    Json json{{"revision", news.revision}};
    add_motion(run.model, run.simulation.trajectory, json);
    return json;
}

Json numbers_json(const News& news, const JudgedDesign& judged) {
    const Design& design = news.opened->design();
    const answers::Summary summary = answers::summary_of(design, judged);
    return {{"revision", news.revision},
            {"requirements", requirements_of(design, judged)},
            {"objective", {{"value", report::finite(judged.final.objective)}}},
            {"met", judged.final.violation <= 0},
            {"message", summary.sentence},
            {"why", summary.why},
            {"notices", problem::motion_warnings(design, judged.final)},
            {"seconds", news.seconds}};
}

// Per one of each parameter's unit.
Json by_parameter(const Design& design, const VectorX& gradient, double unit) {
    Json json = Json::object();
    for (Eigen::Index k = 0; k < gradient.size(); ++k) {
        const Parameter& parameter = design.parameters[static_cast<std::size_t>(k)];
        json[parameter.name] = report::finite(gradient[k] * core::base::to_si(1, parameter.unit) / unit);
    }
    return json;
}

Json gradient_json(const News& news) {
    const Design& design = news.opened->design();
    const DesignEvaluation& e = *news.evaluation;
    Json rows = Json::array();
    if (!design.objective.empty())
        rows.push_back({{"of", "objective"}, {"name", "objective"}, {"unit", ""}, {"by", by_parameter(design, e.gradient, 1)}});
    for (std::size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const double unit = shown_unit_of(design, constraint.name);
        rows.push_back({{"of", "requirement"},
                        {"name", constraint.name},
                        {"unit", core::base::unit_name(constraint.quantity->dimension(), unit)},
                        {"by", by_parameter(design, e.jacobian.row(static_cast<Eigen::Index>(i)).transpose(), unit)}});
    }
    for (std::size_t i = 0; i < design.relations.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        rows.push_back(
            {{"of", "requirement"},
             {"name", relation.name},
             {"unit", description::unit_name(relation)},
             {"by", by_parameter(design, e.relations.jacobian.row(static_cast<Eigen::Index>(i)).transpose(), relation.bounds.unit)}});
    }
    return {{"revision", news.revision}, {"rows", rows}};
}

// What takes certificates over the motion: as the page of a run has it.
Json pairs_json(const News& news) {
    const Opened& opened = *news.opened;
    const problem::Run& run = news.judged->final.runs.front();
    report::ReportSource source;
    source.kind = opened.is_scene ? report::ReportKind::simulate : report::ReportKind::optimise;
    source.gravity = opened.design().scene.gravity;
    source.result = answer_of(opened.design(), *news.judged);
    source.motion = report::Motion{*run.model, run.simulation.trajectory, opened.file.scene_path};
    if (!opened.is_scene) {
        source.design = opened.design();
        source.values = news.values;
        source.quantities = report::quantities_with_curves(opened.file.quantities, opened.design());
        if (!opened.design().scenarios.empty()) source.scenario = opened.design().scenarios.front().name;
    }
    Json data = report::report_data(source, news.is_stale);
    Json json{{"revision", news.revision}};
    for (const char* key : {"pairs", "pair_count", "margins", "scenarios", "requirements"}) json[key] = std::move(data[key]);
    return json;
}

Json tuning_json(const News& news) {
    const Tuning& tuning = news.tuning;
    const bool has_best = tuning.values.size() > 0;
    return {{"state", tuning.runs ? "running" : "ended"},
            {"revision", news.revision},
            {"evaluations", tuning.evaluations},
            {"values", has_best ? answers::parameters_json(news.opened->design(), tuning.values) : Json()},
            {"objective", has_best ? report::finite(tuning.objective) : Json()},
            {"violation", has_best ? report::finite(tuning.violation) : Json()},
            {"message", tuning.message}};
}

}  // namespace

double unit_of(const JointHandle& handle) { return handle.is_angle ? core::base::to_si(1, *find_unit("deg")) : report::millimetre; }

Json handles_json(const Posing& posing) {
    Json list = Json::array();
    for (const JointHandle& handle : posing.handles()) {
        const double unit = unit_of(handle);
        list.push_back({{"name", handle.name},
                        {"unit", handle.is_angle ? "deg" : "mm"},
                        {"start", handle.start / unit},
                        {"low", handle.low / unit},
                        {"high", handle.high / unit},
                        {"has_limits", handle.has_limits},
                        {"moves", handle.moves}});
    }
    return list;
}

Json posed_json(const Posed& posed, const core::model::Model& model) {
    std::vector<float> poses;
    for (const core::kinematics::Pose& pose : posed.poses) report::append_pose(poses, pose);
    const core::stepper::Trajectory start = core::clearance::as_assembled(model);
    Json pairs = Json::array();
    for (std::size_t k = 0; k < std::min(posed.pairs.size(), report::most_pairs); ++k)
        pairs.push_back(report::pair_row(posed.pairs[k], model, start));
    report::leave_out_distances(pairs);
    return {{"poses", report::packed(poses)}, {"pairs", pairs}};
}

double shown_unit_of(const Design& design, const std::string& name) {
    for (const description::Constraint& constraint : design.constraints)
        if (constraint.name == name) return report::shown_unit(constraint.quantity->dimension(), constraint.bounds.unit);
    for (const description::Relation& relation : design.relations)
        if (relation.name == name) return relation.bounds.unit;
    return 1;
}

Result<Session::Values> values_from(const Json& values, const Opened& opened) {
    if (!values.is_object()) return Error{ErrorCode::wrong_type, "values", "an object of numbers by parameter is expected"};
    Session::Values si;
    for (const auto& [name, value] : values.items()) {
        if (!value.is_number()) return Error{ErrorCode::wrong_type, name, "a number is expected"};
        si[name] = value.get<double>();  // of a name that is unknown, which is the session's to tell
        for (const Parameter& parameter : opened.design().parameters)
            if (parameter.name == name) si[name] = core::base::to_si(value.get<double>(), parameter.unit);
    }
    return si;
}

std::vector<ToldNews> told(const News& news) {
    switch (news.kind) {
        case NewsKind::opened:
            return {{"opened", opened_json(news)}};
        case NewsKind::faults:
            return {{"fault", faults_json(news)}};
        case NewsKind::asked: {
            Json json{{"revision", news.revision}};
            add_place_in_history(news, json);
            return {{"asked", json}};
        }
        case NewsKind::progress:
            return {{"progress", {{"revision", news.revision}, {"doing", news.text}, {"step", news.step}, {"steps", news.steps}}}};
        case NewsKind::refused:
            return {{"refused", {{"revision", news.revision}, {"reason", news.text}}}};
        case NewsKind::measured: {
            JudgedDesign judged;
            judged.final = *news.evaluation;
            return {{"motion", motion_json(news)}, {"numbers", numbers_json(news, judged)}};
        }
        case NewsKind::differentiated:
            return {{"gradient", gradient_json(news)}};
        case NewsKind::judged:
            return {{"numbers", numbers_json(news, *news.judged)}, {"pairs", pairs_json(news)}};
        case NewsKind::settled:
            return {{"settled", {{"revision", news.revision}, {"seconds", news.seconds}}}};
        case NewsKind::tuning:
            return {{"tune", tuning_json(news)}};
    }
    return {};
}

}  // namespace fettle::design::session
