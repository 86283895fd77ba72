// SPDX-License-Identifier: MIT
/// fettle import FILE... --to X.scene.json: a robot description (design/urdf/urdf_scene.hpp), or meshes and the solids of STEP files, with
/// the joints that their fits propose (design/features/assembly_scene.hpp), as a scene.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/model/start_check.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/command.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/cli/step_options.hpp"
#include "design/features/assembly_scene.hpp"
#include "design/urdf/urdf_parser.hpp"
#include "design/urdf/urdf_scene.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ImportArguments {
    std::vector<std::string> paths;
    std::string to, unit, ground, density;
    bool floating = false, ignore_mimic_limits = false, split = false, joints = false, ignore_overlaps = false;
    reading::StepWishes step;
};

// Bodies that pass through each other as assembled, which the written scene cannot be simulated with: they are told, or, on request, listed
// in its `ignore`.
Errors settle_overlaps(const ImportArguments& arguments, const CommonOptions& common, Console& console, Json& warnings) {
    const auto tell = [&](const std::string& line) {
        tell_warnings(console, {line});
        warnings.push_back(line);
        return Errors{};
    };
    const auto loaded = load_model(arguments.to, common, false);
    if (!loaded) return tell("the scene cannot be simulated as it is: " + loaded.errors().front().message);
    const core::model::Model& model = loaded->model;
    Json pairs = Json::array();
    for (const auto& [a, b] : core::model::report_start(model).overlapping)
        pairs.push_back(model.bodies[a].name + ":" + model.bodies[b].name);
    if (pairs.empty()) return {};
    const std::string count = core::base::counted(pairs.size(), "pair") + " of bodies";
    if (!arguments.ignore_overlaps)
        return tell("as assembled " + count +
                    " pass through each other; where they are not meant to meet, add to the scene (or by --ignore-overlaps): \"ignore\": " +
                    core::files::dumped(pairs));
    const Result<std::string> text = core::files::read_file(arguments.to);
    if (!text) return text.errors();
    Json scene = Json::parse(*text);
    scene["ignore"] = pairs;
    if (Errors errors = core::files::write_file_atomically(arguments.to, core::files::dumped(scene, 2) + "\n"); !errors.empty())
        return errors;
    return tell(count + " that pass through each other as assembled are ignored: nothing is judged between " + core::files::dumped(pairs));
}

// Meshes, a STEP file's solids: bodies that name them; joints that their fits propose.
int import_assembly(const ImportArguments& arguments, const CommonOptions& common, Console& console) {
    if (arguments.floating || arguments.ignore_mimic_limits)
        return console.input_errors(
            {{ErrorCode::inconsistent, arguments.floating ? "--floating" : "--ignore-mimic-limits", "is for URDF"}});
    features::AssemblyQuestion question;
    question.to = arguments.to;
    question.step = arguments.step;
    question.joints = arguments.joints;
    question.ground = arguments.ground;
    question.mesh_dirs = common.mesh_dirs;
    question.should_stop = interrupted;
    question.on_progress = [&](const char* what, int done, int of) { console.progress(what, done, of); };
    if (!arguments.joints && !(arguments.ground.empty() && arguments.density.empty()))
        return console.input_errors({{ErrorCode::inconsistent, arguments.ground.empty() ? "--density" : "--ground", "is for --joints"}});
    if (!arguments.density.empty()) {
        const Result<double> density = core::base::parse_quantity(arguments.density, core::base::Dimension::density, "--density");
        if (!density) return console.input_errors(density.errors());
        if (!(*density > 0)) return console.input_errors({{ErrorCode::out_of_range, "--density", "this is greater than 0"}});
        question.density = *density;
    }
    const Result<clearance::MeshParts> parts =
        clearance::load_meshes(arguments.paths, arguments.unit, input_options(common, false), arguments.split, arguments.step);
    if (!parts) return console.input_errors(parts.errors());
    tell_warnings(console, parts->warnings);
    const Result<features::AssemblyScene> scene = features::assembly_scene(*parts, question);
    console.end_progress();
    if (!scene) return console.input_errors(scene.errors());
    Json answer{{"status", scene->interrupted ? "interrupted" : "ok"}, {"files", Json::array()}, {"warnings", parts->warnings}};
    std::string told = scene->text.empty() ? "interrupted before the fits were known: nothing is written\n" : arguments.to + "\n";
    if (!scene->text.empty()) {
        Errors errors = replaced_inputs({{"--to", arguments.to, true}}, common.given);
        if (errors.empty()) errors = core::files::write_file_atomically(arguments.to, scene->text);
        if (!errors.empty()) return console.input_errors(errors);
        answer["files"].push_back(arguments.to);
    }
    if (arguments.joints && !scene->text.empty()) {
        answer.update(features::assembly_json(*scene, parts->model));
        told += features::assembly_text(*scene, parts->model);
        if (scene->interrupted) told += "interrupted: limits that were not known by then are missing\n";
    }
    if ((arguments.joints || arguments.ignore_overlaps) && !scene->text.empty()) {
        if (const Errors faults = settle_overlaps(arguments, common, console, answer["warnings"]); !faults.empty())
            return console.input_errors(faults);
    }
    console.result(answer, told);
    return scene->interrupted ? exit_undecided : exit_done;
}

// That a robot description has no use for.
std::string option_of_meshes(const ImportArguments& arguments) {
    if (!arguments.step.facets.empty()) return "--facets";
    if (!arguments.step.surface_tolerance.empty()) return "--surface-tolerance";
    if (!arguments.unit.empty()) return "--unit";
    if (!arguments.ground.empty()) return "--ground";
    if (!arguments.density.empty()) return "--density";
    return arguments.split ? "--split" : arguments.joints ? "--joints" : "";
}

int run_import(const ImportArguments& arguments, const CommonOptions& common, Console& console) {
    const std::string ending = ".scene.json";
    if (!arguments.to.ends_with(ending))
        return console.input_errors({{ErrorCode::unsupported, "--to", "a scene is X" + ending + ", found " + arguments.to}});
    if (arguments.paths.size() > 1 || clearance::are_meshes(arguments.paths)) return import_assembly(arguments, common, console);
    if (const std::string option = option_of_meshes(arguments); !option.empty())
        return console.input_errors({{ErrorCode::inconsistent, option, "is for meshes and STEP files"}});
    const std::string& path = arguments.paths.front();
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return console.input_errors(text.errors());
    if (const std::size_t first = text->find_first_not_of(" \t\r\n"); first != std::string::npos && (*text)[first] == '{')
        return console.input_errors({{ErrorCode::unsupported, path,
                                      "this is JSON; robots (URDF), which are XML, are imported. Scenes and designs are taken as they are: "
                                      "see fettle simulate"}});
    auto robot = urdf::parse_urdf(*text, path);
    if (!robot) return console.input_errors(robot.errors());
    if (arguments.ignore_mimic_limits)
        for (urdf::Joint& joint : robot->joints)
            if (!joint.mimics.empty()) joint.lower = joint.upper = std::nullopt;
    urdf::ImportOptions options;
    options.meshes = {fs::path(path).parent_path().string(), common.mesh_dirs};
    const std::string name = fs::path(arguments.to).filename().string();
    options.stem = name.substr(0, name.size() - ending.size());
    options.floating = arguments.floating;
    const auto scene = urdf::scene_of_robot(*robot, options);
    if (!scene) return console.input_errors(scene.errors());
    tell_warnings(console, scene->warnings);
    Json files = Json::array();
    std::string told;
    core::files::FilesTogether together;
    std::vector<NamedFile> written;
    Errors errors;
    for (const auto& [file, contents] : scene->files) {
        const fs::path path = fs::path(arguments.to).parent_path() / file;
        written.push_back({"--to", path.string(), true});
        if (errors.empty()) errors = together.add(path, contents);
        files.push_back(path.string());
        told += path.string() + "\n";
    }
    if (errors.empty()) errors = replaced_inputs(written, common.given);
    if (errors.empty()) errors = together.take_names();
    if (!errors.empty()) return console.input_errors(errors);
    Json warnings = scene->warnings;
    if (const Errors faults = settle_overlaps(arguments, common, console, warnings); !faults.empty()) return console.input_errors(faults);
    console.result({{"status", "ok"}, {"files", std::move(files)}, {"warnings", warnings}}, told);
    return exit_done;
}

}  // namespace

Command add_import(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command(
        "import",
        "Converts a robot description (URDF), meshes or STEP files into a scene: bodies, and the joints that they have or that their "
        "fits propose");
    auto options = std::make_shared<ImportArguments>();
    app.option("FILE", options->paths, "ROBOT.urdf; or meshes in place, folders of meshes, STEP files").required();
    app.option("--to", options->to, "Scene to write, X.scene.json; meshes of a robot go to X.meshes beside it").required();
    app.option("--unit", options->unit, "Unit of meshes that state none: mm, um, cm, m, in, ft, or auto: as their size suggests");
    app.flag("--split", options->split, "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2");
    app.flag("--joints", options->joints,
             "Propose joints from what fits in what (see fettle features), with the limits that the parts' shapes set");
    app.option("--ground", options->ground, "With --joints: the body that does not move (default: the largest)");
    app.option("--density", options->density, "With --joints: of bodies that move, with its unit (default: 1.24 g/cm^3)");
    app.flag("--ignore-overlaps", options->ignore_overlaps,
             "List pairs of bodies that pass through each other as assembled in the scene's `ignore` (default: tell them)");
    app.flag("--floating", options->floating, "The root link is free (default: it does not move)");
    app.flag("--ignore-mimic-limits", options->ignore_mimic_limits,
             "Joints that mimic another have no limits of their own, as in ROS (default: theirs narrow what they follow)");
    add_step_options(app, options->step);
    app.closing_words(
        "Examples:  fettle import arm.urdf --to arm.scene.json && fettle simulate arm.scene.json --out out\n"
        "           fettle import hinge.step --joints --to hinge.scene.json && fettle clearance hinge.scene.json --minimum 0.2mm --ranges");
    return {app, [options, &common](Console& console) { return run_import(*options, common, console); }};
}

}  // namespace fettle::design::cli
