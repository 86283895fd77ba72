// SPDX-License-Identifier: MIT
/// fettle optimise DESIGN: tunes the parameters, and certifies the final design; from one start or from many, of one combination of the
/// design's choices or of many.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/files/atomic_file.hpp"
#include "design/answers/optimise_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/answers/run_folder.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/optimise_answer.hpp"
#include "design/cli/optimise_choices.hpp"
#include "design/cli/optimise_starts.hpp"
#include "design/cli/report_made.hpp"
#include "design/problem/motion_warnings.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_file.hpp"
#include "design/studies/random_start.hpp"
#include "design/studies/starting_sides.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using optimisers::OptimiserStatus;
using problem::DesignProblem;
using studies::OptimiseOutcome;

constexpr int most_lists = 2000000;  // 1000 list + k is an int too

struct OptimiseArguments {
    std::string path, optimiser, out;
    int starts = 0;  // 0: one run
    std::optional<int> seed, combinations;
    bool resume = false, repair = false, keep_choices = false, no_report = false, no_resolution = false, details = false;
};

std::string output_folder(const OptimiseArguments& options, const reading::DesignFile& file) {
    if (!options.out.empty()) return options.out;
    if (!file.output.empty()) return file.output;
    return std::filesystem::path(options.path).stem().stem().string() + ".out";
}

// What is typed to go on.
std::string resume_command(const OptimiseArguments& options, const std::string& out) {
    std::string text = "fettle optimise " + options.path + " --out " + out;
    if (options.starts > 0) text += " --starts " + std::to_string(options.starts);
    if (options.seed) text += " --seed " + std::to_string(*options.seed);
    if (!options.optimiser.empty()) text += " --optimiser " + options.optimiser;
    if (options.repair) text += " --repair";
    if (options.combinations) text += " --combinations " + std::to_string(*options.combinations);
    if (options.keep_choices) text += " --keep-choices";
    if (options.no_resolution) text += " --no-resolution";
    return text + " --resume";
}

struct Run {
    const OptimiseArguments& options;
    const reading::DesignFile& file;
    const DesignProblem& problem;
    const CommonOptions& common;
    Console& console;
    answers::RunFacts facts;
};

// Several runs that have ended, of which one is told: what is said of them beside it.
struct OtherRuns {
    std::string what;          // they are: "starts"
    std::string heading;       // before the answer
    std::string table;         // after it
    Json answer;               // what they add to it; null: there are no others
    bool was_stopped = false;  // before all had ended

    bool exist() const { return !answer.is_null(); }
    std::string interruption() const { return "not all " + what + " have been run"; }
};

void found_interrupted(const Run& run, const OtherRuns& others) {
    run.console.found(
        {"all " + others.what + " have been run", CheckOutcome::undecided, "interrupted", others.interruption(), run.options.path});
}

// What several runs add to the answer of the one that is told.
void add_others(Json& json, const OtherRuns& others) {
    if (!others.exist()) return;
    if (others.was_stopped) {
        json["status"] = "interrupted";
        json["message"] = "stopped as asked before all " + others.what + " had been run";
    }
    json.update(others.answer);
}

std::string report_of(const Json& answer) {
    return answer.contains("report") && answer["report"].is_string() ? answer["report"].get<std::string>() : "";
}

// One run, told; with others, it is the best of them, replayed.
int run_sided(const Run& run, const OtherRuns& others) {
    Console& console = run.console;
    const bool was_stopped = others.was_stopped;
    const auto answer = [&](const OptimiseOutcome& outcome) {
        Json json = answers::outcome_json(run.problem, outcome, run.facts);
        add_others(json, others);
        return json;
    };
    Json json;
    studies::RunFolder folder{run.facts.out, run.options.resume || others.exist()};
    folder.add_files = [&](const OptimiseOutcome& outcome, core::files::FilesTogether& files) {
        json = answer(outcome);
        return answers::add_outcome(files, folder.directory, outcome.final, json, run.common.command);
    };
    if (!run.options.no_resolution && !was_stopped)
        folder.measure_finer = reading::DesignReadOptions{run.common.mesh_dirs, programs_of(run.common)};
    studies::OptimiseOptions optimise;
    optimise.optimiser = run.options.optimiser;
    optimise.seed = run.facts.seed;
    optimise.repair = run.facts.repair;
    optimise.replay_only = was_stopped;
    if (!was_stopped) optimise.should_stop = interrupted;
    if (!others.exist()) optimise.narrate = [&](const std::string& line) { console.narrate(line); };
    optimise.on_step = [&](const core::stepper::Progress& p) { console.progress("      simulating", p.step, p.steps); };
    const Result<studies::FileOutcome> done = studies::optimise_file(run.file, run.problem, folder, optimise);
    if (!done) return console.input_errors(done.errors());
    const OptimiseOutcome& outcome = done->outcome;
    if (!done->history_kept_as.empty()) console.narrate("the history of an earlier run is kept as " + done->history_kept_as);
    console.unwritten(done->unwritten);
    if (json.is_null()) json = answer(outcome);
    for (const std::string& warning : outcome.at_start.warnings)  // which the search has narrated
        console.found({run.options.path, CheckOutcome::remarked, "warning", warning, run.options.path});
    tell_warnings(console, problem::motion_warnings(run.problem.design(), outcome.final), run.options.path);
    const bool is_kept = outcome.report.best.usable && done->unwritten.empty();
    std::string told = answer_text(answers::summary_of(run.problem.design(), outcome, run.facts), console);
    if (run.options.details) told += "\n" + outcome_text(run.problem.design(), outcome, console, run.facts);
    if (run.options.details && is_kept) told += written_text(run.facts);
    if (others.exist()) told = others.heading + ":\n" + told + "all " + others.what + ":\n" + others.table;
    if (was_stopped) told = console.coloured("interrupted", false) + ": " + others.interruption() + "\n" + told;
    std::string page;
    if (!run.options.no_report && done->unwritten.empty())
        leave_report(folder.directory, run.common, console, json, page, report::at_hand(run.file, run.problem, outcome));
    told += is_kept ? next_text(report_of(json), folder.directory) : page;
    if (was_stopped || outcome.report.status == OptimiserStatus::interrupted)
        told += "go on where it stopped: " + resume_command(run.options, folder.directory) + "\n";
    for (Check& check : outcome_checks(run.problem.design(), outcome, run.options.path)) console.found(std::move(check));
    if (was_stopped) found_interrupted(run, others);
    console.result(json, told);
    return was_stopped ? exit_undecided : exit_code(outcome.report.status);
}

// One run, on the sides of its seed.
int run_one(const Run& run, const OtherRuns& others) {
    const Result<studies::FileOfSeed> begun = studies::file_of_seed(run.file, run.problem, run.facts.seed);
    if (!begun) return run.console.input_errors(begun.errors());
    return run_sided({run.options, begun->file, begun->problem, run.common, run.console, run.facts}, others);
}

// None of several runs that were stopped has a design to show.
int tell_interrupted(const Run& run, const OtherRuns& others) {
    Json json;
    add_others(json, others);
    json["out"] = run.facts.out;
    found_interrupted(run, others);
    run.console.result(json, run.console.coloured("interrupted", false) + ": " + others.interruption() + "\n" + others.table +
                                 "none has ended with a design\ngo on where it stopped: " + resume_command(run.options, run.facts.out) +
                                 "\n");
    return exit_undecided;
}

// Not one of several runs got as far as a result: they all say why.
int tell_failed(const Run& run, const OtherRuns& others, const RunResult& first) {
    Json json{{"status", first.status}, {"message", first.message}};
    json.update(others.answer);
    json["out"] = run.facts.out;
    run.console.result(json, run.console.coloured(first.status, false) + ": no run left a result\n" + others.table);
    return first.exit_code == exit_internal ? exit_internal : exit_bad_input;
}

// The best run's history becomes the folder's; one of other runs that is there is kept under another name.
Errors adopt_history(const std::filesystem::path& folder, const std::filesystem::path& best, Console& console) {
    const Result<std::string> history = core::files::read_file(best / "history.jsonl");
    if (!history) return history.errors();
    const Result<std::string> earlier = core::files::read_file(folder / "history.jsonl");
    if (earlier && history->compare(0, earlier->size(), *earlier) != 0) {
        const Result<studies::History> fresh = studies::History::open(folder.string(), {}, studies::LineFileMode::fresh);
        if (!fresh) return fresh.errors();
        console.narrate("the history of an earlier run is kept as " + fresh->kept_as());
    }
    return core::files::write_file_atomically(folder / "history.jsonl", *history);
}

RunSettings settings_of(const Run& run, const std::string& what) {
    return {run.options.optimiser, run.options.resume, run.options.repair, what};
}

int run_starting(Run run) {
    const int list = run.options.seed.value_or(1);
    if (list > most_lists)
        return run.console.input_errors({{ErrorCode::out_of_range, "--seed", "with --starts it is at most " + std::to_string(most_lists)}});
    const std::vector<StartResult> rows =
        run_starts(run.options.path, run.facts.out, studies::seeds_of_list(static_cast<std::uint64_t>(list), run.options.starts),
                   settings_of(run, "starts"), run.common, run.console);
    const std::optional<std::size_t> found = best_run(rows);
    OtherRuns others{"starts", "", starts_text(rows), {{"starts", starts_json(rows)}}, interrupted()};
    if (others.was_stopped) others.answer["best_start"] = found ? Json(rows[*found].seed) : Json();
    if (others.was_stopped && !found) return tell_interrupted(run, others);
    const std::size_t best = found.value_or(0);
    if (!rows[best].result.is_object()) return tell_failed(run, others, rows[best]);
    others.answer["best_reached"] = best_reached_json(rows);
    run.facts.seed = rows[best].seed;
    others.heading = (others.was_stopped ? "the best so far, of seed " : "best of " + std::to_string(rows.size()) + " starts, seed ") +
                     std::to_string(run.facts.seed);
    const Errors errors = adopt_history(run.facts.out, rows[best].out, run.console);
    if (!errors.empty()) return run.console.input_errors(errors);
    return run_one(run, others);
}

// Each combination of the design's choices is tuned, the best one told.
int run_choosing(const Run& run) {
    constexpr int usual_most = 64;
    ChoicesRequest request{
        run.facts.out, run.options.combinations.value_or(usual_most), {}, {run.common.mesh_dirs, programs_of(run.common)}};
    if (run.options.starts > 0) request.words = {"--starts", std::to_string(run.options.starts)};
    if (run.options.seed) request.words.insert(request.words.end(), {"--seed", std::to_string(*run.options.seed)});
    const Result<ChoicesTried> tried = try_choices(run.file, request, settings_of(run, "combinations"), run.common, run.console);
    if (!tried) return run.console.input_errors(tried.errors());
    const OtherRuns others{"combinations",
                           choices_heading(run.file, *tried),
                           choices_text(*tried),
                           {{"choices", choices_json(run.file, *tried)}},
                           tried->was_stopped};
    if (others.was_stopped && !tried->best) return tell_interrupted(run, others);
    if (!tried->best) return tell_failed(run, others, tried->runs.front());
    const ChoiceResult& best = tried->runs[*tried->best];
    const Result<reading::DesignFile> file = open_design(best.design, run.common);
    if (!file) return run.console.input_errors(file.errors());
    const Result<DesignProblem> problem = DesignProblem::create(file->design);
    if (!problem) return run.console.input_errors(problem.errors());
    const Errors errors = adopt_history(run.facts.out, best.out, run.console);
    if (!errors.empty()) return run.console.input_errors(errors);
    Run told{run.options, *file, *problem, run.common, run.console, run.facts};
    if (best.result.contains("seed") && best.result["seed"].is_number_unsigned())
        told.facts.seed = best.result["seed"].get<std::uint64_t>();
    return run_one(told, others);
}

int run_optimise(const OptimiseArguments& options, const CommonOptions& common, Console& console) {
    const Result<reading::DesignFile> file = open_design(options.path, common);
    if (!file) return console.input_errors(file.errors());
    tell_warnings(console, file->warnings);
    const Result<DesignProblem> problem = DesignProblem::create(file->design);
    if (!problem) return console.input_errors(problem.errors());
    tell_warnings(console, problem->warnings());
    const std::string out = output_folder(options, *file);
    const Errors errors = answers::try_run_folder(out, {"design.final.json"});
    if (!errors.empty()) return console.input_errors(errors);
    const Run run{options, *file, *problem, common, console, {out, 0, options.repair}};
    if (!file->choices.empty() && !options.keep_choices) return run_choosing(run);
    if (options.starts > 0) return run_starting(run);
    Run one = run;
    one.facts.seed = static_cast<std::uint64_t>(options.seed.value_or(0));
    return run_one(one, {});
}

}  // namespace

Command add_optimise(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("optimise", "Tunes a design's parameters under its requirements, and certifies the result");
    app.also_called("optimize");
    auto options = std::make_shared<OptimiseArguments>();
    app.option("DESIGN", options->path, "Design to start from").required();
    app.option("--optimiser,--optimizer", options->optimiser,
               "sqp, gauss_newton, ipopt, mma, ccsaq, slsqp or cobyla (default: the design's)")
        .one_of(optimisers::optimiser_names());
    app.option("--out", options->out, "Folder for the result (default: the design's `output`)");
    app.option("--starts", options->starts, "How many starts: the file's values, then random ones; the best result is kept")
        .between(1, 1000);
    app.option("--seed", options->seed,
               "With --starts: seed of the random starts (default 1); else: begin at the random start of this seed")
        .between(0, most_lists * 1000.0);
    app.option("--combinations", options->combinations, "How many combinations of the design's choices to tune at most (default 64)")
        .between(1, 100000);
    app.flag("--keep-choices", options->keep_choices, "Tune the combination of choices that the file has, and no other");
    app.flag("--repair", options->repair, "Find the smallest change that meets every requirement, instead of the best design");
    app.flag("--details", options->details,
             "Tell all: what held each parameter, what the requirements cost, how far proofs hold for what is round");
    app.flag("--no-report", options->no_report, "No report.html");
    app.flag("--no-resolution", options->no_resolution, "No simulations of the result with finer facets and time steps");
    app.flag("--resume", options->resume, "Replay the folder's history, and go on where a killed run stopped");
    app.closing_words("Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out --json");
    return {app, [options, &common](Console& console) { return run_optimise(*options, common, console); }};
}

}  // namespace fettle::design::cli
