// SPDX-License-Identifier: MIT
/// fettle explore DESIGN: evaluates many designs, or optimises from many starts, several at once, on this machine or on a Dask cluster.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/text.hpp"
#include "design/cli/dask_cluster.hpp"
#include "design/cli/inputs.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/design_text.hpp"
#include "design/studies/exploration.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using core::base::formatted;
using core::base::joined;
using Json = nlohmann::ordered_json;

struct ExploreOptions {
    std::string design, out, dask;
    std::vector<std::string> sweeps;
    int samples = 0, starts = 0, seed = 1;
    std::optional<int> workers;
};

Result<studies::ExplorationRequest> request_of(const ExploreOptions& options, const std::vector<description::Parameter>& parameters) {
    studies::ExplorationRequest request{{}, options.samples, options.starts, static_cast<std::uint64_t>(options.seed)};
    Errors errors;
    for (const std::string& text : options.sweeps) {
        Result<studies::SweptParameter> swept = studies::parse_sweep(text, parameters);
        if (swept)
            request.sweep.push_back(std::move(swept).value());
        else
            errors.insert(errors.end(), swept.errors().begin(), swept.errors().end());
    }
    if (!errors.empty()) return errors;
    return request;
}

// From the file of results, so that both can be moved together.
std::string relative_path(const std::string& design, const std::string& out) {
    std::error_code fault;
    const fs::path folder = fs::path(out).has_parent_path() ? fs::path(out).parent_path() : fs::path(".");
    const fs::path path = fs::relative(design, folder, fault);
    return fault || path.empty() ? fs::absolute(design, fault).string() : path.string();
}

std::string found_text(const studies::Exploration& found, const std::string& out, const studies::Explored& end) {
    const auto designs = core::base::counted(found.results.size(), "design");
    const std::vector<std::size_t> best = found.best();
    std::string text = designs + (end.unwritten.empty() ? " in " + out : "") + "; ";
    if (best.empty()) {
        text += "none meets every requirement";
    } else {
        const Json& first = found.results[best.front()];
        text += std::to_string(best.size()) + (best.size() == 1 ? " meets" : " meet") +
                formatted(" every requirement, the best with the objective %.6g", first["objective"].get<double>());
        if (!end.unwritten.empty()) {
            std::vector<std::string> values;
            for (const auto& [name, value] : first["parameters"].items()) values.push_back(name + formatted(" %.9g", value.get<double>()));
            text += ", at " + joined(values) + " (SI)";
        }
    }
    if (end.interrupted) return "interrupted: " + text + "\nthe same command goes on with the others\n";
    return text + (end.unwritten.empty() ? "\nto look at them: fettle report " + out + "\n" : "\n");
}

Json found_json(const studies::Exploration& found, const std::string& out, const studies::Explored& end) {
    const std::vector<std::size_t> best = found.best();
    const char* status = end.interrupted ? "interrupted" : best.empty() ? "infeasible" : "ok";
    return {
        {"status", status}, {"results", found.results.size()}, {"best", best.empty() ? Json() : found.results[best.front()]}, {"out", out}};
}

int run_explore(const ExploreOptions& options, const CommonOptions& common, Console& console) {
    const Result<reading::DesignFile> file = open_design(options.design, common);
    if (!file) return console.input_errors(file.errors());
    tell_warnings(console, file->warnings);
    const Result<problem::DesignProblem> problem = problem::DesignProblem::create(file->design);
    if (!problem) return console.input_errors(problem.errors());
    const Result<studies::ExplorationRequest> request = request_of(options, problem->design().parameters);
    if (!request) return console.input_errors(request.errors());
    const Result<std::vector<studies::ExplorationJob>> jobs = studies::jobs_of(*problem, *request);
    if (!jobs) return console.input_errors(jobs.errors());
    const Json header = studies::header_of(problem->design(), reading::design_hash(*file), relative_path(options.design, options.out));
    studies::ExploreOptions explore;
    explore.should_stop = interrupted;
    explore.on_result = [&](int done, int of, const Json& result) { console.narrate(studies::progress_text(done, of, result)); };
    std::optional<DaskCluster> cluster;
    if (!options.dask.empty()) {
        Result<DaskCluster> started = DaskCluster::connect(options.dask, {options.design, common.mesh_dirs, common.allow_programs});
        if (!started) return console.input_errors(started.errors());
        cluster.emplace(std::move(started).value());
    }
    Result<studies::ExplorationFile> results = studies::ExplorationFile::open(options.out, header);
    if (!results) return console.input_errors(results.errors());
    Result<studies::Explored> end = [&]() -> Result<studies::Explored> {
        if (cluster) return cluster->explore(*jobs, *results, explore);
        const core::base::ThreadLimit limit(options.workers.value_or(core::base::thread_count()));
        return studies::explore(*problem, *jobs, *results, explore);
    }();
    if (!end) return console.input_errors(end.errors());
    console.unwritten(end->unwritten);
    const studies::Exploration& found = results->found();
    const CheckOutcome outcome = !found.best().empty() ? CheckOutcome::passed
                                 : end->interrupted    ? CheckOutcome::undecided
                                                       : CheckOutcome::failed;
    console.found({"a design meets every requirement", outcome, "requirement", found_text(found, options.out, *end), options.design});
    console.result(found_json(found, options.out, *end), found_text(found, options.out, *end));
    return end->interrupted ? exit_undecided : found.best().empty() ? exit_violated : exit_done;
}

}  // namespace

Command add_explore(CommandLine& program, const CommonOptions& common) {
    auto options = std::make_shared<ExploreOptions>();
    CommandLine line = program.command("explore", "Evaluates many designs, or optimises from many starts, in parallel");
    line.option("DESIGN", options->design, "Design file").required();
    line.option("--out", options->out, "File of the results, a line each; an exploration that is there goes on").required();
    line.option("--sweep", options->sweeps, "NAME=COUNT between its bounds, or NAME=LOW:HIGH:COUNT in its unit; all combinations")
        .one_value_each();
    line.option("--samples", options->samples, "How many designs to draw from the bounds").at_least(0);
    line.option("--starts", options->starts, "How many runs of the optimiser").at_least(0);
    line.option("--seed", options->seed, "Seed of samples and starts").at_least(0);
    line.option("--workers", options->workers, "How many designs at once (default: one for each processor)").at_least(1);
    line.option("--dask", options->dask,
                "Address of a running Dask scheduler, whose workers are used instead; it can run code here: one that you trust. Takes the "
                "Python package");
    line.closing_words("Example:  fettle explore hinge.design.json --out sweep.jsonl --sweep pin_radius=10 --sweep wall=1.6:3:8");
    return {line, [options, &common](Console& console) { return run_explore(*options, common, console); }};
}

}  // namespace fettle::design::cli
