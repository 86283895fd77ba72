// SPDX-License-Identifier: MIT
/// fettle clearance FILE --minimum L: certified distances of pairs of bodies, as assembled or over a motion. What is judged:
/// clearance_subject.hpp (motions), clearance_pairs.hpp (pairs and what they require); how it is told: clearance_report.hpp.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "fettle/core/base/units.hpp"
#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/answers/run_folder.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/clearance_folder.hpp"
#include "fettle/design/cli/clearance_ranges.hpp"
#include "fettle/design/cli/clearance_report.hpp"
#include "fettle/design/cli/mesh_subject.hpp"
#include "fettle/design/cli/output_folder.hpp"
#include "fettle/design/quantities/process_presets.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::clearance::PairStatus;

struct ClearanceArguments {
    SubjectOptions subject;
    PairOptions pairs;
    std::vector<std::string> files;
    std::string minimum, tolerance, csv, baseline, certificate, out;
    int explain = 0;
    bool ranges = false, no_report = false;
};

// 1 um, or 0.1% of the least that is asked for if that is less.
double default_tolerance(const PairSelection& selection) {
    double tolerance = 1e-6;
    for (const PairSpec& pair : selection.pairs) {
        if (pair.minimum > 0) tolerance = std::min(tolerance, 1e-3 * pair.minimum);
    }
    return tolerance;
}

// Of more pairs than this nobody reads each distance: those that nobody named, and that stay twice their minimum apart, are left at that.
constexpr std::size_t most_measured = 100;

std::vector<core::clearance::PairRequest> requests_of(const PairSelection& selection, bool all_measured) {
    std::vector<core::clearance::PairRequest> requests;
    for (const PairSpec& pair : selection.pairs) {
        for (const auto& [a, b] : pair.body_pairs) {
            requests.push_back({a, b, pair.minimum});
            requests.back().may_touch = pair.may_touch;
            requests.back().touch_depth = pair.touch_depth;
        }
    }
    if (all_measured || requests.size() <= most_measured) return requests;
    auto request = requests.begin();
    for (const PairSpec& pair : selection.pairs) {
        for (std::size_t i = 0; i < pair.body_pairs.size(); ++i, ++request) {
            if (!pair.named && pair.minimum > 0) request->far = 2 * pair.minimum;
        }
    }
    return requests;
}

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

// Those that are not judged: a clash of theirs is found, and they become rows of the report for it.
std::vector<core::clearance::PairClearance> clashes_of_left_out(const Subject& subject, core::clearance::ClearanceOptions certify,
                                                                PairSelection& selection) {
    certify.margin_curve = certify.sample_nodes = false;
    certify.certificate = nullptr;
    certify.on_pair = nullptr;
    certify.enough = 10 * certify.tolerance;
    std::vector<core::clearance::PairRequest> requests;
    for (const PairSpec& pair : selection.left_out) {
        for (const auto& [a, b] : pair.body_pairs) requests.push_back({a, b, 0, certify.enough});
    }
    const auto found = certified(subject, requests, certify);
    std::vector<core::clearance::PairClearance> clashes;
    std::vector<PairSpec> apart;
    auto first = found.begin();
    for (PairSpec& pair : selection.left_out) {
        const auto last = first + static_cast<std::ptrdiff_t>(pair.body_pairs.size());
        if (std::any_of(first, last, [](const auto& each) { return each.is_clash(); })) {
            clashes.insert(clashes.end(), first, last);
            selection.pairs.push_back(std::move(pair));
        } else {
            apart.push_back(std::move(pair));
        }
        first = last;
    }
    selection.left_out = std::move(apart);
    return clashes;
}

// That two touch, which is accepted, is not what a certificate can say: its bounds would call it too close.
void leave_out_touching(const std::vector<core::clearance::PairClearance>& results, core::certificate::Certificate& certificate) {
    std::erase_if(certificate.pairs, [&](const core::certificate::PairCertificate& pair) {
        return std::any_of(results.begin(), results.end(), [&](const core::clearance::PairClearance& each) {
            return each.a == pair.a && each.b == pair.b && each.touch && each.status == PairStatus::contact;
        });
    });
}

// The certificate, and beside it the trajectory that it speaks of, unless that is a file already.
Errors write_proof(const std::string& path, core::certificate::Certificate& certificate, const Subject& subject) {
    if (!is_finite(subject.trajectory))
        return {{ErrorCode::not_finite, path, "the path has numbers that are not finite, so that nothing can be certified of it"}};
    if (!subject.files.empty()) {  // meshes: their files are what the proof is about
        auto named = named_files(subject.files, path);
        if (!named) return named.errors();
        certificate.exports = std::move(*named);
    }
    core::files::FilesTogether files;
    Errors errors;
    if (subject.source != SubjectSource::trajectory)
        errors = core::records::add_trajectory(files, certificate_trajectory(path), subject.trajectory, subject.model, subject.scene_path);
    if (errors.empty()) errors = core::certificate::add_certificate(files, path, certificate);
    return errors.empty() ? files.take_names() : errors;
}

// Where nothing is proven, the certificate of an earlier run must not stay, nor its trajectory, unless that is what was judged.
Errors take_away_proof(const std::string& path, const Subject& subject) {
    if (!core::certificate::is_certificate_file(path)) return {};
    core::files::FilesTogether files;
    files.take_away(path);
    const std::string beside = certificate_trajectory(path);
    if (subject.source != SubjectSource::trajectory && core::records::is_trajectory_file(beside)) files.take_away(beside);
    return files.take_names();
}

Json proof_json(const ClearanceArguments& options, const Subject& subject) {
    const bool own = subject.source == SubjectSource::trajectory;
    return {{"file", options.certificate}, {"trajectory", own ? options.subject.path : certificate_trajectory(options.certificate)}};
}

/// What would be found out only after the work: files that cannot be written.
Errors try_files(const ClearanceArguments& options) {
    for (const std::string& file : {options.csv, options.certificate}) {
        if (file.empty()) continue;
        if (Errors errors = try_output_file(file); !errors.empty()) return errors;
    }
    if (!options.certificate.empty() && !core::records::is_trajectory_file(options.subject.path)) {  // a trajectory is written beside it
        if (Errors errors = answers::others_file(certificate_trajectory(options.certificate)); !errors.empty()) return errors;
    }
    if (!options.out.empty()) {
        if (Errors errors = try_run_folder(options.out); !errors.empty()) return errors;
    }
    return {};
}

ClearanceFolder folder_of(const ClearanceArguments& options) { return {options.out, options.subject.path, options.no_report}; }

int run_ranges(const ClearanceArguments& options, const AskedLengths& lengths, std::optional<Baseline> baseline,
               const CommonOptions& common, Console& console) {
    if (!options.subject.more.empty())
        return console.input_errors({{ErrorCode::inconsistent, "--ranges", "is of one scene or design: meshes have no joints"}});
    RangeQuestion question{options.subject.path, options.pairs,       lengths.tolerance, options.explain,
                           options.certificate,  std::move(baseline), options.csv,       folder_of(options)};
    question.pairs.minimum = lengths.minimum;
    return clearance_over_ranges(std::move(question), common, console);
}

int run_clearance(const ClearanceArguments& options, const CommonOptions& common, Console& console) {
    const Result<AskedLengths> lengths = read_lengths(options);
    if (!lengths) return console.input_errors(lengths.errors());
    if (const Errors errors = try_files(options); !errors.empty()) return console.input_errors(errors);
    std::optional<Baseline> baseline;
    if (!options.baseline.empty()) {
        Result<Baseline> read = Baseline::read(options.baseline);
        if (!read) return console.input_errors(read.errors());
        baseline = *std::move(read);
    }
    if (options.ranges) return run_ranges(options, *lengths, std::move(baseline), common, console);
    Result<Subject> subject = load_subject(options.subject, common, console);
    if (!subject) return console.input_errors(subject.errors());
    if (!subject->files.empty() && subject->model.bodies.size() < 2)
        return console.input_errors({{ErrorCode::inconsistent, options.subject.path,
                                      "is one part, and a clearance is between two: name a second mesh, a folder of them, or a 3MF with "
                                      "several parts"}});
    PairOptions pair_options = options.pairs;
    pair_options.minimum = lengths->minimum;
    pair_options.motion = subject->motion();
    if (lengths->minimum && !options.pairs.process.empty())
        subject->notes.push_back("--minimum applies; what --process " + options.pairs.process + " requires was not judged");
    Result<PairSelection> selection = select_pairs(subject->model, pair_options);
    if (!selection) return console.input_errors(selection.errors());

    core::clearance::ClearanceOptions certify;
    certify.tolerance = lengths->tolerance.value_or(default_tolerance(*selection));
    certify.motion = subject->motion();
    certify.margin_curve = !options.csv.empty();
    certify.witness_tolerance = options.explain > 0 ? certify.tolerance : 0;
    certify.on_pair = [&](int done, int of) { console.progress("certifying", done, of); };
    certify.should_stop = interrupted;
    core::certificate::Certificate certificate;
    if (!options.certificate.empty()) certify.certificate = &certificate;
    auto results = certified(*subject, requests_of(*selection, certify.margin_curve), certify);
    leave_out_touching(results, certificate);
    const auto clashes = clashes_of_left_out(*subject, certify, *selection);
    results.insert(results.end(), clashes.begin(), clashes.end());
    if (subject->source != SubjectSource::trajectory && subject->files.empty() && !options.certificate.empty())
        certificate.source = name_from_certificate(options.certificate, options.subject.path);
    ClearanceReport report = make_report(*subject, *selection, results, certify.tolerance, interrupted());
    if (baseline) compare_with(*std::move(baseline), report);
    const std::string unit = answers::unit_name(subject->model.length_unit);
    Errors errors;  // of files: the verdict is told all the same
    if (!options.csv.empty()) console.unwritten(core::files::write_file_atomically(options.csv, margins_csv(report, *subject, unit)));
    const bool is_proof = !options.certificate.empty() && !certificate.pairs.empty();  // there is something to certify
    if (is_proof) errors = write_proof(options.certificate, certificate, *subject);
    if (!options.certificate.empty() && !is_proof) errors = take_away_proof(options.certificate, *subject);
    console.unwritten(errors);
    Json json = report_json(report, *subject);
    std::string text = report_text(report, *subject, unit, options.explain, console);
    if (!options.certificate.empty() && !is_proof) {
        json["certificate"] = Json();
        text += "certificate: not written, for nothing is proven\n";
    } else if (is_proof && errors.empty()) {
        json["certificate"] = proof_json(options, *subject);
        text += "certificate: " + options.certificate + ", of the path in " + json["certificate"]["trajectory"].get<std::string>() +
                "; check it with fettle validate " + options.certificate +
                (subject->source == SubjectSource::trajectory ? " --trajectory " + options.subject.path : "") + "\n";
    }
    console.unwritten(
        write_folder(folder_of(options), {subject->model, subject->trajectory, subject->scene_path}, common, console, json, text));
    for (Check& check : report_checks(report, *subject, unit, options.subject.path)) console.found(std::move(check));
    console.result(json, text);
    return exit_code(report.status);
}

std::vector<std::string> process_names() {
    std::vector<std::string> names;
    for (const quantities::ProcessPreset& preset : quantities::process_presets()) names.emplace_back(preset.name);
    return names;
}

void add_options(CommandLine& app, ClearanceArguments& options) {
    app.option("FILE", options.files, "Scene, design (at its values), or trajectory; or meshes and folders of meshes, as they lie")
        .required();
    app.option("--unit", options.subject.unit, "Of meshes that state none: mm, um, cm, m, in, ft");
    app.option("--minimum", options.minimum,
               "Required clearance per side, with its unit: 0.3mm (none at all: distances are told, and clashes)");
    app.option("--process", options.pairs.process, "Required clearance by process and size of the parts (below)").one_of(process_names());
    app.option("--pairs", options.pairs.pairs,
               "A:B,C:D by names of bodies or groups, `*` for any letters, A:B=0.4mm with a minimum of its own (default: every pair "
               "as assembled, every pair that may collide over a motion)");
    app.option("--ignore", options.pairs.ignore, "A:B,... that are not judged");
    Option touch = app.option("--allow-touch", options.pairs.touches,
                              "A:B that may touch, face on face, but not be in each other; A:B=0.02mm: no deeper than that (can be given "
                              "several times)")
                       .one_value_each();
    app.option("--group", options.pairs.groups, "name=a,b,c: bodies that are one rigid set (can be given several times)").one_value_each();
    app.option("--tolerance", options.tolerance, "How far the two bounds may be apart (default: 0.001mm or 0.1% of the minimum, the less)");
    Option motion =
        app.flag("--motion", options.subject.motion, "Over the motion, which is simulated first (a trajectory: always); else as assembled");
    Option kinematic = app.flag("--kinematic", options.subject.kinematic,
                                "Over the scripted motion without dynamics: what has no script stays where it is");
    Option poses = app.option("--poses", options.subject.poses,
                              "Over the poses in this file (.csv or .json, of any program); FILE supplies the meshes");
    app.option("--poses-unit", options.subject.poses_unit, "Unit of lengths in a CSV that does not say px[mm]").needs(poses);
    kinematic.excludes(motion).excludes(poses);
    poses.excludes(motion);
    Option steps = app.option("--steps", options.subject.steps, "How many steps of the motion").at_least(0);
    Option time = app.option("--time", options.subject.time, "How long, in seconds").at_least(0).excludes(steps);
    app.option("--explain", options.explain, "Tell of the worst pairs (default 3): when, where, poses, points, what sampling would see")
        .value_if_bare("3")
        .at_least(0);
    app.option("--csv", options.csv,
               "Write the margin curves: certified bounds for each pair and stretch of the path (with --ranges: a row for each pair, with "
               "the joints' positions where it is worst)");
    app.option("--certificate", options.certificate,
               "Write the proof as data, and beside it the trajectory that it speaks of: fettle validate checks it independently");
    app.option("--out", options.out, "Folder for result.json (the answer), trajectory.json (meshes and path) and report.html");
    app.flag("--no-report", options.no_report, "With --out: no report.html");
    app.option("--baseline", options.baseline, "An earlier report (--json): which findings are new, existing, resolved");
    app.flag("--ranges", options.ranges, "Over all positions of the joints within their limits, in every combination")
        .excludes(motion)
        .excludes(kinematic)
        .excludes(poses)
        .excludes(touch)
        .excludes(steps)
        .excludes(time);
}

}  // namespace

Command add_clearance(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("clearance", "Certified least distance of each pair of bodies");
    auto options = std::make_shared<ClearanceArguments>();
    add_options(app, *options);
    app.closing_words(
        quantities::process_table() +
        "Example:  fettle clearance bracket.stl lid.stl --unit mm --minimum 0.3mm     exit code 1: closer than that\n"
        "          fettle clearance examples/slider_crank/slider_crank.scene.json --minimum 0.3mm --pairs crank:rod,rod:piston\n"
        "          fettle clearance examples/slider_crank/slider_crank.scene.json --process fdm --motion --steps 40 --explain");
    return {app, [options, &common](Console& console) {
                options->subject.path = trajectory_in(options->files.front()).value_or(options->files.front());
                options->subject.more.assign(options->files.begin() + 1, options->files.end());
                return run_clearance(*options, common, console);
            }};
}

}  // namespace fettle::design::cli
