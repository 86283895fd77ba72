// SPDX-License-Identifier: MIT
#include "design/cli/export_mechanism.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/answers/output_folder.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/problem/design_problem.hpp"
#include "design/problem/moved_scene.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/reading/scene_text.hpp"
#include "design/urdf/robot_notes_json.hpp"
#include "design/urdf/urdf_writer.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A scene and its model: of a design at the values of its parameters, in the scenario that is asked for.
struct SceneAndModel {
    core::scene::Scene scene;
    core::model::Model model;
};

Result<SceneAndModel> scene_and_model(const std::string& path, const CommonOptions& common) {
    SceneAndModel out;
    core::setup::BuildOptions build;
    build.check_start = false;
    if (file_kind(path) == reading::FileKind::design) {
        const auto file = reading::read_design(path, {common.mesh_dirs, programs_of(common)});
        if (!file) return file.errors();
        const auto problem = problem::DesignProblem::create(file->design);
        if (!problem) return problem.errors();
        const Result<int> scenario = reading::scenario_of(file->design, common.scenario, path);
        if (!scenario) return scenario.errors();
        const description::Design one = description::design_of_scenario(problem->design(), *scenario);
        auto moved = problem::move_scene(one, description::values_of(one.parameters), problem::SceneDerivative::not_wanted);
        if (!moved) return moved.errors();
        out.scene = std::move(moved->scene);
    } else {
        if (const Errors errors = reading::not_wanted(path, file_kind(path), "scene"); !errors.empty()) return errors;
        auto scene = core::scene_files::read_scene(path, reading::scene_read_options(common.mesh_dirs, programs_of(common)));
        if (!scene) return scene.errors();
        out.scene = std::move(*scene);
    }
    auto model = core::setup::build_model(out.scene, build);
    if (!model) return model.errors();
    out.model = std::move(*model);
    return out;
}

}  // namespace

int leave_files(const std::vector<std::pair<fs::path, std::string>>& contents, const std::string& format,
                const std::vector<std::string>& warnings, const CommonOptions& common, Console& console) {
    tell_warnings(console, warnings);
    Json files = Json::array();
    std::string text;
    core::files::FilesTogether together;
    std::vector<NamedFile> written;
    Errors errors;
    for (const auto& [path, bytes] : contents) {
        written.push_back({"--to", path.string(), true});
        if (errors.empty()) errors = together.add(path, bytes);
        files.push_back({{"file", path.string()}, {"format", format}, {"bytes", bytes.size()}, {"hash", core::files::hash_of(bytes)}});
        text += formatted("%s  %zu bytes\n", path.string().c_str(), bytes.size());
    }
    if (errors.empty()) errors = replaced_inputs(written, common.given);
    if (errors.empty()) errors = together.take_names();
    if (!errors.empty()) return console.input_errors(errors);
    console.result({{"status", "ok"}, {"files", std::move(files)}, {"warnings", warnings}}, text);
    return exit_done;
}

int export_robot(const std::string& path, const std::string& to, const CommonOptions& common, Console& console) {
    const Result<SceneAndModel> from = scene_and_model(path, common);
    if (!from) return console.input_errors(from.errors());
    const Result<urdf::RobotNotes> notes = urdf::read_robot_notes(from->scene.path);
    if (!notes) return console.input_errors(notes.errors());
    const auto robot = urdf::robot_of_scene(from->scene, from->model, *notes, fs::path(to).stem().string());
    if (!robot) return console.input_errors(robot.errors());
    std::vector<std::pair<fs::path, std::string>> files;
    for (const auto& [name, bytes] : robot->files) files.emplace_back(fs::path(to).parent_path() / name, bytes);
    return leave_files(files, "urdf", robot->warnings, common, console);
}

int export_scene(const std::string& path, const std::string& to, const CommonOptions& common, Console& console) {
    if (file_kind(path) != reading::FileKind::design)
        return console.input_errors({{ErrorCode::unsupported, path, "is not a design; a design is written as a scene"}});
    const auto file = reading::read_design(path, {common.mesh_dirs, programs_of(common)});
    if (!file) return console.input_errors(file.errors());
    const Result<int> scenario = reading::scenario_of(file->design, common.scenario, path);
    if (!scenario) return console.input_errors(scenario.errors());
    if (const Errors errors = answers::try_output_file(to); !errors.empty()) return console.input_errors(errors);
    const auto text = reading::scene_text(*file, to, reading::scene_read_options(common.mesh_dirs, programs_of(common)), *scenario);
    if (!text) return console.input_errors(text.errors());
    return leave_files({{to, *text}}, "scene", file->warnings, common, console);
}

}  // namespace fettle::design::cli
