// SPDX-License-Identifier: MIT
/// fettle validate FILE: is this scene, design, trajectory or mesh usable? Every fault, by name and place.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "fettle/core/geometry/mesh_validity.hpp"
#include "fettle/core/mesh_files/mesh_reader.hpp"
#include "fettle/core/records/poses_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/cli/validate_certificate.hpp"
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/reading/design_reader.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Verdict {
    Errors errors;
    std::vector<std::string> warnings;
    Json facts = Json::object();
};

Verdict validate_mesh_file(const std::string& path) {
    Verdict verdict;
    const Result<core::geometry::Mesh> mesh = core::mesh_files::read_mesh(path);
    if (!mesh) {
        verdict.errors = mesh.errors();
        return verdict;
    }
    verdict.errors = core::geometry::validate_mesh(*mesh, {});
    verdict.facts["vertices"] = mesh->vertices.cols();
    verdict.facts["triangles"] = mesh->triangles.size();
    verdict.facts["shells"] = mesh->shell_names;
    return verdict;
}

Verdict validate_trajectory(const std::string& path) {
    Verdict verdict;
    const Result<core::records::StoredTrajectory> stored = core::records::read_trajectory(path);
    if (!stored) {
        verdict.errors = stored.errors();
        return verdict;
    }
    verdict.facts["bodies"] = stored->trajectory.body_names;
    verdict.facts["steps"] = stored->trajectory.steps.size();
    return verdict;
}

Verdict validate_model(const std::string& path, FileKind kind, const CommonOptions& common) {
    Verdict verdict;
    const Result<LoadedModel> loaded = load_model(path, common);
    if (!loaded) {
        verdict.errors = loaded.errors();
        return verdict;
    }
    verdict.warnings = loaded->warnings;
    verdict.facts["bodies"] = body_names(loaded->model);
    if (kind != FileKind::design) return verdict;
    const Result<reading::DesignFile> file = reading::read_design(path, {common.mesh_dirs});
    if (!file) return verdict;
    verdict.facts["parameters"] = parameters_json(file->design, description::values_of(file->design.parameters));
    Json names = Json::array();
    for (const auto& constraint : file->design.constraints) names.push_back(constraint.name);
    verdict.facts["constraints"] = names;
    return verdict;
}

struct Options {
    std::string path, trajectory, minimum;
};

int run_validate(const Options& options, const CommonOptions& common, Console& console) {
    const std::string& path = options.path;
    const FileKind kind = file_kind(path);
    if (kind == FileKind::certificate) return validate_certificate({path, options.trajectory, options.minimum}, common, console);
    if (core::records::is_poses_file(path))
        return console.input_errors(
            {{ErrorCode::unsupported, path, "poses are checked with their scene: fettle clearance SCENE --poses FILE"}});
    const Verdict verdict = kind == FileKind::mesh         ? validate_mesh_file(path)
                            : kind == FileKind::trajectory ? validate_trajectory(path)
                                                           : validate_model(path, kind, common);
    if (!verdict.errors.empty()) return console.input_errors(verdict.errors);
    const char* kinds[] = {"scene", "design", "trajectory", "mesh"};
    Json json;
    json["status"] = "ok";
    json["kind"] = kinds[static_cast<int>(kind)];
    json.update(verdict.facts);
    json["warnings"] = verdict.warnings;
    tell_warnings(console, verdict.warnings);
    console.result(json, path + ": a valid " + kinds[static_cast<int>(kind)] + "\n");
    return exit_done;
}

}  // namespace

Command add_validate(CLI::App& program, const CommonOptions& common) {
    CLI::App* app =
        program.add_subcommand("validate", "Is this scene, design, trajectory, certificate or mesh usable? Every fault, by name and place");
    auto options = std::make_shared<Options>();
    app->add_option("FILE", options->path, "Scene, design, trajectory, certificate (.json) or mesh (.stl .obj .off .ply .3mf)")->required();
    app->add_option("--trajectory", options->trajectory,
                    "Of a certificate: the path that it speaks of (default: FILE's name, .trajectory.json)");
    app->add_option("--minimum", options->minimum, "Of a certificate: do its bounds meet this clearance, per side, with its unit: 0.3mm");
    app->footer(
        "Example:  fettle validate examples/slider_crank/slider_crank.design.json\n"
        "          fettle validate fit.certificate.json     is every claim proven? exit code 0: accepted, 1: rejected");
    return {app, [options, &common](Console& console) { return run_validate(*options, common, console); }};
}

}  // namespace fettle::design::cli
