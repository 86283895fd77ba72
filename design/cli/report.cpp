// SPDX-License-Identifier: MIT
/// fettle report DIR: the HTML report of a folder that optimise, simulate or clearance wrote, or of an exploration's file.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "design/answers/output_folder.hpp"
#include "design/cli/command.hpp"
#include "design/cli/inputs.hpp"
#include "design/report/exploration_report.hpp"
#include "design/report/report_folder.hpp"

namespace fettle::design::cli {

namespace {

struct ReportArguments {
    std::string source, out;
};

int run_report(const ReportArguments& arguments, const CommonOptions& common, Console& console) {
    std::error_code ignored;
    if (!std::filesystem::exists(arguments.source, ignored))
        return console.input_errors({{ErrorCode::file_not_found, arguments.source, "there is no such file or folder"}});
    report::ReportOptions options;
    options.out = arguments.out;
    options.mesh_dirs = common.mesh_dirs;
    options.programs = programs_of(common);
    options.should_stop = interrupted;
    options.tell = [&](const std::string& notice) { tell_warnings(console, {notice}, arguments.source); };
    if (!arguments.out.empty()) {
        const Errors errors = answers::try_output_file(arguments.out);
        if (!errors.empty()) return console.input_errors(errors);
    }
    const Result<std::string> made = std::filesystem::is_regular_file(arguments.source, ignored)
                                         ? report::write_exploration_report(arguments.source, options)
                                         : report::write_report(arguments.source, std::move(options));
    if (!made) return console.input_errors(made.errors());
    const bool whole = !interrupted();
    console.result({{"status", whole ? "ok" : "interrupted"}, {"report", *made}}, "report: " + *made + "\n");
    return whole ? exit_done : exit_undecided;
}

}  // namespace

Command add_report(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("report", "Makes the HTML report of a folder of results, or of an exploration");
    auto options = std::make_shared<ReportArguments>();
    app.option("DIR", options->source, "What optimise, simulate or clearance wrote with --out; or the file that explore wrote").required();
    app.option("--out", options->out, "File to write (default: report.html in DIR; for sweep.jsonl, sweep.report.html)");
    app.closing_words("Examples:  fettle report out\n           fettle report sweep.jsonl");
    return {app, [options, &common](Console& console) { return run_report(*options, common, console); }};
}

}  // namespace fettle::design::cli
