// SPDX-License-Identifier: MIT
/// fettle check DESIGN: every requirement at the values as they are, pass or fail as exit code; nothing is tuned.
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "design/answers/answer_json.hpp"
#include "design/answers/judged_json.hpp"
#include "design/answers/summary.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/optimise_answer.hpp"
#include "design/problem/motion_warnings.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/judged_design.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using answers::Summary;
using problem::DesignProblem;
using studies::JudgedDesign;

struct CheckArguments {
    std::string path;
    bool resolution = false;
};

enum class Verdict { met, in_doubt, violated, undecided };

Verdict verdict_of(const JudgedDesign& judged, const Summary& summary) {
    for (const answers::SummaryRow& row : summary.rows)  // relations alone, where the design cannot be evaluated
        if (row.verdict == answers::SummaryRow::Verdict::violated) return Verdict::violated;
    if (!judged.final.usable || interrupted()) return Verdict::undecided;
    return summary.is_good ? Verdict::met : Verdict::in_doubt;
}

const char* word(Verdict verdict) {
    constexpr const char* all[] = {"met", "in doubt", "violated", "undecided"};
    return all[static_cast<int>(verdict)];
}

int exit_of(Verdict verdict) {
    return verdict == Verdict::violated ? exit_violated : verdict == Verdict::undecided ? exit_undecided : exit_done;
}

// The design of a run's folder is the one that the run has left.
std::string design_at(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored) ? (std::filesystem::path(path) / "design.final.json").string() : path;
}

Json json_of(const DesignProblem& problem, const JudgedDesign& judged, const Summary& summary, Verdict verdict,
             const std::vector<std::string>& warnings) {
    Json json;
    json["status"] = word(verdict);
    json["message"] = summary.sentence + (summary.why.empty() ? "" : " " + summary.why);
    json["summary"] = answers::summary_json(summary);
    json["parameters"] = answers::parameters_json(problem.design(), judged.final.parameters);
    json["units"] = answers::units_json(problem.design());
    json["objective"] = answers::finite_or_null(judged.final.objective);
    json["constraint_violation"] = answers::finite_or_null(judged.final.violation);
    answers::add_judged(problem.design(), judged, json);
    if (!warnings.empty()) json["warnings"] = warnings;
    return json;
}

int run_check(const CheckArguments& options, const CommonOptions& common, Console& console) {
    const std::string path = design_at(options.path);
    const Result<reading::DesignFile> file = open_design(path, common);
    if (!file) return console.input_errors(file.errors());
    std::vector<std::string> warnings = file->warnings;
    const Result<DesignProblem> problem = DesignProblem::create(file->design);
    if (!problem) return console.input_errors(problem.errors());
    warnings.insert(warnings.end(), problem->warnings().begin(), problem->warnings().end());
    const VectorX values = description::values_of(problem->design().parameters);
    JudgedDesign judged = studies::judge_design(
        *problem, values, {interrupted, [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); }});
    if (options.resolution && judged.final.usable && !interrupted()) {
        studies::ResolutionOptions finer;
        finer.should_stop = interrupted;
        finer.on_variant = [&](const std::string& what) { console.narrate("simulating the design " + what); };
        judged.finer = studies::measure_finer(*file, *problem, values, {common.mesh_dirs, programs_of(common)}, finer);
    }
    console.end_progress();
    for (const std::string& warning : problem::motion_warnings(problem->design(), judged.final)) warnings.push_back(warning);
    tell_warnings(console, warnings, path);
    const Summary summary = answers::summary_of(problem->design(), judged);
    const Verdict verdict = verdict_of(judged, summary);
    for (Check& check : requirement_checks(problem->design(), judged, path)) console.found(std::move(check));
    if (!judged.final.usable)
        console.found({"the design can be evaluated", verdict == Verdict::violated ? CheckOutcome::failed : CheckOutcome::undecided,
                       word(verdict), summary.why, path});
    console.result(json_of(*problem, judged, summary, verdict, warnings),
                   answer_text(summary, console, std::numeric_limits<std::size_t>::max()));
    return exit_of(verdict);
}

}  // namespace

Command add_check(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("check", "Measures a design as it is: is every requirement met?");
    auto options = std::make_shared<CheckArguments>();
    app.option("DESIGN", options->path, "Design, or the folder of an optimisation (its design.final.json)").required();
    app.flag("--resolution", options->resolution, "Simulate once more with finer facets and time steps, and tell what changes");
    app.closing_words(
        "Example:  fettle check examples/slider_crank/tuned.design.json --junit check.xml\n"
        "Exit code: 0 every requirement is met, 1 one is violated, 2 undecided. Requirements that are met as simulated, but not with the\n"
        "play of the fits taken up, are told as in doubt, and are no failure.");
    return {app, [options, &common](Console& console) { return run_check(*options, common, console); }};
}

}  // namespace fettle::design::cli
