// SPDX-License-Identifier: MIT
/// fettle optimise DESIGN: tunes the parameters, and certifies the final design.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/studies/optimise_file.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using optimisers::OptimiserStatus;
using problem::DesignEvaluation;
using problem::DesignProblem;
using studies::OptimiseOutcome;

struct OptimiseArguments {
    std::string path, optimiser, out;
    bool resume = false;
};

Json constraints_json(const Design& design, const DesignEvaluation& final) {
    Json list = Json::array();
    for (size_t i = 0; i < final.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const description::Measurement& measured = final.constraints[i];
        list.push_back({{"name", constraint.name},
                        {"value", measured.value},
                        {"lower", measured.lower},
                        {"upper", measured.upper},
                        {"met", description::violation(constraint.bounds, measured) <= 0}});
        if (!measured.fault.empty()) list.back()["fault"] = measured.fault;
    }
    return list;
}

Json terms_json(const Design& design, const DesignEvaluation& final) {
    Json list = Json::array();
    for (size_t k = 0; k < final.terms.size(); ++k) list.push_back({{"name", design.objective[k].name}, {"value", final.terms[k].value}});
    return list;
}

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
        residual[design.parameters[k].name] = o.residual[static_cast<Eigen::Index>(k)];
        held[design.parameters[k].name] = optimisers::to_string(o.held[k]);
    }
    for (const int k : o.improvable) {
        const description::Parameter& p = design.parameters[static_cast<size_t>(k)];
        improvable.push_back({{"parameter", p.name}, {"step", description::from_si(o.step[k], p.unit)}});
    }
    Json multipliers = Json::object();
    for (size_t i = 0; i < design.constraints.size(); ++i)
        multipliers[design.constraints[i].name] = o.multipliers[static_cast<Eigen::Index>(i)] * design.constraints[i].bounds.unit;
    Json json{{"multipliers", multipliers}, {"predicted_gain", o.predicted_gain},
              {"worth", o.worth},           {"radius", o.radius},
              {"residual", residual},       {"held_by", held},
              {"improvable", improvable},   {"noise_in_objective", o.noise_in_objective},
              {"judged", o.judged}};
    if (o.noise.size() > 0) {
        json["noise"] = {{"objective", o.noise[0]}};
        for (size_t i = 0; i < design.constraints.size(); ++i)
            json["noise"][design.constraints[i].name] = o.noise[static_cast<Eigen::Index>(i) + 1] / design.constraints[i].bounds.unit;
    }
    const auto rough = static_cast<size_t>(std::max(0, o.roughest - 1));
    json["rough"] = Json();
    if (o.roughest >= 0)
        json["rough"] = o.roughest == 0 || rough >= design.constraints.size() ? "objective" : design.constraints[rough].name;
    return json;
}

Json outcome_json(const DesignProblem& problem, const OptimiseOutcome& outcome, const std::string& out) {
    const Design& design = problem.design();
    const optimisers::OptimiserReport& report = outcome.report;
    Json json;
    json["status"] = optimisers::to_string(report.status);
    json["message"] = report.message;
    json["objective_start"] = report.start.usable ? Json(report.start.objective) : Json();
    json["objective"] = report.best.usable ? Json(report.best.objective) : Json();
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
    json["terms"] = terms_json(design, outcome.final);
    json["constraints"] = constraints_json(design, outcome.final);
    json["relations"] = relations_json(design, outcome.final.relations);
    std::vector<std::string> names;
    for (const core::scene::Body& body : design.scene.bodies) names.push_back(body.name);
    json["clearance"] = clearance_json(outcome.clearance, names);
    json["unbuildable"] = outcome.unbuildable;
    if (!outcome.limits.empty()) json["limits"] = outcome.limits;
    json["out"] = out;
    return json;
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

// What each requirement that holds costs, the dearest first; what could still move; what is too rough to tell.
std::string verdict_text(const Design& design, const optimisers::Optimality& o) {
    std::string text;
    std::vector<std::pair<double, std::string>> costs;
    for (size_t i = 0; i < design.constraints.size() && o.step.size() > 0; ++i) {
        const auto& constraint = design.constraints[i];
        const double y = o.multipliers[static_cast<Eigen::Index>(i)] * constraint.bounds.unit;
        if (std::abs(y) * 0.01 < o.worth * 0.1) continue;
        costs.emplace_back(
            -std::abs(y), formatted("  %s: 0.01 %s is worth %.3g\n", constraint.name.c_str(), y > 0 ? "less" : "more", 0.01 * std::abs(y)));
    }
    std::sort(costs.begin(), costs.end());
    if (!costs.empty()) text += "what the requirements cost, in the objective, per hundredth of their unit:\n";
    for (const auto& cost : costs) text += cost.second;
    for (const int k : o.improvable) {
        const description::Parameter& p = design.parameters[static_cast<size_t>(k)];
        text += formatted("could still move: %s by %.4g %s\n", p.name.c_str(), description::from_si(o.step[k], p.unit),
                          std::string(p.unit.name).c_str());
    }
    if (!o.improvable.empty()) text += formatted("predicted gain %.3g, %.3g counts\n", o.predicted_gain, o.worth);
    if (o.roughest >= 0)
        text += formatted(
            "too rough to tell an optimum: noise of %.3g in the objective, %.3g counts; wider contact (dhat) or damping would help\n",
            o.noise_in_objective, o.worth);
    return text;
}

std::string outcome_text(const Design& design, const OptimiseOutcome& outcome, const Console& console, const std::string& out) {
    const optimisers::OptimiserReport& report = outcome.report;
    const bool good = report.status == OptimiserStatus::optimal;
    std::string text = console.coloured(optimisers::to_string(report.status), good) + ": " + report.message + "\n";
    if (!report.best.usable) return text;
    text += formatted("objective %.8g, from %.8g at the start; %d evaluations (%d failed), %d iterations\n", report.best.objective,
                      report.start.objective, report.evaluations, report.failures, report.iterations);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        const bool told = k < report.optimality.held.size();
        text += formatted("  %-24s %12.7g -> %12.7g %s%s%s\n", p.name.c_str(), description::from_si(p.value, p.unit),
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
    text += verdict_text(design, report.optimality);
    for (const std::string& limit : outcome.limits) text += "limited by: " + limit + "\n";
    return text + "written to " + out + ": design.final.json, trajectory.json, history.jsonl, result.json\n";
}

std::string output_folder(const OptimiseArguments& options, const reading::DesignFile& file) {
    if (!options.out.empty()) return options.out;
    if (!file.output.empty()) return file.output;
    return std::filesystem::path(options.path).stem().stem().string() + ".out";
}

int run_optimise(const OptimiseArguments& options, const CommonOptions& common, Console& console) {
    const Result<reading::DesignFile> file = reading::read_design(options.path, {common.mesh_dirs});
    if (!file) return console.input_errors(file.errors());
    tell_warnings(console, file->warnings);
    const Result<DesignProblem> problem = DesignProblem::create(file->design);
    if (!problem) return console.input_errors(problem.errors());
    const studies::RunFolder folder{output_folder(options, *file), options.resume};
    studies::OptimiseOptions optimise;
    optimise.optimiser = options.optimiser;
    optimise.should_stop = interrupted;
    optimise.narrate = [&](const std::string& line) { console.narrate(line); };
    optimise.on_step = [&](const core::stepper::Progress& p) { console.progress("      simulating", p.step, p.steps); };
    const Result<studies::FileOutcome> run = studies::optimise_file(*file, *problem, folder, optimise);
    if (!run) return console.input_errors(run.errors());
    const OptimiseOutcome& outcome = run->outcome;
    if (!run->history_kept_as.empty()) console.narrate("the history of an earlier run is kept as " + run->history_kept_as);
    const Json json = outcome_json(*problem, outcome, folder.directory);
    const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    const Errors errors = core::files::write_file_atomically(std::filesystem::path(folder.directory) / "result.json", text);
    if (!errors.empty()) return console.input_errors(errors);
    std::string told = outcome_text(problem->design(), outcome, console, folder.directory);
    if (outcome.report.status == OptimiserStatus::interrupted)
        told += "go on where it stopped: fettle optimise " + options.path + " --out " + folder.directory + " --resume\n";
    console.result(json, told);
    return exit_code(outcome.report.status);
}

}  // namespace

Command add_optimise(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("optimise", "Tunes a design's parameters under its requirements, and certifies the result");
    app.also_called("optimize");
    auto options = std::make_shared<OptimiseArguments>();
    app.option("DESIGN", options->path, "Design to start from").required();
    app.option("--optimiser,--optimizer", options->optimiser, "ipopt, mma, ccsaq, slsqp or cobyla (default: what the design says)")
        .one_of(optimisers::optimiser_names());
    app.option("--out", options->out, "Folder for the result (default: the design's `output`)");
    app.flag("--resume", options->resume, "Replay the folder's history, and go on where a killed run stopped");
    app.closing_words("Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out --json");
    return {app, [options, &common](Console& console) { return run_optimise(*options, common, console); }};
}

}  // namespace fettle::design::cli
