// SPDX-License-Identifier: MIT
/// fettle gradient DESIGN: objective, constraints and their gradients; --check audits them against differences of whole simulations.
#include <nlohmann/json.hpp>

#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/studies/difference_check.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using description::Parameter;
using problem::DesignEvaluation;
using problem::DesignProblem;
using studies::CheckReport;
using studies::CheckRow;

struct GradientArguments {
    std::string path;
    bool check = false;
    double check_limit = 1e-5;
};

Json failure_json(const DesignEvaluation& evaluation) {
    Json json;
    json["status"] = evaluation.interrupted ? "interrupted" : "not_evaluated";
    json["message"] = evaluation.reason;
    return json;
}

Json values_json(const Design& design, const DesignEvaluation& evaluation) {
    Json json;
    json["status"] = "ok";
    json["objective"] = evaluation.objective;
    json["gradient"] = gradient_json(design, evaluation.gradient);
    json["units"] = units_json(design);
    Json terms = Json::array();
    for (size_t k = 0; k < design.objective.size(); ++k) {
        terms.push_back({{"name", design.objective[k].name}, {"weight", design.objective[k].weight}, {"value", evaluation.terms[k].value}});
    }
    json["terms"] = terms;
    Json list = Json::array();
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const description::Measurement& measured = evaluation.constraints[i];
        Json entry;
        entry["name"] = constraint.name;
        entry["value"] = measured.value;
        entry["certified_lower"] = measured.lower;
        entry["met"] = description::violation(constraint.bounds, measured) <= 0;
        if (!measured.fault.empty()) entry["fault"] = measured.fault;
        entry["gradient"] = gradient_json(design, evaluation.jacobian.row(static_cast<Eigen::Index>(i)).transpose());
        list.push_back(std::move(entry));
    }
    json["constraints"] = list;
    json["relations"] = relations_json(design, evaluation.relations);
    json["forward_seconds"] = evaluation.forward_seconds;
    json["backward_seconds"] = evaluation.backward_seconds;
    return json;
}

double factor_of(const Design& design, const std::string& parameter) {
    for (const Parameter& p : design.parameters) {
        if (p.name == parameter) return to_si(1, p.unit);
    }
    return 1;
}

void add_check(const Design& design, const CheckReport& report, Json& json) {
    Json rows = Json::array();
    for (const CheckRow& row : report.rows) {
        const double factor = factor_of(design, row.parameter);
        rows.push_back({{"parameter", row.parameter},
                        {"quantity", row.quantity},
                        {"adjoint", row.adjoint * factor},
                        {"difference", row.difference * factor},
                        {"relative_error", row.relative_error},
                        {"difference_error", row.difference_error}});
    }
    json["check"] = rows;
    json["largest_relative_error"] = report.largest_relative_error;
    json["check_simulations"] = report.simulations;
    json["not_checked"] = report.failures;
}

std::string check_text(const CheckReport& report) {
    std::string text = formatted("%-40s %-20s %14s %14s %10s %10s\n", "quantity", "parameter", "adjoint", "difference", "error", "(diff.)");
    for (const CheckRow& row : report.rows) {
        text += formatted("%-40s %-20s %14.7g %14.7g %10.2e %10.2e\n", row.quantity.c_str(), row.parameter.c_str(), row.adjoint,
                          row.difference, row.relative_error, row.difference_error);
    }
    for (const std::string& failure : report.failures) text += "not checked: " + failure + "\n";
    return text + formatted("largest relative error %.3g, %d simulations\n", report.largest_relative_error, report.simulations);
}

std::string values_text(const Design& design, const DesignEvaluation& e, const Console& console) {
    std::string text = formatted("objective %.10g\n", e.objective);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& p = design.parameters[k];
        text += formatted("  d/d %-24s %14.7g per %s\n", p.name.c_str(), e.gradient[static_cast<Eigen::Index>(k)] * to_si(1, p.unit),
                          std::string(p.unit.name).c_str());
    }
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = e.constraints[i];
        text += formatted("%-40s %12.7g, at least %12.7g, required [%g, %g]\n", name.c_str(), measured.value / bounds.unit,
                          measured.lower / bounds.unit, bounds.lower / bounds.unit, bounds.upper / bounds.unit);
        if (!measured.fault.empty()) text += "  " + measured.fault + "\n";
    }
    text += relations_text(design, e.relations, console);
    return text + formatted("forward %.3g s, backward %.3g s\n", e.forward_seconds, e.backward_seconds);
}

int run_gradient(const GradientArguments& options, const CommonOptions& common, Console& console) {
    Result<reading::DesignFile> read = reading::read_design(options.path, {common.mesh_dirs});
    if (!read) return console.input_errors(read.errors());
    tell_warnings(console, read->warnings);
    const Result<DesignProblem> problem = DesignProblem::create(std::move(read->design));
    if (!problem) return console.input_errors(problem.errors());
    const Design& design = problem->design();
    const VectorX values = description::values_of(design.parameters);
    problem::EvaluateOptions evaluate;
    evaluate.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    evaluate.should_stop = interrupted;
    const DesignEvaluation evaluation = problem->evaluate(values, evaluate);
    if (!evaluation.usable) {
        console.result(failure_json(evaluation), "the design cannot be evaluated: " + evaluation.reason + "\n");
        return exit_undecided;
    }
    Json json = values_json(design, evaluation);
    std::string text = values_text(design, evaluation, console);
    int code = exit_done;
    if (options.check) {
        studies::CheckOptions check;
        check.on_parameter = [&](int done, int of) { console.progress("differences", done, of); };
        check.should_stop = interrupted;
        const CheckReport report = studies::check_gradients(*problem, values, evaluation, check);
        add_check(design, report, json);
        text += check_text(report);
        const bool good = report.largest_relative_error <= options.check_limit && report.failures.empty() && !report.interrupted;
        if (!good) code = exit_undecided;
        if (!good) json["status"] = report.interrupted ? "interrupted" : "check_failed";
    }
    console.result(json, text);
    return code;
}

}  // namespace

Command add_gradient(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("gradient", "Objective, constraints and their gradients");
    auto options = std::make_shared<GradientArguments>();
    app.option("DESIGN", options->path, "Design, taken at its values").required();
    app.flag("--check", options->check, "Audit all gradients against central differences of whole simulations");
    app.option("--check-limit", options->check_limit, "Largest relative error that passes (default 1e-5); else exit code 2").above(0);
    app.closing_words(
        "Example:  fettle gradient examples/slider_crank/slider_crank.design.json --check\n"
        "Gradients are per unit of each parameter as the design has it; values are SI, the objective a plain number.");
    return {app, [options, &common](Console& console) { return run_gradient(*options, common, console); }};
}

}  // namespace fettle::design::cli
