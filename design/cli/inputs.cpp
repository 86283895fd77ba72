// SPDX-License-Identifier: MIT
#include "fettle/design/cli/inputs.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/stop.hpp"
#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/files/json_keys.hpp"
#include "fettle/core/mesh_files/mesh_reader.hpp"
#include "fettle/core/model/build_model.hpp"
#include "fettle/core/model/check_scene.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/program_memory.hpp"
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/reading/scene_shapes.hpp"

namespace fettle::design::cli {

namespace {

std::string read_here() {
    return "scenes, designs and trajectories are JSON (.json); meshes, which a scene names, are " + core::mesh_files::mesh_extensions();
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

/// A file that is no JSON by its name and by its first character: there is no use in telling where its syntax is wrong.
bool is_foreign(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".json" || extension.empty()) return false;
    std::ifstream file(path);
    char first = 0;
    return static_cast<bool>(file >> first) && first != '{';
}

Errors foreign_error(const std::string& path) {
    const std::string extension = extension_of(path);
    const std::string what = core::mesh_files::has_mesh_extension(path)
                                 ? "is a mesh, not a scene or design; write a scene that names it, or ask fettle validate"
                                 : "a file of kind `" + extension + "` is not read";
    return {{ErrorCode::unsupported, path, what + "; " + read_here()}};
}

/// Of a design the meshes are read as its scene says; asked to be strict, the scene is looked at once more.
Errors strict_faults(const std::string& scene_path, const CommonOptions& common) {
    core::scene::ReadOptions options = reading::scene_read_options(common.mesh_dirs, programs_of(common));
    options.strict_meshes = true;
    const Result<core::scene::Scene> scene = core::scene::read_scene(scene_path, options);
    if (!scene) return scene.errors();
    const core::model::SceneCheck check = core::model::check_scene(*scene, true);
    return check.errors.empty() ? as_errors(check.warnings, scene_path) : check.errors;
}

Result<LoadedModel> load_design(const std::string& path, const CommonOptions& common) {
    Result<reading::DesignFile> file = open_design(path, common);
    if (!file) return file.errors();
    LoadedModel loaded;
    loaded.kind = FileKind::design;
    loaded.scene_path = file->scene_path;
    loaded.steps = file->design.steps;
    loaded.warnings = file->warnings;
    const VectorX values = description::values_of(file->design.parameters);
    Result<problem::DesignProblem> problem = problem::DesignProblem::create(std::move(file->design));
    if (!problem) return problem.errors();
    Result<core::model::Model> model = problem->model_at(values);
    if (!model) return model.errors();
    loaded.model = std::move(model).value();
    loaded.problem = std::make_shared<const problem::DesignProblem>(std::move(problem).value());
    loaded.model.warnings = loaded.problem->warnings();  // a design's own models take its meshes as sound
    return loaded;
}

Result<LoadedModel> load_scene(const std::string& path, const CommonOptions& common, bool check_start) {
    core::scene::ReadOptions read_options = reading::scene_read_options(common.mesh_dirs, programs_of(common));
    read_options.strict_meshes = common.strict;
    read_options.should_stop = interrupted;
    Result<core::scene::Scene> scene = core::scene::read_scene(path, read_options);
    if (!scene) return scene.errors();
    LoadedModel loaded;
    loaded.scene_path = path;
    loaded.warnings = std::move(scene->warnings);
    core::model::BuildOptions options;
    options.check_start = check_start;
    const core::base::StopScope scope(interrupted);
    Result<core::model::Model> model = core::model::build_model(*std::move(scene), options);
    if (!model) return model.errors();
    loaded.model = std::move(model).value();
    return loaded;
}

// While the file is read other threads are made, and memory for what it becomes.
void begin_to_read(const std::string& path) {
    constexpr std::uintmax_t growth = 64;                      // of a body's text to the body and a motion of some fifty steps
    constexpr std::uintmax_t least = 1 << 20, most = 8 << 20;  // bytes: what pays, and what is cleared before it is wanted
    std::error_code unreadable;
    const std::uintmax_t size = std::filesystem::file_size(path, unreadable);
    const std::uintmax_t bytes = unreadable ? 0 : std::min(most / growth, size) * growth;
    core::base::wake_threads(bytes >= least && core::base::thread_count() > 1 ? memory_ahead(bytes) : std::function<void()>());
}

}  // namespace

reading::Programs programs_of(const CommonOptions& common) {
    return common.allow_programs ? reading::Programs::allowed : reading::Programs::refused;
}

FileKind file_kind(const std::string& path) {
    if (core::mesh_files::has_mesh_extension(path)) return FileKind::mesh;
    if (core::records::is_trajectory_file(path)) return FileKind::trajectory;
    if (core::certificate::is_certificate_file(path)) return FileKind::certificate;
    return core::files::has_top_level_key(path, "fettle_design") ? FileKind::design : FileKind::scene;
}

Errors or_other_kind(const std::string& path, const std::string& wanted, const Errors& errors) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return errors;
    const FileKind kind = file_kind(path);
    if (kind == FileKind::trajectory)
        return {
            {ErrorCode::unsupported, path, "is a trajectory, not a " + wanted + "; clearance, draw and export to other formats take it"}};
    if (kind == FileKind::certificate)
        return {
            {ErrorCode::unsupported, path, "is a certificate, not a " + wanted + "; validate, draw and export to other formats take it"}};
    return errors;
}

Result<LoadedModel> load_model(const std::string& path, const CommonOptions& common, bool check_start) {
    if (is_foreign(path)) return foreign_error(path);
    begin_to_read(path);
    const bool design = core::files::has_top_level_key(path, "fettle_design");
    Result<LoadedModel> loaded = design ? load_design(path, common) : load_scene(path, common, check_start);
    if (!loaded) return design ? loaded.errors() : or_other_kind(path, "scene", loaded.errors());
    const auto& more = loaded->model.warnings;
    loaded->warnings.insert(loaded->warnings.end(), more.begin(), more.end());
    if (common.strict && !loaded->warnings.empty()) return as_errors(loaded->warnings, path);
    return loaded;
}

Result<reading::DesignFile> open_design(const std::string& path, const CommonOptions& common) {
    if (is_foreign(path)) return foreign_error(path);
    Result<reading::DesignFile> file = reading::read_design(path, {common.mesh_dirs, programs_of(common)});
    if (!file) return or_other_kind(path, "design", file.errors());
    if (!common.strict) return file;
    Errors errors = strict_faults(file->scene_path, common);
    if (!errors.empty()) return errors;
    return file;
}

std::string certificate_trajectory(const std::string& certificate) {
    std::string stem = certificate;
    for (const std::string ending : {".json", ".certificate"}) {
        if (stem.size() > ending.size() && stem.compare(stem.size() - ending.size(), ending.size(), ending) == 0)
            stem.resize(stem.size() - ending.size());
    }
    return stem + ".trajectory.json";
}

std::string name_from_certificate(const std::string& certificate, const std::string& file) {
    const auto whole = [](const std::filesystem::path& path) { return std::filesystem::absolute(path).lexically_normal(); };
    const std::filesystem::path full = whole(file), near = full.lexically_relative(whole(certificate).parent_path());
    const bool below = !near.empty() && *near.begin() != "..";
    return below ? near.string() : full.string();
}

std::filesystem::path file_of_certificate(const std::string& certificate, const std::string& name) {
    return std::filesystem::path(certificate).parent_path() / name;  // a whole path stays as it is
}

void tell_warnings(Console& console, const std::vector<std::string>& warnings, const std::string& file) {
    for (const std::string& warning : warnings) {
        console.narrate("warning: " + warning);
        console.found({file.empty() ? "the input" : file, CheckOutcome::remarked, "warning", warning, file});
    }
}

Errors as_errors(const std::vector<std::string>& warnings, const std::string& file) {
    Errors errors;
    for (const std::string& warning : warnings) errors.push_back({ErrorCode::inconsistent, file, warning});
    return errors;
}

}  // namespace fettle::design::cli
