// SPDX-License-Identifier: MIT
#include "design/reading/model_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/base/stop.hpp"
#include "core/files/input_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_keys.hpp"
#include "core/files/nearest_word.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/model/check_scene.hpp"
#include "core/part_files/part_file.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"

namespace fettle::design::reading {

namespace {

std::string read_here() {
    return "scenes, designs and trajectories are JSON (.json); meshes, which a scene names, are " + core::mesh_files::mesh_extensions();
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

/// A file that is not JSON by its name and by its first character: there is no use in telling where its syntax is wrong.
bool is_foreign(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".json" || extension.empty()) return false;
    Result<core::files::InputFile> file = core::files::InputFile::open(path);
    if (!file) return false;
    const std::string_view text = file->next();
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] != '{';
}

Errors foreign_error(const std::string& path) {
    const std::string extension = extension_of(path);
    const std::string what = core::mesh_files::has_mesh_extension(path)
                                 ? "is a mesh, not a scene or design; write a scene that names it, or ask fettle validate"
                                 : "a file of kind `" + extension + "` is not read";
    return {{ErrorCode::unsupported, path, what + "; " + read_here()}};
}

/// The meshes of a design are read as its scene says; asked to be strict, the scene is looked at once more.
/// @param made  Its parts.
Errors strict_faults(const std::string& scene_path, const InputOptions& options, const std::shared_ptr<std::vector<MadePart>>& made) {
    core::scene::ReadOptions read_options = scene_read_options(options.mesh_dirs, options.programs, made);
    read_options.strict_meshes = true;
    const Result<core::scene::Scene> scene = core::scene_files::read_scene(scene_path, read_options);
    if (!scene) return scene.errors();
    const core::model::SceneCheck check = core::model::check_scene(*scene, true);
    return check.errors.empty() ? as_errors(check.warnings, scene_path) : check.errors;
}

Result<LoadedModel> load_design(const std::string& path, InputOptions options) {
    const std::string wanted = std::exchange(options.scenario, {});
    Result<DesignFile> file = open_design(path, options);
    if (!file) return file.errors();
    const VectorX values = description::values_of(file->design.parameters);
    return loaded_design(std::move(file).value(), values, wanted);
}

Result<LoadedModel> load_scene(const std::string& path, const InputOptions& options) {
    if (!options.scenario.empty()) return Error{ErrorCode::unsupported, "--scenario", path + " is a scene; designs have scenarios"};
    core::scene::ReadOptions read_options = scene_read_options(options.mesh_dirs, options.programs);
    read_options.strict_meshes = options.strict;
    read_options.should_stop = options.should_stop;
    Result<core::scene::Scene> scene = read_scene_or_part(path, read_options);
    if (!scene) return scene.errors();
    LoadedModel loaded;
    loaded.scene_path = path;
    loaded.warnings = std::move(scene->warnings);
    core::setup::BuildOptions build;
    build.check_start = options.check_start;
    const core::base::StopScope scope(options.should_stop);
    Result<core::model::Model> model = core::setup::build_model(*std::move(scene), build);
    if (!model) return model.errors();
    loaded.model = std::move(model).value();
    return loaded;
}

/// Faults of a part file that is taken as a scene of one body: at their places in the file, which the user knows of nothing else.
Errors faults_of_part(Errors errors, const std::string& path) {
    const std::string file = std::filesystem::path(path).filename().string();
    for (Error& error : errors) {
        if (!error.where.starts_with(path + "#")) continue;
        // The message begins with its place if it is from the part's own reader: "/folder/a.part.json#/solid: ...".
        const std::size_t end = error.message.find(": "), named = error.message.rfind(file, end);
        const bool has_place = end != std::string::npos && named != std::string::npos && named + file.size() < end &&
                               (named == 0 || error.message[named - 1] == '/');
        error.where = path + (has_place ? error.message.substr(named + file.size(), end - named - file.size()) : "");
        if (has_place) error.message.erase(0, end + 2);
    }
    return errors;
}

}  // namespace

FileKind file_kind(const std::string& path) {
    using namespace std::string_view_literals;
    static constexpr std::array keys{"fettle_scene"sv, "fettle_design"sv, "fettle_trajectory"sv, "fettle_certificate"sv,
                                     "fettle_range_certificate"sv};
    static constexpr std::array kinds{FileKind::scene, FileKind::design, FileKind::trajectory, FileKind::certificate,
                                      FileKind::certificate};
    if (core::mesh_files::has_mesh_extension(path)) return FileKind::mesh;
    const auto key = std::find(keys.begin(), keys.end(), core::files::top_level_key(path, keys));
    return key == keys.end() ? FileKind::scene : kinds[key - keys.begin()];
}

Result<core::scene::Scene> read_scene_or_part(const std::string& path, const core::scene::ReadOptions& options) {
    if (!path.ends_with(core::part_files::part_file_ending)) return core::scene_files::read_scene(path, options);
    const std::string file = std::filesystem::path(path).filename().string();
    const std::string name = file.substr(0, file.size() - core::part_files::part_file_ending.size());
    const nlohmann::json body{{"name", name}, {"type", "static"}, {"shape", {{"part", file}}}};
    const nlohmann::json scene{{"fettle_scene", 1}, {"units", "mm"}, {"bodies", {body}}};
    Result<core::scene::Scene> read = core::scene_files::parse_scene(core::files::dumped(scene), path, options);
    if (!read) return faults_of_part(read.errors(), path);
    return read;
}

Errors not_wanted(const std::string& path, FileKind kind, const std::string& wanted) {
    if (kind != FileKind::trajectory && kind != FileKind::certificate) return {};
    const bool is_trajectory = kind == FileKind::trajectory;
    return {{ErrorCode::unsupported, path,
             std::string("is a ") + (is_trajectory ? "trajectory" : "certificate") + ", not a " + wanted + "; " +
                 (is_trajectory ? "clearance" : "validate") + ", draw and export to other formats take it"}};
}

Result<LoadedModel> load_model(const std::string& path, const InputOptions& options) { return load_model(path, file_kind(path), options); }

Result<LoadedModel> load_model(const std::string& path, FileKind kind, const InputOptions& options) {
    if (is_foreign(path)) return foreign_error(path);
    if (Errors errors = not_wanted(path, kind, "scene"); !errors.empty()) return errors;
    Result<LoadedModel> loaded = kind == FileKind::design ? load_design(path, options) : load_scene(path, options);
    if (!loaded) return loaded.errors();
    const auto& more = loaded->model.warnings;
    loaded->warnings.insert(loaded->warnings.end(), more.begin(), more.end());
    if (options.strict && !loaded->warnings.empty()) return as_errors(loaded->warnings, path);
    return loaded;
}

Result<int> scenario_of(const description::Design& design, const std::string& name, const std::string& path) {
    if (name.empty()) return 0;
    std::vector<std::string_view> names;
    for (const description::Scenario& scenario : design.scenarios) names.emplace_back(scenario.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    return Error{ErrorCode::unknown_key, path,
                 names.empty() ? "the design has no `scenarios`, so none is called \"" + name + "\""
                               : "no scenario is called \"" + name + "\"; " + core::files::did_you_mean(name, names)};
}

Result<LoadedModel> loaded_design(DesignFile file, const VectorX& values, const std::string& wanted) {
    const Result<int> scenario = scenario_of(file.design, wanted, file.path);
    if (!scenario) return scenario.errors();
    LoadedModel loaded;
    loaded.kind = FileKind::design;
    loaded.scene_path = file.scene_path;
    loaded.warnings = file.warnings;
    loaded.choices = file.choices;
    loaded.conditions = file.conditions;
    Result<problem::DesignProblem> problem = problem::DesignProblem::create(std::move(file.design));
    if (!problem) return problem.errors();
    Result<core::model::Model> model = problem->model_at(values, *scenario);
    if (!model) return model.errors();
    loaded.steps = problem->steps(*scenario);
    loaded.model = std::move(model).value();
    loaded.problem = std::make_shared<const problem::DesignProblem>(std::move(problem).value());
    loaded.model.warnings = loaded.problem->warnings();  // a design's own models take its meshes as sound
    return loaded;
}

Result<DesignFile> open_design(const std::string& path, const InputOptions& options) {
    if (is_foreign(path)) return foreign_error(path);
    if (!options.scenario.empty())
        return Error{ErrorCode::unsupported, "--scenario",
                     "this is about all scenarios of a design; simulate, clearance, draw and export take one of them"};
    const auto made = std::make_shared<std::vector<MadePart>>();
    DesignReadOptions read{.mesh_dirs = options.mesh_dirs, .programs = options.programs, .made = made};
    read.as_made = options.as_made;
    read.process = options.process;
    Result<DesignFile> file = read_design(path, read);
    if (!file) {
        Errors errors = not_wanted(path, file_kind(path), "design");
        return errors.empty() ? file.errors() : errors;
    }
    if (!options.strict) return file;
    Errors errors = strict_faults(file->scene_path, options, made);
    if (!errors.empty()) return errors;
    return file;
}

Errors as_errors(const std::vector<std::string>& warnings, const std::string& file) {
    Errors errors;
    for (const std::string& warning : warnings) errors.push_back({ErrorCode::inconsistent, file, warning});
    return errors;
}

}  // namespace fettle::design::reading
