// SPDX-License-Identifier: MIT
/// fettle gradient DESIGN: objective, constraints and their gradients; --check audits them against differences of whole simulations.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/parallel.hpp"
#include "design/answers/check_faults.hpp"
#include "design/answers/gradient_json.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/inputs.hpp"
#include "design/description/requirement_text.hpp"
#include "design/gradient_audit/design_line.hpp"
#include "design/gradient_audit/difference_check.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using description::Design;
using description::Parameter;
using gradient_audit::CheckReport;
using gradient_audit::CheckRow;
using gradient_audit::QuantityRoughness;
using gradient_audit::RoughnessReport;
using problem::DesignEvaluation;
using problem::DesignProblem;

struct GradientArguments {
    std::string path;
    bool check = false;
    double check_limit = 1e-5;
    int check_parameters = 0;
};

// @param unit  That the quantity is counted in.
std::string tie_text(const Design& design, const problem::Tie* tie, double unit) {
    if (tie == nullptr) return {};
    std::string text = formatted("  no derivative: %d witnesses tie", tie->branches);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& p = design.parameters[k];
        const auto at = static_cast<Eigen::Index>(k);
        const double least = tie->least[at], greatest = tie->greatest[at], factor = to_si(1, p.unit) / unit;
        if (greatest - least <= 1e-6 * std::max(std::abs(least), std::abs(greatest))) continue;
        text += formatted(", d/d %s from %.7g to %.7g per %s", p.name.c_str(), least * factor, greatest * factor,
                          std::string(p.unit.name).c_str());
    }
    return text + "\n";
}

std::string unit_of(const Design& design, const std::string& parameter) {
    for (const Parameter& p : design.parameters)
        if (p.name == parameter) return std::string(p.unit.name);
    return {};
}

// What the text counts a row's quantity in: the objective, a plain number, in 1.
struct CountedIn {
    double unit = 1;   // SI
    std::string name;  // "clearance pin:plate [mm]"
};
CountedIn counted_in(const Design& design, const std::string& quantity) {
    for (const description::Constraint& constraint : design.constraints) {
        if (constraint.name != quantity) continue;
        const std::string unit = description::unit_name(constraint);
        return {constraint.bounds.unit, unit.empty() ? quantity : quantity + " [" + unit + "]"};
    }
    return {1, quantity};
}

// The parameter that moves most along the line, and by how much.
std::string length_text(const Design& design, const RoughnessReport& report, double share) {
    Eigen::Index k = 0;
    report.direction.cwiseAbs().maxCoeff(&k);
    const Parameter& parameter = design.parameters[k];
    const double moved = share * gradient_audit::parameter_ranges(design)[k] / to_si(1, parameter.unit);
    return formatted("%.3g %s", moved, std::string(parameter.unit.name).c_str());
}

std::string roughness_text(const Design& design, const RoughnessReport& report) {
    if (!report.measured) return "roughness: not measured" + (report.failures.empty() ? "" : ", " + report.failures.front()) + "\n";
    Eigen::Index most = 0;
    report.direction.cwiseAbs().maxCoeff(&most);
    std::string text = formatted("how far the gradient holds along the objective's, as %s moves (most):\n%-40s %12s %12s %14s %14s\n",
                                 design.parameters[most].name.c_str(), "quantity", "noise", "tolerance", "holds within", "fails beyond");
    std::string rough;
    for (const QuantityRoughness& quantity : report.quantities) {
        const bool bound = quantity.noise.status == optimisers::NoiseStatus::spacing_too_large;
        const auto [unit, name] = counted_in(design, quantity.name);
        text += formatted("%-40s %1s%11.3g %12.3g %14s %14s\n", name.c_str(), bound ? "<" : "", quantity.noise.noise / unit,
                          quantity.tolerance / unit, length_text(design, report, quantity.holds).c_str(),
                          std::isfinite(quantity.breaks) ? length_text(design, report, quantity.breaks).c_str() : "-");
        if (quantity.rough) rough += (rough.empty() ? "" : ", ") + quantity.name;
    }
    if (rough.empty()) return text;
    text += "rougher than the tolerance: " + rough + ". What would help:\n";
    for (const std::string& remedy : gradient_audit::roughness_remedies(design, report)) text += "  - " + remedy + "\n";
    return text;
}

// "width grows by 0.01 to 0.1 mm"
std::string move_text(const Design& design, const gradient_audit::ContactChange& change) {
    const double unit = answers::parameter_unit(design, change.parameter);
    std::string_view unit_name;
    for (const Parameter& p : design.parameters)
        if (p.name == change.parameter) unit_name = p.unit.name;
    return formatted("%s %s by %.3g to %.3g %s", change.parameter.c_str(), change.to > 0 ? "grows" : "falls", std::abs(change.from) / unit,
                     std::abs(change.to) / unit, std::string(unit_name).c_str());
}

// A line for each change, with all parameters that make it.
std::vector<std::string> contact_change_lines(const Design& design, const CheckReport& report) {
    std::vector<std::string> sentences, lines;
    for (const gradient_audit::ContactChange& change : report.contact_changes) {
        const std::string sentence = sentence_of(change) + (is_kink(change.at.event) ? " (gradients jump there)" : "");
        const auto known = std::find(sentences.begin(), sentences.end(), sentence);
        if (known != sentences.end()) {
            lines[known - sentences.begin()] += ", or " + move_text(design, change);
            continue;
        }
        sentences.push_back(sentence);
        lines.push_back("  " + sentence + ": if " + move_text(design, change));
    }
    return lines;
}

std::string contact_changes_text(const Design& design, const CheckReport& report) {
    constexpr size_t most = 12;
    const double reach = report.contacts_reach.size() > 0 ? report.contacts_reach.maxCoeff() : 0;
    if (!(reach > 0)) return {};
    std::string text = formatted("contacts that change as a parameter moves by up to %.3g %% of its range, nearest first:\n", 100 * reach);
    const std::vector<std::string> lines = contact_change_lines(design, report);
    if (lines.empty()) text += "  none\n";
    for (size_t k = 0; k < std::min(most, lines.size()); ++k) text += lines[k] + "\n";
    if (lines.size() > most) text += formatted("  and %zu more (--json has all)\n", lines.size() - most);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const std::string& name = design.parameters[k].name;
        if (std::find(report.left_out.begin(), report.left_out.end(), name) != report.left_out.end()) continue;
        for (const int side : {0, 1}) {
            const double looked = report.contacts_reach(k, side);
            if (looked >= reach) continue;
            text += "  not examined: " + name + (side == 0 ? " falling" : " growing");
            text += looked > 0 ? formatted(" by more than %.3g %%\n", 100 * looked) : "\n";
        }
    }
    return text;
}

// A line below the row, where there is one. The difference is the mean of both slopes.
template <class Row>
std::string kink_text(const Row& row, double factor) {
    if (row.kink == 0) return "";
    return formatted("  it has a kink there: slope %.7g below, %.7g above; the gradient lies %s\n",
                     (row.difference - row.kink / 2) * factor, (row.difference + row.kink / 2) * factor,
                     row.lies_between ? "between them" : "outside");
}

std::string along_text(const Design& design, const CheckReport& report) {
    if (report.along.empty()) return "along the gradient: not simulated\n";
    std::string text =
        formatted("%-61s %14s %14s %10s %10s\n", "along the gradient, in shares of the ranges", "adjoint", "difference", "error", "slope");
    for (const gradient_audit::LineRow& row : report.along) {
        const std::string slope = std::isfinite(row.slope) ? formatted("%10.2f", row.slope) : "         -";
        const auto [unit, name] = counted_in(design, row.quantity);
        text += formatted("%-61s %14.7g %14.7g %10.2e %s%s\n", name.c_str(), row.adjoint / unit, row.difference / unit, row.relative_error,
                          slope.c_str(), row.resolved ? "" : "  hidden by noise");
        text += kink_text(row, 1 / unit);
    }
    return text +
           "slope: the power of the step with which the error of the gradient's prediction falls: 2 of a right gradient of a smooth "
           "quantity, 1 of a "
           "wrong one (-: noise hides it)\n";
}

std::string check_text(const Design& design, const CheckReport& report) {
    std::string text =
        formatted("%-40s %-28s %14s %14s %10s %10s\n", "quantity", "per unit of", "adjoint", "difference", "error", "(diff.)");
    for (const CheckRow& row : report.rows) {
        const auto [unit, name] = counted_in(design, row.quantity);
        const double factor = answers::parameter_unit(design, row.parameter) / unit;
        const std::string parameter = row.parameter + " [" + unit_of(design, row.parameter) + "]";
        text += formatted("%-40s %-28s %14.7g %14.7g %10.2e %10.2e%s\n", name.c_str(), parameter.c_str(), row.adjoint * factor,
                          row.difference * factor, row.relative_error, row.difference_error, row.resolved ? "" : "  hidden by noise");
        text += kink_text(row, factor);
    }
    for (const std::string& failure : report.failures) text += "not checked: " + failure + "\n";
    for (size_t k = 0; k < report.left_out.size(); ++k) text += (k == 0 ? "left out: " : ", ") + report.left_out[k];
    if (!report.left_out.empty()) text += "\n";
    text += along_text(design, report);
    text += report.sweeps.failure.empty()
                ? formatted("the gradient, computed backwards and forwards through the simulation, differs by %.2g of its size\n",
                            report.sweeps.disagreement)
                : "backwards and forwards not compared: " + report.sweeps.failure + "\n";
    const bool resolved = std::all_of(report.rows.begin(), report.rows.end(), [](const CheckRow& row) { return row.resolved; }) &&
                          std::all_of(report.along.begin(), report.along.end(), [](const auto& row) { return row.resolved; });
    return text +
           formatted("largest relative error%s %.3g, %d simulations\n", resolved ? "" : " that noise does not hide",
                     report.largest_relative_error, report.simulations) +
           contact_changes_text(design, report) + roughness_text(design, report.roughness);
}

std::string values_text(const Design& design, const DesignEvaluation& e, const Console& console) {
    const std::string unit = description::objective_unit(design);
    std::string text = "objective " + description::amount_text(e.objective, 1, unit, 10) + "\n";
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& p = design.parameters[k];
        text += formatted("  d/d %-24s %14.7g %sper %s\n", p.name.c_str(), e.gradient[k] * to_si(1, p.unit),
                          unit.empty() ? "" : (unit + " ").c_str(), std::string(p.unit.name).c_str());
    }
    for (size_t k = 0; k < design.objective.size(); ++k) {
        const problem::Tie* tie = answers::tie_of(e, true, k);
        if (tie != nullptr) text += design.objective[k].name + ", of the objective:\n" + tie_text(design, tie, design.objective[k].unit);
    }
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = e.constraints[i];
        const std::string unit = description::unit_name(design.constraints[i]);
        const std::string least = description::bound_text(measured.lower, description::Towards::down, bounds.unit, unit);
        text += formatted("%-40s %s, %s, required %s\n", name.c_str(), description::amount_text(measured.value, bounds.unit, unit).c_str(),
                          measured.is_proven ? ("proven at least " + least).c_str() : "computed",
                          description::required_text(bounds, unit).c_str());
        if (const std::string remark = problem::remark(e, i); !remark.empty()) text += "  " + remark + "\n";
        if (const std::string reserve = problem::reserve_text(e, false, i, {bounds.unit, unit}); !reserve.empty())
            text += "  " + reserve + ", " + problem::reserves_text(design) + "\n";
        text += tie_text(design, answers::tie_of(e, false, i), bounds.unit);
    }
    text += relations_text(design, e.relations, console);
    return text + formatted("forward %.3g s, backward %.3g s\n", e.forward_seconds, e.backward_seconds);
}

CheckReport run_check(const DesignProblem& problem, const VectorX& values, const DesignEvaluation& at, const GradientArguments& arguments,
                      Console& console) {
    gradient_audit::CheckOptions check;
    check.limit = arguments.check_limit;
    check.most_parameters = arguments.check_parameters;
    const int cost = gradient_audit::check_cost(problem.parameter_count(), check), threads = core::base::thread_count();
    console.narrate(formatted("the check takes up to %d simulations of about %.2g s each, on %d thread%s", cost, at.forward_seconds,
                              threads, threads == 1 ? "" : "s"));
    check.on_simulation = [&](int done, int of) { console.progress("differences", done, of); };
    check.should_stop = interrupted;
    CheckReport report = gradient_audit::check_gradients(problem, values, at, check);
    console.end_progress();
    return report;
}

int run_gradient(const GradientArguments& options, const CommonOptions& common, Console& console) {
    Result<reading::DesignFile> read = open_design(options.path, common);
    if (!read) return console.input_errors(read.errors());
    tell_warnings(console, read->warnings, options.path);
    const Result<DesignProblem> problem = DesignProblem::create(std::move(read->design));
    if (!problem) return console.input_errors(problem.errors());
    tell_warnings(console, problem->warnings(), options.path);
    const Design& design = problem->design();
    const VectorX values = description::values_of(design.parameters);
    problem::EvaluateOptions evaluate;
    evaluate.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    evaluate.should_stop = interrupted;
    evaluate.balance = true;
    evaluate.branches = problem::BranchReach::tied;
    const DesignEvaluation evaluation = problem->evaluate(values, evaluate);
    if (!evaluation.usable) {
        console.result(answers::not_evaluated_json(evaluation), "the design cannot be evaluated: " + evaluation.reason + "\n");
        return exit_undecided;
    }
    const gradient_audit::GradientWarnings found = answers::gradient_warnings(design, evaluation);
    tell_warnings(console, found.warnings, options.path);
    for (const std::string& note : found.notes) console.narrate("note: " + note);
    Json json = answers::values_json(design, evaluation);
    std::string text = values_text(design, evaluation, console);
    int code = exit_done;
    if (options.check) {
        const CheckReport report = run_check(*problem, values, evaluation, options, console);
        json.update(answers::check_json(design, report, options.check_limit));
        text += check_text(design, report) + answers::verdict_text(report, options.check_limit);
        const answers::CheckVerdict verdict = answers::check_verdict(report, options.check_limit);
        if (verdict != answers::CheckVerdict::passed) {
            code = exit_undecided;
            json["status"] = report.interrupted                         ? "interrupted"
                             : verdict == answers::CheckVerdict::failed ? "check_failed"
                                                                        : "check_undecided";
        }
    }
    console.result(json, text);
    return code;
}

}  // namespace

Command add_gradient(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("gradient", "Computes objective, constraints and their gradients");
    auto options = std::make_shared<GradientArguments>();
    app.option("DESIGN", options->path, "Design, taken at its values").required();
    const Option check = app.flag("--check", options->check, "Compare all gradients with central differences of whole simulations");
    app.option("--check-limit", options->check_limit, "Largest relative error that passes (default 1e-5)").above(0).needs(check);
    app.option("--check-parameters", options->check_parameters,
               "Check only this many parameters, those that the objective depends on most in shares of their ranges (default: all)")
        .at_least(1)
        .needs(check);
    app.closing_words(
        "Example:  fettle gradient examples/slider_crank/slider_crank.design.json --check\n"
        "Gradients are per unit of each parameter as the design has it; values are SI, the objective a plain number.\n"
        "Exit code 2: the design cannot be evaluated, or the check does not pass; the last line says why. \"check FAILED\":\n"
        "  - derivatives of the same simulation, taken backwards and forwards, differ by more than the limit;\n"
        "  - a gradient and its difference disagree by more than the limit, for a parameter or along the gradient;\n"
        "  - at a kink (another slope above than below), a gradient lies outside the slopes of both sides.\n"
        "\"check undecided\", where nothing that was measured disagrees:\n"
        "  - simulations beside the design fail, so that a parameter is not checked; noise hides more than the limit;\n"
        "  - derivatives backwards and forwards cannot be compared; it was interrupted.\n"
        "What to do in each case: docs/recipes.md, \"When gradient --check fails\".");
    return {app, [options, &common](Console& console) { return run_gradient(*options, common, console); }};
}

}  // namespace fettle::design::cli
