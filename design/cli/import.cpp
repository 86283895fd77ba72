// SPDX-License-Identifier: MIT
/// fettle import FILE --to X.scene.json: a robot description (design/urdf/urdf_scene.hpp) or the solids of a STEP file as a scene.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/unique_names.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/model/start_check.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/cli/session.hpp"
#include "design/cli/step_options.hpp"
#include "design/urdf/urdf_parser.hpp"
#include "design/urdf/urdf_scene.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ImportArguments {
    std::string path, to;
    bool floating = false, ignore_mimic_limits = false;
    reading::StepWishes step;
};

// What it takes to simulate the scene as it is assembled, where bodies pass through each other there; empty: they do not.
std::string ignore_line(const std::string& path, const CommonOptions& common) {
    const auto loaded = load_model(path, common, false);
    if (!loaded) return "the scene cannot be simulated as it is: " + loaded.errors().front().message;
    const core::model::Model& model = loaded->model;
    Json pairs = Json::array();
    for (const auto& [a, b] : core::model::report_start(model).overlapping)
        pairs.push_back(model.bodies[a].name + ":" + model.bodies[b].name);
    if (pairs.empty()) return {};
    return "as assembled " + core::base::counted(pairs.size(), "pair") +
           " of bodies pass through each other; where they are not meant to meet, add to the scene: \"ignore\": " +
           core::files::dumped(pairs);
}

// Each solid as a body that names it, and does not move.
Result<std::string> scene_of_step(const ImportArguments& arguments) {
    core::mesh_files::MeshReadOptions options{1, true, interrupted};
    if (Errors errors = reading::take_step_wishes(arguments.step, options); !errors.empty()) return errors;
    const auto items = core::mesh_files::read_mesh_parts(arguments.path, options);
    if (!items) return items.errors();
    std::error_code code;
    const fs::path folder = fs::absolute(arguments.to, code).parent_path(), file = fs::absolute(arguments.path, code);
    const fs::path relative = fs::relative(file, folder, code);
    Json bodies = Json::array();
    core::files::UniqueNames names(" ");
    for (const core::geometry::Mesh& item : *items) {
        Json body{{"name", clearance::body_name(item.name, names)},
                  {"mesh", (code || relative.empty() ? file : relative).generic_string()},
                  {"mesh_item", item.name},
                  {"type", "static"}};
        if (!arguments.step.facets.empty()) body["mesh_facets"] = arguments.step.facets;
        if (!arguments.step.surface_tolerance.empty()) body["surface_tolerance"] = arguments.step.surface_tolerance;
        bodies.push_back(std::move(body));
    }
    const Json scene{{"fettle_scene", 1},
                     {"units", "mm"},
                     {"# bodies", "Where the assembly has them. What moves wants a `density` in place of its `type`, and joints."},
                     {"bodies", std::move(bodies)}};
    return core::files::dumped(scene, 2) + "\n";
}

int import_step(const ImportArguments& arguments, const CommonOptions& common, Console& console) {
    if (arguments.floating || arguments.ignore_mimic_limits)
        return console.input_errors(
            {{ErrorCode::inconsistent, arguments.floating ? "--floating" : "--ignore-mimic-limits", "is for URDF"}});
    const Result<std::string> scene = scene_of_step(arguments);
    if (!scene) return console.input_errors(scene.errors());
    Errors errors = replaced_inputs({{"--to", arguments.to, true}}, common.given);
    if (errors.empty()) errors = core::files::write_file_atomically(arguments.to, *scene);
    if (!errors.empty()) return console.input_errors(errors);
    console.result({{"status", "ok"}, {"files", {arguments.to}}, {"warnings", Json::array()}}, arguments.to + "\n");
    return exit_done;
}

int run_import(const ImportArguments& arguments, const CommonOptions& common, Console& console) {
    const std::string ending = ".scene.json";
    if (!arguments.to.ends_with(ending))
        return console.input_errors({{ErrorCode::unsupported, "--to", "a scene is X" + ending + ", found " + arguments.to}});
    if (core::mesh_files::is_step(arguments.path)) return import_step(arguments, common, console);
    if (!arguments.step.facets.empty() || !arguments.step.surface_tolerance.empty())
        return console.input_errors(
            {{ErrorCode::inconsistent, arguments.step.facets.empty() ? "--surface-tolerance" : "--facets", "is for STEP files"}});
    const Result<std::string> text = core::files::read_file(arguments.path);
    if (!text) return console.input_errors(text.errors());
    if (const std::size_t first = text->find_first_not_of(" \t\r\n"); first != std::string::npos && (*text)[first] == '{')
        return console.input_errors({{ErrorCode::unsupported, arguments.path,
                                      "this is JSON; robots (URDF), which are XML, are imported. Scenes and designs are taken as they are: "
                                      "see fettle simulate"}});
    auto robot = urdf::parse_urdf(*text, arguments.path);
    if (!robot) return console.input_errors(robot.errors());
    if (arguments.ignore_mimic_limits)
        for (urdf::Joint& joint : robot->joints)
            if (!joint.mimics.empty()) joint.lower = joint.upper = std::nullopt;
    urdf::ImportOptions options;
    options.meshes = {fs::path(arguments.path).parent_path().string(), common.mesh_dirs};
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
    std::vector<std::string> warnings = scene->warnings;
    if (std::string line = ignore_line(arguments.to, common); !line.empty()) {
        tell_warnings(console, {line});
        warnings.push_back(std::move(line));
    }
    console.result({{"status", "ok"}, {"files", std::move(files)}, {"warnings", warnings}}, told);
    return exit_done;
}

}  // namespace

Command add_import(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command(
        "import", "Converts a robot description (URDF) into a scene: links, joints, limits, meshes; or a STEP file: a body for each solid");
    auto options = std::make_shared<ImportArguments>();
    app.option("FILE", options->path, "ROBOT.urdf, or a STEP file (.step, .stp)").required();
    app.option("--to", options->to, "Scene to write, X.scene.json; meshes go to X.meshes beside it").required();
    app.flag("--floating", options->floating, "The root link is free (default: it does not move)");
    app.flag("--ignore-mimic-limits", options->ignore_mimic_limits,
             "Joints that mimic another have no limits of their own, as in ROS (default: theirs narrow what they follow)");
    add_step_options(app, options->step);
    app.closing_words("Example:  fettle import arm.urdf --to arm.scene.json && fettle simulate arm.scene.json --out out");
    return {app, [options, &common](Console& console) { return run_import(*options, common, console); }};
}

}  // namespace fettle::design::cli
