// SPDX-License-Identifier: MIT
/// fettle features FILE...: planes, bores, pins, cones, spheres and tori of parts, and which sits in which.
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/cli/inputs.hpp"
#include "design/features/features_report.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::cli {

namespace {

using features::FeaturesReport;
using features::FeaturesStatus;

struct FeaturesArguments {
    clearance::SubjectOptions subject;
    std::vector<std::string> files;
    std::string process, tolerance;
    bool all = false, triangles = false;
};

void tell_checks(const FeaturesReport& report, const std::string& file, Console& console) {
    for (const features::FoundFit& fit : report.fits) {
        CheckOutcome outcome = CheckOutcome::passed;
        for (const features::ProcessVerdict& verdict : fit.processes)
            if (!report.judged_by.empty() && !verdict.is_enough)
                outcome = verdict.fault.empty() ? CheckOutcome::failed : CheckOutcome::undecided;
        console.found(
            {report.name_of(fit.fit.pin) + ":" + report.name_of(fit.fit.hole), outcome, "fit", features::fit_sentence(report, fit), file});
    }
}

int run_features(const FeaturesArguments& options, const CommonOptions& common, Console& console) {
    features::FeaturesQuestion question;
    question.process = options.process;
    question.should_stop = interrupted;
    question.on_body = [&](int done, int of) { console.progress("looking for features", done, of); };
    if (!options.tolerance.empty()) {
        const Result<double> tolerance = core::base::parse_length(options.tolerance, "--tolerance");
        if (!tolerance) return console.input_errors(tolerance.errors());
        if (!(*tolerance > 0)) return console.input_errors({{ErrorCode::out_of_range, "--tolerance", "this is greater than 0"}});
        question.options.tolerance = *tolerance;
    }
    clearance::SubjectWatch watch;
    watch.on_warnings = [&](const std::vector<std::string>& warnings) { tell_warnings(console, warnings, options.subject.path); };
    watch.should_stop = interrupted;
    begin_to_read(options.subject.path);
    const Result<clearance::Subject> subject = clearance::read_subject(options.subject, input_options(common, false), watch);
    if (!subject) return console.input_errors(subject.errors());
    const Result<FeaturesReport> report = features::ask_features(subject->model, question);
    console.end_progress();
    if (!report) return console.input_errors(report.errors());
    tell_checks(*report, options.subject.path, console);
    console.result(features::features_json(*report, options.triangles), features::features_text(*report, options.all));
    const FeaturesStatus status = features::status_of(*report);
    return status == FeaturesStatus::ok ? exit_done : status == FeaturesStatus::violated ? exit_violated : exit_undecided;
}

}  // namespace

Command add_features(CommandLine& program, const CommonOptions& common) {
    CommandLine app =
        program.command("features", "Finds the bores, pins, cones, spheres, tori and planes of parts, and which fit together");
    auto options = std::make_shared<FeaturesArguments>();
    app.option("FILE", options->files, "Meshes and folders of meshes, in place; or a scene, a design (at its values), a trajectory")
        .required();
    app.option("--unit", options->subject.unit, "Unit of meshes that state none: mm, um, cm, m, in, ft, or auto: as their size suggests");
    app.flag("--split", options->subject.split, "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2");
    app.option("--process", options->process,
               "Judge the play of each fit by what this process needs, or your own NAME.process.json (default: all known ones, not judged)")
        .words_or(tolerances::known_process_names(), "NAME");
    app.option(
        "--tolerance", options->tolerance,
        "How far corners may lie from their surface, with its unit (default: the digits of the file, or 6e-5 of the size if it is not "
        "exact)");
    app.flag("--all", options->all, "Also list flat faces and rounded edges one by one");
    app.flag("--triangles", options->triangles, "With --json: which triangles each feature has");
    app.closing_words(
        "Example:  fettle features base.stl lid.stl pin.stl --unit mm\n"
        "B1, P1, ... are named by where they are, the same in every run. Surfaces are fitted, with the largest residual told; the gap of "
        "a\n"
        "fit as assembled is proven, of the facets.");
    return {app, [options, &common](Console& console) {
                options->subject.path = clearance::trajectory_in(options->files.front()).value_or(options->files.front());
                options->subject.more.assign(options->files.begin() + 1, options->files.end());
                return run_features(*options, common, console);
            }};
}

}  // namespace fettle::design::cli
