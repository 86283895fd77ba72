// SPDX-License-Identifier: MIT
/// fettle validate FILE: is this scene, design, trajectory or mesh usable? Every fault, by name and place.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "fettle/core/base/units.hpp"
#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/geometry/mesh_validity.hpp"
#include "fettle/core/mesh_files/mesh_reader.hpp"
#include "fettle/core/records/poses_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/design_file.hpp"
#include "fettle/design/design_problem.hpp"

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
    verdict.warnings = stored->warnings;
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
    const Result<Design> design = read_design(path, {common.mesh_dirs});
    if (!design) return verdict;
    verdict.facts["parameters"] = parameters_json(*design, values_of(design->parameters));
    Json names = Json::array();
    for (const auto& constraint : design->constraints) names.push_back(constraint->name());
    verdict.facts["constraints"] = names;
    return verdict;
}

struct Options {
    std::string path, trajectory;
};

// What a certificate claims, by name.
Json claims_json(const core::certificate::Certificate& certificate, const core::model::Model& model) {
    const auto name = [&](int body) {
        const bool known = body >= 0 && body < static_cast<int>(model.bodies.size());
        return known ? Json(model.bodies[static_cast<size_t>(body)].name) : Json(body);
    };
    Json list = Json::array();
    for (const auto& pair : certificate.pairs)
        list.push_back({{"a", name(pair.a)}, {"b", name(pair.b)}, {"lower", pair.lower}, {"upper", pair.upper}});
    return list;
}

std::string claims_text(const Json& claims, const core::model::Model& model) {
    const std::string unit = unit_name(model.length_unit);
    const double factor = 1 / core::base::metres_per_unit(unit).value();
    std::string text;
    const auto name = [](const Json& body) { return body.is_string() ? body.get<std::string>() : body.dump(); };
    for (const Json& pair : claims)
        text += formatted("  %s:%s  at least %.9g, at most %.9g %s\n", name(pair["a"]).c_str(), name(pair["b"]).c_str(),
                          pair["lower"].get<double>() * factor, pair["upper"].get<double>() * factor, unit.c_str());
    return text;
}

// A checker of its own judges: accepted or rejected, with every fault.
int run_check(const Options& options, Console& console) {
    const std::string trajectory = options.trajectory.empty() ? certificate_trajectory(options.path) : options.trajectory;
    const auto stored = core::records::read_trajectory(trajectory);
    if (!stored) return console.input_errors(stored.errors());
    Json json{{"status", "rejected"}, {"kind", "certificate"}, {"trajectory", trajectory}};
    Json faults = Json::array();
    std::string text;
    const auto certificate = core::certificate::read_certificate(options.path);
    for (const Error& error : certificate.errors()) faults.push_back({{"where", error.where}, {"message", error.message}});
    if (certificate) {
        const core::certificate::CertificateReport report = core::certificate::check_certificate(*certificate, *stored);
        for (const auto& fault : report.faults) faults.push_back({{"where", fault.where}, {"message", fault.message}});
        if (report.accepted()) json["status"] = "accepted";
        json["leaves"] = report.leaves;
        json["motion"] = certificate->motion;
        json["pairs"] = claims_json(*certificate, stored->model);
        if (report.accepted()) {
            text = formatted("every claim is proven, in %ld pieces, %s:\n", report.leaves,
                             certificate->motion ? "over the motion" : "as assembled") +
                   claims_text(json["pairs"], stored->model);
        }
    }
    json["faults"] = faults;
    for (const Json& fault : faults) text += "  " + fault["where"].get<std::string>() + ": " + fault["message"].get<std::string>() + "\n";
    const bool accepted = faults.empty();
    console.result(
        json, options.path + ": " + console.coloured(json["status"].get<std::string>(), accepted) + " for " + trajectory + "\n" + text);
    return accepted ? exit_done : exit_violated;
}

int run_validate(const Options& options, const CommonOptions& common, Console& console) {
    const std::string& path = options.path;
    const FileKind kind = file_kind(path);
    if (kind == FileKind::certificate) return run_check(options, console);
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
    app->footer(
        "Example:  fettle validate examples/slider_crank/slider_crank.design.json\n"
        "          fettle validate fit.certificate.json     is every claim proven? exit code 0: accepted, 1: rejected");
    return {app, [options, &common](Console& console) { return run_validate(*options, common, console); }};
}

}  // namespace fettle::design::cli
