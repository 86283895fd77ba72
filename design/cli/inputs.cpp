// SPDX-License-Identifier: MIT
#include "fettle/design/cli/inputs.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/model/build_model.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/reading/scene_shapes.hpp"

namespace fettle::design::cli {

FileKind file_kind(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const char* mesh : {".stl", ".obj", ".off", ".ply", ".3mf"}) {
        if (extension == mesh) return FileKind::mesh;
    }
    if (core::records::is_trajectory_file(path)) return FileKind::trajectory;
    if (core::certificate::is_certificate_file(path)) return FileKind::certificate;
    return reading::is_design_file(path) ? FileKind::design : FileKind::scene;
}

Result<LoadedModel> load_model(const std::string& path, const CommonOptions& common, bool check_start) {
    LoadedModel loaded;
    if (reading::is_design_file(path)) {
        Result<reading::DesignFile> file = reading::read_design(path, {common.mesh_dirs});
        if (!file) return file.errors();
        loaded.scene_path = file->scene_path;
        loaded.steps = file->design.steps;
        loaded.warnings = file->warnings;
        const VectorX values = description::values_of(file->design.parameters);
        const auto problem = problem::DesignProblem::create(std::move(file->design));
        if (!problem) return problem.errors();
        Result<core::model::Model> model = problem->model_at(values);
        if (!model) return model.errors();
        loaded.model = std::move(model).value();
        return loaded;
    }
    const Result<core::scene::Scene> scene = core::scene::read_scene(path, reading::scene_read_options(common.mesh_dirs));
    if (!scene) return scene.errors();
    loaded.scene_path = path;
    loaded.warnings = scene->warnings;
    core::model::BuildOptions options;
    options.check_start = check_start;
    Result<core::model::Model> model = core::model::build_model(*scene, options);
    if (!model) return model.errors();
    loaded.model = std::move(model).value();
    return loaded;
}

std::string certificate_trajectory(const std::string& certificate) {
    std::string stem = certificate;
    for (const std::string ending : {".json", ".certificate"}) {
        if (stem.size() > ending.size() && stem.compare(stem.size() - ending.size(), ending.size(), ending) == 0)
            stem.resize(stem.size() - ending.size());
    }
    return stem + ".trajectory.json";
}

void tell_warnings(Console& console, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) console.narrate("warning: " + warning);
}

}  // namespace fettle::design::cli
