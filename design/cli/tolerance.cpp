// SPDX-License-Identifier: MIT
/// fettle tolerance DESIGN: what becomes of it when its parts are made.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>

#include "design/answers/allocation_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/answers/tolerance_json.hpp"
#include "design/cli/inputs.hpp"
#include "design/report/tolerance_data.hpp"
#include "design/studies/tolerance_file.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::cli {

namespace {

struct Options {
    std::string path, process;
    int samples = 0;
    int seed = 1;
    bool first_order = false, worst_case = false, allocate = false;
    double yield = 0.9973;
    std::string samples_file, report;
};

// What goes by the process that the user names.
void tell_unused_process(Console& console, const reading::DesignFile& file, const std::string& path) {
    const auto is_made = [&](const description::Tolerance& tolerance) { return tolerance.stated.starts_with(file.process + " "); };
    if (std::any_of(file.tolerances.begin(), file.tolerances.end(), is_made)) return;
    tell_warnings(console,
                  {"--process " + file.process + " changes nothing: no tolerance of the design says which `feature` it is of (\"hole\")"},
                  path);
}

// Names it in the answer, and says at its end where it is.
void leave_report(const Options& options, const CommonOptions& common, const report::ToleranceReportSource& source, Console& console,
                  nlohmann::ordered_json& json, std::string& told) {
    if (options.report.empty()) return;
    report::ToleranceReportSource whole = source;
    whole.text = told;
    whole.command = common.command;
    const Errors errors = report::write_tolerance_report(options.report, whole);
    console.unwritten(errors);
    json["report"] = errors.empty() ? nlohmann::ordered_json(options.report) : nlohmann::ordered_json();
    if (errors.empty()) told += "report: " + options.report + "\n";
}

int run_allocation(const Options& options, const CommonOptions& common, const reading::DesignFile& file,
                   const studies::ToleranceOptions& study, Console& console) {
    studies::AllocationOptions allocation;
    allocation.yield = options.yield;
    allocation.worst_case = options.worst_case;
    allocation.study = study;
    const Result<studies::AllocationReport> report = studies::allocate(file, allocation);
    console.end_progress();
    if (!report) return console.input_errors(report.errors());
    tell_warnings(console, report->study.warnings, options.path);
    nlohmann::ordered_json json = answers::allocation_json(file.design, file.tolerances, allocation, *report);
    std::string told = answers::allocation_text(file.design, file.tolerances, allocation, *report);
    reading::DesignFile allocated = file;
    allocated.tolerances = report->tolerances;
    leave_report(options, common, {allocated, report->study}, console, json, told);
    console.result(json, told);
    return report->status == studies::AllocationStatus::held       ? exit_done
           : report->status == studies::AllocationStatus::not_held ? exit_violated
                                                                   : exit_undecided;
}

int run_tolerance(const Options& options, const CommonOptions& common, Console& console) {
    begin_to_read(options.path);
    reading::DesignReadOptions read{common.mesh_dirs, programs_of(common)};
    read.as_made = true;
    read.process = options.process;
    Result<reading::DesignFile> file = reading::read_design(options.path, read);
    if (!file) return console.input_errors(file.errors());
    tell_warnings(console, file->warnings, options.path);
    if (!options.process.empty()) tell_unused_process(console, *file, options.path);
    studies::ToleranceOptions study;
    study.samples = options.samples;
    study.seed = static_cast<std::uint64_t>(options.seed);
    study.second_order = !options.first_order;
    study.worst_case = options.worst_case;
    study.should_stop = interrupted;
    study.on_simulation = [&](int done, int of) { console.progress("simulating", done, of); };
    if (const Errors errors = options.report.empty() ? Errors{} : answers::try_output_file(options.report); !errors.empty())
        return console.input_errors(errors);
    if (options.allocate) return run_allocation(options, common, *file, study, console);
    const Result<studies::ToleranceReport> report = studies::study_tolerances(*file, options.samples_file, study);
    console.end_progress();
    if (!report) return console.input_errors(report.errors());
    tell_warnings(console, report->warnings, options.path);
    nlohmann::ordered_json json = answers::tolerance_json(*file, *report);
    std::string told = answers::tolerance_text(*file, *report, options.process);
    leave_report(options, common, {*file, *report}, console, json, told);
    console.result(json, told);
    return report->reason.empty() && report->no_second_order.empty() && !report->interrupted ? exit_done : exit_undecided;
}

}  // namespace

Command add_tolerance(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("tolerance", "What becomes of a design when its parts are made: spread, contributors, yield");
    auto options = std::make_shared<Options>();
    app.option("DESIGN", options->path, "Design with `tolerances`, taken at its values").required();
    app.option("--samples", options->samples, "Whole simulations of made mechanisms (default 0: predictions alone)").between(0, 1000000);
    app.option(
           "--process", options->process,
           "What makes the features that entries name (\"hole\"), in place of the design's: fdm, sla, sls, mjf, cnc, laser, or your own "
           "NAME.process.json")
        .words_or(tolerances::known_process_names(), "NAME");
    app.option("--seed", options->seed, "Of the samples (default 1)").at_least(0);
    app.option("--samples-file", options->samples_file,
               "Where the samples are kept, a line each: those that are there are not simulated again, so that a run can be interrupted");
    app.option("--report", options->report,
               "Write a page (.html) of it: what moves each number, how it came out in the samples, over what it depends on most");
    app.flag("--first-order", options->first_order, "Predict from one simulation, without the 2 per tolerance that the second order takes");
    app.flag("--worst-case", options->worst_case, "Search for the worst cases by simulations: two searches for each requirement");
    const Option allocate = app.flag("--allocate", options->allocate,
                                     "Find the loosest tolerances with which every requirement has its yield (--worst-case: holds then)");
    app.option("--yield", options->yield, "With --allocate: of each requirement (default 0.9973)")
        .between(0.5001, 0.9999999)
        .needs(allocate);
    app.closing_words(
        "Example:  fettle tolerance examples/slider_crank/slider_crank.design.json --samples 256\n"
        "Predicts, from the derivatives, how far each number that the design asks for spreads over the tolerances, and which of them make\n"
        "it so; samples are simulations of their own, at points that are the same for any number of threads. All of it is computed, none\n"
        "of it proven. Exit code 2: the design as drawn, or one a standard deviation beside it, cannot be simulated.\n"
        "With --allocate: the limits that cost least (`cost` and `fixed` of a tolerance), studied and corrected until they hold; exit code "
        "1:\n"
        "there are none; 2: model and simulations do not settle.");
    return {app, [options, &common](Console& console) { return run_tolerance(*options, common, console); }};
}

}  // namespace fettle::design::cli
