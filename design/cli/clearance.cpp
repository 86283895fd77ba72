// SPDX-License-Identifier: MIT
/// fettle clearance FILE --minimum L: certified distances of pairs of bodies, as assembled, over a motion or over ranges of joints. What is
/// judged: design/clearance; how it is told: clearance_text.hpp.
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "core/solids/shells.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/clearance/report_json.hpp"
#include "design/cli/clearance_files.hpp"
#include "design/cli/clearance_text.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/step_options.hpp"
#include "design/tolerances/known_processes.hpp"
#include "design/tolerances/process_clearance.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using clearance::Baseline;
using clearance::ClearanceReport;
using clearance::Subject;

struct ClearanceArguments {
    clearance::SubjectOptions subject;
    clearance::PairOptions pairs;
    std::vector<std::string> files;
    std::string minimum, tolerance, csv, baseline, certificate, out;
    int explain = 0;
    double budget = 1;
    bool no_report = false;
};

struct AskedLengths {
    std::optional<double> minimum, tolerance;
};

Result<AskedLengths> read_lengths(const ClearanceArguments& options) {
    AskedLengths lengths;
    Errors errors;
    const auto read = [&](const std::string& text, const char* option, std::optional<double>& out) {
        if (text.empty()) return;
        const Result<double> length = core::base::parse_length(text, option);
        errors.insert(errors.end(), length.errors().begin(), length.errors().end());
        if (length) out = *length;
    };
    read(options.minimum, "--minimum", lengths.minimum);
    read(options.tolerance, "--tolerance", lengths.tolerance);
    if (lengths.minimum && *lengths.minimum < 0) errors.push_back({ErrorCode::out_of_range, "--minimum", "a clearance is not negative"});
    if (lengths.tolerance && !(*lengths.tolerance > 0))
        errors.push_back({ErrorCode::out_of_range, "--tolerance", "a tolerance is greater than 0"});
    if (!errors.empty()) return errors;
    return lengths;
}

ClearanceFiles files_of(const ClearanceArguments& options, const CommonOptions& common) {
    return {options.subject.path, options.csv, options.certificate, options.out, options.no_report, common.scenario, options.pairs.process};
}

/// Says why meshes that are one body are not two parts.
std::string why_not_two(const Subject& subject) {
    const std::string remedy = "name a second mesh, a folder of them, or a 3MF with several parts";
    const int solids = core::solids::solids_of_shells(subject.model.bodies.front().mesh).count;
    if (solids < 2) return "is one part, and a clearance is between two: " + remedy;
    return "is one part of " + std::to_string(solids) + " solids, and a clearance is between two parts: in a scene, its body has " +
           "\"split_components\": true, and here --split, which makes each solid a body of its own; or " + remedy;
}

int run_clearance(const ClearanceArguments& options, const CommonOptions& common, Console& console) {
    const Result<AskedLengths> lengths = read_lengths(options);
    if (!lengths) return console.input_errors(lengths.errors());
    if (const Errors errors = try_files(files_of(options, common)); !errors.empty()) return console.input_errors(errors);
    std::optional<Baseline> baseline;
    if (!options.baseline.empty()) {
        Result<Baseline> read = Baseline::read(options.baseline);
        if (!read) return console.input_errors(read.errors());
        baseline = *std::move(read);
    }
    clearance::SubjectWatch watch;
    watch.on_warnings = [&](const std::vector<std::string>& warnings) { tell_warnings(console, warnings, options.subject.path); };
    watch.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    watch.should_stop = interrupted;
    begin_to_read(options.subject.path);
    const Result<Subject> subject = clearance::read_subject(options.subject, input_options(common), watch);
    if (!subject) return console.input_errors(subject.errors());
    if (!subject->files.empty() && subject->model.bodies.size() < 2)
        return console.input_errors({{ErrorCode::inconsistent, options.subject.path, why_not_two(*subject)}});
    clearance::Question question;
    question.pairs = options.pairs;
    question.pairs.minimum = lengths->minimum;
    question.tolerance = lengths->tolerance;
    question.budget = options.budget;
    question.margins = !options.csv.empty();
    question.all_witnesses = options.explain > 0;
    question.proof = !options.certificate.empty();
    question.on_pair = [&](int done, int of) { console.progress("certifying", done, of); };
    question.should_stop = interrupted;
    Result<ClearanceReport> judged = clearance::judge_clearances(*subject, question);
    if (!judged) return console.input_errors(judged.errors());
    ClearanceReport& report = *judged;
    if (baseline) compare_with(*std::move(baseline), report);
    Json json = report_json(report, *subject);
    std::string text = report_text(report, *subject, options.explain, console);
    console.unwritten(leave_files(files_of(options, common), *subject, report, common, console, json, text));
    for (Check& check : report_checks(report, *subject, options.subject.path)) console.found(std::move(check));
    console.result(json, text);
    return exit_code(report.status);
}

void add_options(CommandLine& app, ClearanceArguments& options) {
    app.option("FILE", options.files, "Scene, design (at its values), or trajectory; or meshes and folders of meshes, in place").required();
    app.option("--unit", options.subject.unit, "Unit of meshes that state none: mm, um, cm, m, in, ft, or auto: as their size suggests");
    app.flag("--split", options.subject.split,
             "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2 (a print in place is one file)");
    add_step_options(app, options.subject.step);
    app.option("--minimum", options.minimum, "Required clearance per side, with its unit: 0.3mm (without any: distances and clashes)");
    app.option(
           "--process", options.pairs.process,
           "Required clearance by process (below, or your own NAME.process.json) and size of the parts; with --tolerances also what makes "
           "them, in place of the design's")
        .words_or(tolerances::known_process_names(), "NAME");
    app.option("--pairs", options.pairs.pairs,
               "Pairs A:B,C:D by names of bodies or groups, A:B=0.4mm with a minimum of its own; `*` for any letters, of the pairs that "
               "no joint, group or `ignore` of the scene exempts (default: every such pair as assembled, of those the ones that may "
               "collide over a motion)");
    app.option("--ignore", options.pairs.ignore, "Pairs A:B,... that are not judged");
    Option touch = app.option("--allow-touch", options.pairs.touches,
                              "Pair A:B that may touch, face on face, but not intersect; A:B=0.02mm: no deeper than that, over a motion "
                              "proven of about a quarter of it (can be given several times)")
                       .one_value_each();
    app.option("--group", options.pairs.groups, "name=a,b,c: bodies that are one rigid set (can be given several times)").one_value_each();
    app.option("--tolerance", options.tolerance,
               "How far the two bounds may be apart (default: the lesser of 0.001mm and 0.1% of the minimum)");
    app.option(
           "--budget", options.budget,
           "How many times as much work as by default may be spent on one pair before it is undecided (default: 1; over ranges of joints "
           "4 million bounds)")
        .above(0);
    Option motion =
        app.flag("--motion", options.subject.motion, "Over the motion, which is simulated first (a trajectory: always); else as assembled");
    Option kinematic = app.flag("--kinematic", options.subject.kinematic,
                                "Over the motion of scripts and motors, without dynamics; bodies without either stay where they are");
    Option poses = app.option("--poses", options.subject.poses,
                              "Over the poses in this file (.csv or .json, of any program); FILE supplies the meshes");
    app.option("--poses-unit", options.subject.poses_unit, "Unit of lengths in a CSV that does not say px[mm]").needs(poses);
    kinematic.excludes(motion).excludes(poses);
    poses.excludes(motion);
    Option steps = app.option("--steps", options.subject.steps, "How many steps of the motion").at_least(0);
    Option time = app.option("--time", options.subject.time, "How long, in seconds").at_least(0).excludes(steps);
    app.option("--explain", options.explain, "Details of the worst pairs (default 3): when, where, poses, points, what sampling would see")
        .value_if_bare("3")
        .at_least(0);
    app.option("--csv", options.csv,
               "Write the margin curves: certified bounds for each pair and stretch of the path (with --ranges: a row for each pair, with "
               "the joints' positions where it is worst)");
    app.option("--certificate", options.certificate,
               "Write the proof as data, and beside it the trajectory that it is about; fettle validate checks it without the search");
    app.option("--out", options.out, "Folder for result.json (the answer), trajectory.json (meshes and path) and report.html");
    app.flag("--no-report", options.no_report, "With --out: no report.html");
    app.option("--baseline", options.baseline, "Compare with an earlier report (--json): which findings are new, existing, resolved");
    app.flag("--tolerances", options.subject.tolerances,
             "Over all parts within the `tolerances` of a design, in every combination (as assembled, with --ranges or with --kinematic)")
        .excludes(motion)
        .excludes(poses)
        .excludes(touch);
    app.flag("--ranges", options.subject.ranges, "Over all positions of the joints within their limits, in every combination")
        .excludes(motion)
        .excludes(kinematic)
        .excludes(poses)
        .excludes(touch)
        .excludes(steps)
        .excludes(time);
}

}  // namespace

Command add_clearance(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("clearance", "Certifies the least distance of each pair of bodies");
    auto options = std::make_shared<ClearanceArguments>();
    add_options(app, *options);
    app.closing_words(
        tolerances::clearance_table() +
        "Example:  fettle clearance bracket.stl lid.stl --unit mm --minimum 0.3mm     exit code 1: closer than that\n"
        "          fettle clearance examples/slider_crank/slider_crank.scene.json --minimum 0.3mm --pairs crank:rod,rod:piston\n"
        "          fettle clearance examples/slider_crank/slider_crank.scene.json --process fdm --motion --steps 40 --explain");
    return {app, [options, &common](Console& console) {
                options->subject.path = clearance::trajectory_in(options->files.front()).value_or(options->files.front());
                if (options->subject.tolerances) options->subject.process = options->pairs.process;
                options->subject.more.assign(options->files.begin() + 1, options->files.end());
                return run_clearance(*options, common, console);
            }};
}

}  // namespace fettle::design::cli
