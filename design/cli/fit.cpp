// SPDX-License-Identifier: MIT
/// fettle fit FILE... --process P --to FOLDER: opens bores (or pins) that are too tight, and proves what was made.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/unique_names.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/model/body_geometry.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/cli/step_options.hpp"
#include "design/features/fit_parts.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using features::FeaturesReport;
using Json = nlohmann::ordered_json;

struct FitArguments {
    std::vector<std::string> paths;
    std::string unit, process, clearance, change = "holes", to;
    bool split = false, close = false;
    reading::StepWishes step;
};

Result<features::FitWish> wish_of(const FitArguments& arguments) {
    features::FitWish wish;
    if (arguments.process.empty() && arguments.clearance.empty())
        return Error{ErrorCode::missing_key, "--process", "say what is wanted: --process fdm, or --clearance 0.3mm"};
    if (!arguments.clearance.empty()) {
        const Result<double> clearance = core::base::parse_length(arguments.clearance, "--clearance");
        if (!clearance) return clearance.errors();
        if (!(*clearance > 0)) return Error{ErrorCode::out_of_range, "--clearance", "this is greater than 0"};
        wish.clearance = *clearance;
    }
    wish.change = arguments.change == "pins"   ? features::FitChange::pins
                  : arguments.change == "both" ? features::FitChange::both
                                               : features::FitChange::holes;
    wish.close = arguments.close;
    return wish;
}

// Binary STL where all parts come from STL, else 3MF, whose digits lose nothing.
bool are_all_stl(const clearance::MeshParts& parts) {
    return std::all_of(parts.sources.begin(), parts.sources.end(), [](const clearance::MeshSource& source) {
        std::string extension = fs::path(source.file).extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
        return extension == ".stl";
    });
}

struct Written {
    std::vector<std::string> files;  // one for each body
    Errors errors;
};

Written write_parts(const FeaturesReport& report, const features::FitPlan& plan, bool as_stl, const FitArguments& arguments,
                    const CommonOptions& common) {
    Written out;
    core::files::UniqueNames names("_", true);
    core::files::FilesTogether together;
    std::vector<NamedFile> written;
    for (std::size_t b = 0; b < plan.parts.size() && out.errors.empty(); ++b) {
        const std::string& name = report.model.bodies[b].name;
        const fs::path path = fs::path(arguments.to) / (names.unique(core::files::file_stem(name)) + (as_stl ? ".stl" : ".3mf"));
        const std::vector<core::mesh_files::MeshPart> part{{name, &plan.parts[b]}};
        const Result<std::string> bytes = as_stl ? core::mesh_files::stl_bytes(part) : core::mesh_files::threemf_bytes(part);
        out.errors = bytes ? together.add(path, *bytes) : bytes.errors();
        out.files.push_back(path.string());
        written.push_back({"--to", path.string(), true});
    }
    if (out.errors.empty()) out.errors = replaced_inputs(written, common.given);
    if (out.errors.empty()) out.errors = together.take_names();
    return out;
}

// The parts as written, with the names of before.
Result<clearance::MeshParts> read_again(const std::vector<std::string>& files, const core::model::Model& before,
                                        const CommonOptions& common) {
    Result<clearance::MeshParts> parts = clearance::load_meshes(files, "mm", input_options(common, false));
    if (!parts) return parts;
    for (std::size_t b = 0; b < before.bodies.size(); ++b) parts->model.bodies[b].name = before.bodies[b].name;
    return parts;
}

int run_fit(const FitArguments& arguments, const CommonOptions& common, Console& console) {
    Result<features::FitWish> wish = wish_of(arguments);
    if (!wish) return console.input_errors(wish.errors());
    const Result<clearance::MeshParts> parts =
        clearance::load_meshes(arguments.paths, arguments.unit, input_options(common, false), arguments.split, arguments.step);
    if (!parts) return console.input_errors(parts.errors());
    tell_warnings(console, parts->warnings);
    features::FeaturesQuestion ask;
    ask.process = arguments.process;
    ask.should_stop = interrupted;
    ask.on_body = [&](int done, int of) { console.progress("looking for features", done, of); };
    Result<FeaturesReport> before = features::ask_features(parts->model, ask);
    console.end_progress();
    if (!before) return console.input_errors(before.errors());
    const auto nothing = [&](const std::string& why) {
        console.result({{"status", "undecided"}, {"message", why}, {"files", Json::array()}}, why + ": nothing is written\n");
        return exit_undecided;
    };
    if (before->interrupted) return nothing("interrupted before the fits were known");
    std::erase_if(before->fits, [](const features::FoundFit& found) { return !found.fit.is_held; });
    if (before->fits.empty()) return nothing("no pin sits in a bore of another part, and no ball in a socket");
    const bool as_stl = are_all_stl(*parts);
    double largest = 0;
    for (const core::model::Body& body : parts->model.bodies)
        largest = std::max(largest, core::model::mesh_at_start(body).vertices.cwiseAbs().maxCoeff());
    constexpr double least = 1e-6, of_floats = 2.4e-7;  // [m]; two corners, each off by half of the last digit, in three coordinates
    wish->reserve = least + (as_stl ? of_floats * largest : 0);
    const Result<features::FitPlan> plan = features::plan_fits(*before, *wish);
    if (!plan) return console.input_errors(plan.errors());
    const Written written = write_parts(*before, *plan, as_stl, arguments, common);
    if (!written.errors.empty()) return console.input_errors(written.errors);
    const Result<clearance::MeshParts> again = read_again(written.files, parts->model, common);
    if (!again) return console.input_errors(again.errors());
    ask.fits = false;
    const Result<FeaturesReport> after = features::ask_features(again->model, ask);
    if (!after) return console.input_errors(after.errors());
    const std::vector<features::JudgedFit> fits = features::judge_fits(*before, *plan, *after, interrupted);
    const bool enough = std::all_of(fits.begin(), fits.end(), [](const features::JudgedFit& fit) { return fit.known() >= fit.required; });
    for (const features::JudgedFit& fit : fits)
        console.found({fit.name, fit.known() >= fit.required ? CheckOutcome::passed : CheckOutcome::failed, "fit",
                       fit.known() >= fit.required ? "has the play that is asked for" : "has less play than is asked for",
                       arguments.paths.front()});
    Json answer{{"status", interrupted() ? "undecided" : enough ? "ok" : "violated"}, {"files", written.files}};
    answer.update(features::fit_plan_json(*before, *plan, fits));
    std::string text = features::fit_plan_text(*before, *plan, fits);
    for (const std::string& file : written.files) text += file + "\n";
    console.result(answer, text);
    return interrupted() ? exit_undecided : enough ? exit_done : exit_violated;
}

}  // namespace

Command add_fit(CommandLine& program, const CommonOptions& common) {
    CommandLine app =
        program.command("fit", "Opens bores and pins of meshes to the play that a process needs, and proves the play that results");
    auto options = std::make_shared<FitArguments>();
    app.option("FILE", options->paths, "Meshes in place, folders of meshes, STEP files").required();
    app.option("--to", options->to, "Folder for the parts, those without a change too: STL if all are STL, else 3MF").required();
    app.option("--process", options->process, "What fits need per side: this process, or your own NAME.process.json")
        .words_or(tolerances::known_process_names(), "NAME");
    app.option("--clearance", options->clearance, "What fits need per side, with its unit: 0.3mm (in place of the process')");
    app.option("--change", options->change, "What is changed (default: holes)").one_of({"holes", "pins", "both"});
    app.flag("--close", options->close, "Close looser fits to the same play, too (default: they stay)");
    app.option("--unit", options->unit, "Unit of meshes that state none: mm, um, cm, m, in, ft, or auto: as their size suggests");
    app.flag("--split", options->split, "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2");
    add_step_options(app, options->step);
    app.closing_words(
        "Example:  fettle fit base.stl lid.stl pin.stl --unit mm --process fdm --to fitted\n"
        "Corners of a bore move away from its axis; everything else stays bit for bit. What would bend a face, turn a triangle over or "
        "cut\n"
        "through a wall is refused. The play is proven of the files as written, as assembled and over a whole turn about the pin.");
    return {app, [options, &common](Console& console) { return run_fit(*options, common, console); }};
}

}  // namespace fettle::design::cli
