// SPDX-License-Identifier: MIT
/// fettle check-resolution DESIGN: how much of its numbers is its facets' and its time step's.
#include <memory>
#include <nlohmann/json.hpp>

#include "fettle/core/base/text.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/description/requirement_text.hpp"
#include "fettle/design/studies/resolution.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using studies::ResolutionReport;
using studies::ResolvedQuantity;

/// The unit that a quantity is counted in.
struct CountedUnit {
    double si = 1;
    std::string name;
};

CountedUnit unit_of(const description::Design& design, const ResolvedQuantity& quantity) {
    if (!quantity.of_objective) {
        const description::Constraint& constraint = design.constraints[quantity.index];
        return {constraint.bounds.unit, description::unit_name(constraint)};
    }
    const description::ObjectiveTerm& term = design.objective[quantity.index];
    return {term.unit, core::base::unit_name(term.quantity->dimension(), term.unit)};
}

Json json_of(const ResolutionReport& report) {
    Json json;
    json["status"] = report.failure.empty() ? "ok" : report.interrupted ? "interrupted" : "not_evaluated";
    if (!report.failure.empty()) {
        json["message"] = report.failure;
        return json;
    }
    json["quantities"] = Json::array();
    for (const ResolvedQuantity& quantity : report.quantities)
        json["quantities"].push_back({{"name", quantity.name},
                                      {"of", quantity.of_objective ? "objective" : "constraint"},
                                      {"as_written", quantity.as_written},
                                      {"finer_facets", quantity.finer_facets},
                                      {"finer_steps", quantity.finer_steps},
                                      {"finer_both", quantity.finer_both},
                                      {"change", quantity.change()}});
    json["fixed_meshes"] = report.fixed_meshes;
    return json;
}

std::string text_of(const description::Design& design, const ResolutionReport& report) {
    std::string text =
        formatted("%-40s %13s %13s %13s %13s   %s\n", "quantity", "as written", "twice facets", "half step", "both", "changes by");
    for (const ResolvedQuantity& quantity : report.quantities) {
        const CountedUnit unit = unit_of(design, quantity);
        const std::string name = quantity.name + (unit.name.empty() ? "" : " [" + unit.name + "]");
        text += formatted("%-40s %13.6g %13.6g %13.6g %13.6g   %s\n", name.c_str(), quantity.as_written / unit.si,
                          quantity.finer_facets / unit.si, quantity.finer_steps / unit.si, quantity.finer_both / unit.si,
                          core::base::percent(quantity.change()).c_str());
    }
    if (!report.fixed_meshes.empty())
        text += "facets that stay as they are, of mesh files and programs: " + core::base::joined(report.fixed_meshes) + "\n";
    return text;
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
    const bool done = report->failure.empty();
    console.result(json_of(*report), done ? text_of(read->design, *report) : "the design cannot be measured: " + report->failure + "\n");
    return done ? exit_done : exit_undecided;
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
        "What changes by 1% with both is exact to about 1%. Meshes of files and of programs keep their facets. Nothing is proven by this: "
        "distances\n"
        "are certified for the meshes as they are, and for round surfaces, by `fettle clearance`.\n"
        "Exit code 2: one of the four cannot be simulated.");
    return {app, [path, &common](Console& console) { return run_check_resolution(*path, common, console); }};
}

}  // namespace fettle::design::cli
