// SPDX-License-Identifier: MIT
/// fettle check-resolution DESIGN: how much of its numbers is its facets' and its time step's.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "design/answers/answer_json.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/inputs.hpp"
#include "design/description/requirement_text.hpp"
#include "design/studies/resolution.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using studies::ResolutionReport;
using studies::ResolutionRun;
using studies::ResolvedQuantity;

// A run's key in JSON, and the title of its column.
struct Column {
    double ResolvedQuantity::*value;
    const char* key;
    const char* title;
};
constexpr Column columns[] = {{&ResolvedQuantity::as_written, "as_written", "as written"},
                              {&ResolvedQuantity::finer_facets, "finer_facets", "twice facets"},
                              {&ResolvedQuantity::finer_steps, "finer_steps", "half step"},
                              {&ResolvedQuantity::finer_both, "finer_both", "both"},
                              {&ResolvedQuantity::settled_friction, "settled_friction", "settled"}};

const Column& column_of(const ResolutionRun& run) {
    return *std::find_if(std::begin(columns), std::end(columns), [&](const Column& column) { return column.value == run.value; });
}
const char* key_of(const ResolutionRun& run) { return column_of(run).key; }
const char* title_of(const ResolutionRun& run) { return column_of(run).title; }

description::CountedUnit unit_of(const description::Design& design, const ResolvedQuantity& quantity) {
    if (!quantity.of_objective) return description::counted_unit(design.constraints[quantity.index]);
    const description::ObjectiveTerm& term = design.objective[quantity.index];
    return {term.unit, core::base::unit_name(term.quantity->dimension(), term.unit)};
}

std::string message_of(const ResolutionReport& report) {
    std::vector<std::string> names;
    for (const ResolutionRun& run : report.runs)
        if (!run.failure.empty()) names.push_back(run.name);
    return "not simulated: " + core::base::joined(names);
}

Json json_of(const ResolutionReport& report) {
    Json json;
    json["status"] = report.interrupted ? "interrupted" : report.is_complete() ? "ok" : "undecided";
    if (!report.is_complete()) json["message"] = message_of(report);
    json["quantities"] = Json::array();
    for (const ResolvedQuantity& quantity : report.quantities) {
        Json entry = {{"name", quantity.name}, {"of", quantity.of_objective ? "objective" : "constraint"}};
        for (const ResolutionRun& run : report.runs) entry[key_of(run)] = answers::finite_or_null(quantity.*run.value);
        entry["change"] = answers::finite_or_null(quantity.change());
        if (report.friction_lags) entry["change_by_friction"] = answers::finite_or_null(quantity.change_by_friction());
        json["quantities"].push_back(std::move(entry));
    }
    json["failures"] = Json::array();
    for (const ResolutionRun& run : report.runs)
        if (!run.failure.empty()) json["failures"].push_back({{"run", key_of(run)}, {"reason", run.failure}});
    json["friction_lags"] = report.friction_lags;
    json["fixed_meshes"] = report.fixed_meshes;
    return json;
}

std::string share_text(double share) { return std::isfinite(share) ? core::base::percent(share) : "-"; }

// The worth of the largest change by settled friction, and what to do about it.
std::string friction_text(const ResolutionReport& report) {
    const ResolvedQuantity* most = nullptr;
    for (const ResolvedQuantity& quantity : report.quantities)
        if (std::isfinite(quantity.change_by_friction()) && (most == nullptr || quantity.change_by_friction() > most->change_by_friction()))
            most = &quantity;
    std::string text =
        "friction lags in this scene: each step uses normal forces and directions of a round before (\"friction\": {\"rounds\"} is a "
        "number). ";
    if (most == nullptr) return text + "What this changes is not known.\n";
    return text + "Settled (\"rounds\": \"converged\"), it changes `" + most->name + "` most, by " +
           core::base::percent(most->change_by_friction()) + "\n";
}

std::string text_of(const description::Design& design, const ResolutionReport& report) {
    std::string text = formatted("%-40s", "quantity");
    for (const ResolutionRun& run : report.runs) text += formatted(" %13s", title_of(run));
    text += formatted("   %-10s%s\n", "changes by", report.friction_lags ? "  by friction" : "");
    for (const ResolvedQuantity& quantity : report.quantities) {
        const description::CountedUnit unit = unit_of(design, quantity);
        const std::string name = quantity.name + (unit.name.empty() ? "" : " [" + unit.name + "]");
        text += formatted("%-40s", name.c_str());
        for (const ResolutionRun& run : report.runs)
            text += run.failure.empty() ? formatted(" %13.6g", quantity.*run.value / unit.si) : formatted(" %13s", "-");
        text += report.friction_lags
                    ? formatted("   %-10s  %s\n", share_text(quantity.change()).c_str(), share_text(quantity.change_by_friction()).c_str())
                    : formatted("   %s\n", share_text(quantity.change()).c_str());
    }
    if (report.friction_lags) text += friction_text(report);
    if (!report.fixed_meshes.empty())
        text += "facets that stay as they are, of mesh files and programs: " + core::base::joined(report.fixed_meshes) + "\n";
    for (const ResolutionRun& run : report.runs)
        if (!run.failure.empty()) text += "not simulated " + run.name + ": " + run.failure + "\n";
    if (report.interrupted) return text + "interrupted\n";
    return report.is_complete() ? text : text + "undecided: not all could be simulated\n";
}

int run_check_resolution(const std::string& path, const CommonOptions& common, Console& console) {
    const Result<reading::DesignFile> read = open_design(path, common);  // told with its warnings, once
    if (!read) return console.input_errors(read.errors());
    tell_warnings(console, read->warnings, path);
    studies::ResolutionOptions options;
    options.should_stop = interrupted;
    options.on_variant = [&](const std::string& what) { console.narrate("simulating " + what); };
    const Result<ResolutionReport> report = studies::check_resolution(path, {common.mesh_dirs, programs_of(common)}, options);
    if (!report) return console.input_errors(report.errors());
    console.result(json_of(*report), text_of(read->design, *report));
    return report->is_complete() && !report->interrupted ? exit_done : exit_undecided;
}

}  // namespace

Command add_check_resolution(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("check-resolution", "Measures a design with finer facets and time steps: how exact its numbers are");
    auto path = std::make_shared<std::string>();
    app.option("DESIGN", *path, "Design, taken at its values").required();
    app.closing_words(
        "Example:  fettle check-resolution examples/slider_crank/slider_crank.design.json\n"
        "Four simulations: as written, with twice as many facets along what is round, with half the time step, and with both; contact as "
        "written.\n"
        "What changes by 1% with both is exact to about 1%. A scene whose friction lags (\"rounds\" is a number) is simulated once more, "
        "with\n"
        "friction that settles (\"rounds\": \"converged\"). Meshes of files and of programs keep their facets. Nothing is proven by this:\n"
        "distances are certified for the meshes as they are, and for round surfaces, by `fettle clearance`.\n"
        "Exit code 2: one of these cannot be simulated; the table has the numbers of the others.");
    return {app, [path, &common](Console& console) { return run_check_resolution(*path, common, console); }};
}

}  // namespace fettle::design::cli
