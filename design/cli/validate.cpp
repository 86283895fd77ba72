// SPDX-License-Identifier: MIT
/// fettle validate FILE: is this scene, design, part, trajectory or mesh usable? Every fault, by name and place.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/part_files/part_file.hpp"
#include "core/records/poses_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/shells.hpp"
#include "design/answers/answer_json.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/body_facts.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/step_facts.hpp"
#include "design/cli/step_options.hpp"
#include "design/cli/validate_certificate.hpp"
#include "design/problem/buildable.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/choice_search.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Verdict {
    Errors errors;
    std::vector<std::string> warnings;
    Json facts = Json::object();
    std::string text;  ///< of the facts
};

// A mesh file without a unit, read as if in mm: its places are numbers.
std::string without_unit(std::string text) {
    for (std::size_t at = text.find(") mm"); at != std::string::npos; at = text.find(") mm", at + 1)) {
        if (at + 4 == text.size() || std::isalnum(static_cast<unsigned char>(text[at + 4])) == 0) text.erase(at + 1, 3);
    }
    return text;
}

// The verdict on a STEP file, whose solids are bodies of their own.
Verdict validate_step_file(const std::string& path, const reading::StepWishes& wishes, bool strict) {
    Verdict verdict;
    core::mesh_files::MeshReadOptions options{1, true, interrupted};
    verdict.errors = reading::take_step_wishes(wishes, options);
    if (!verdict.errors.empty()) return verdict;
    Result<std::vector<core::geometry::Mesh>> items = core::mesh_files::read_mesh_parts(path, options);
    if (!items) {
        verdict.errors = items.errors();
        return verdict;
    }
    for (core::geometry::Mesh& mesh : *items) {
        const auto named = [&](const std::string& text) { return "item `" + mesh.name + "`: " + text; };
        core::solids::MeshFindings found;
        if (strict) {
            found.errors = core::solids::validate_mesh(mesh, {});
        } else {
            for (const std::string& done : core::solids::repair_mesh(mesh)) verdict.warnings.push_back(named(done));
            found = core::solids::judge_mesh(mesh, true);
        }
        for (Error& error : found.errors) verdict.errors.push_back({error.code, path, named(error.message)});
        for (const std::string& warning : found.warnings) verdict.warnings.push_back(named(warning));
    }
    verdict.facts["unit"] = "mm";
    verdict.facts["items"] = step_items_json(*items);
    verdict.text = step_items_text(*items);
    return verdict;
}

// The solids of a mesh, called as --split calls them.
void tell_solids(const core::geometry::Mesh& mesh, const std::string& path, const std::string& unit, Verdict& verdict) {
    const std::vector<core::geometry::Mesh> solids = core::solids::split_solids(mesh);
    constexpr std::size_t most_told = 40;
    verdict.text += "  " + std::to_string(solids.size()) +
                    " solids that do not hang together: one body in a scene, or one each: \"mesh_solid\": 1, ..., " +
                    "\"split_components\": true, or --split of clearance, features, fit, import, draw, export\n";
    Json list = Json::array();
    for (std::size_t k = 0; k < solids.size(); ++k) {
        const Matrix3X& x = solids[k].vertices;
        const Vector3 size = 1e3 * core::geometry::box_sides(x);
        const double volume = 1e9 * core::geometry::capped_solid_moments(x, solids[k].triangles)(3, 3);
        const std::string name = std::filesystem::path(path).stem().string() + "#" + std::to_string(k + 1);
        list.push_back({{"name", name}, {"size", {size.x(), size.y(), size.z()}}, {"volume", volume}});
        if (k < most_told)
            verdict.text += formatted("    %s  %.6g x %.6g x %.6g%s, volume %.6g%s\n", core::base::shown_on_one_line(name).c_str(),
                                      size.x(), size.y(), size.z(), unit.c_str(), volume, unit.empty() ? "" : (unit + "^3").c_str());
    }
    if (solids.size() > most_told) verdict.text += "    ...\n";
    verdict.facts["parts"] = std::move(list);
}

// @param given_unit  The unit of a file that states none; empty: its places are numbers.
Verdict validate_mesh_file(const std::string& path, const std::string& given_unit, bool strict) {
    Verdict verdict;
    std::vector<std::string> proposals;
    const std::string unit = given_unit == "auto" ? clearance::proposed_unit({path}, proposals) : given_unit;
    const Result<double> metres = unit.empty() ? Result<double>(1e-3) : core::base::metres_per_unit(unit, "--unit");
    if (!metres) {
        verdict.errors = metres.errors();
        return verdict;
    }
    Result<core::geometry::Mesh> mesh = core::mesh_files::read_mesh(path, {*metres, true, interrupted});
    if (!mesh) {
        verdict.errors = mesh.errors();
        return verdict;
    }
    if (strict) {
        verdict.errors = core::solids::validate_mesh(*mesh, {});
    } else {
        verdict.warnings = core::solids::repair_mesh(*mesh);
        core::solids::MeshFindings found = core::solids::judge_mesh(*mesh, true);
        verdict.errors = std::move(found.errors);
        verdict.warnings.insert(verdict.warnings.end(), found.warnings.begin(), found.warnings.end());
    }
    verdict.warnings.insert(verdict.warnings.begin(), proposals.begin(), proposals.end());
    const bool has_unit = !unit.empty() || core::mesh_files::states_its_unit(path);
    if (!has_unit) {
        for (std::string& warning : verdict.warnings) warning = without_unit(warning);
        for (Error& error : verdict.errors) error.message = without_unit(error.message);
    }
    const Vector3 size = 1e3 * core::geometry::box_sides(mesh->vertices);
    const double volume = 1e9 * core::geometry::capped_solid_moments(mesh->vertices, mesh->triangles)(3, 3);
    if (verdict.errors.empty()) {
        const std::string doubt = clearance::doubted_side(1e-3 * size.maxCoeff(), core::mesh_files::states_its_unit(path) ? ""
                                                                                  : has_unit                              ? unit
                                                                                                                          : "mm");
        if (!doubt.empty())
            verdict.warnings.push_back(has_unit ? doubt : "if the file is in mm, as most are: " + doubt.substr(0, doubt.find(';')));
    }
    verdict.facts["vertices"] = mesh->vertices.cols();
    verdict.facts["triangles"] = mesh->triangles.size();
    verdict.facts["shells"] = mesh->shell_names;
    const int solids = core::solids::solids_of_shells(*mesh).count;
    verdict.facts["solids"] = solids;
    verdict.facts["unit"] = has_unit ? Json("mm") : Json(nullptr);
    verdict.facts["size"] = {size.x(), size.y(), size.z()};
    verdict.facts["volume"] = volume;
    verdict.text =
        formatted("  size %.6g x %.6g x %.6g%s, volume %.6g%s\n", size.x(), size.y(), size.z(), has_unit ? " mm" : "", volume,
                  has_unit ? " mm^3" : "; the file states no unit: in a scene it is that of `mesh_unit` or `units`, here of --unit");
    if (solids > 1) tell_solids(*mesh, path, has_unit ? " mm" : "", verdict);
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

// "  choices: material PLA (PLA, POM), teeth 15 (11 to 20); the relations allow 18 of 20 combinations"
void add_choices(const LoadedModel& loaded, Verdict& verdict) {
    if (loaded.choices.empty()) return;
    Json json = Json::object();
    std::string text;
    for (const description::Choice& choice : loaded.choices) {
        const std::string& value = choice.options[static_cast<std::size_t>(choice.value)];
        json[choice.name] = {{"value", value}, {"options", choice.options}};
        const bool is_range = choice.is_ordered && choice.options.size() > 3;
        text += (text.empty() ? "  choices: " : ", ") + choice.name + " " + value + " (" +
                (is_range ? choice.options.front() + " to " + choice.options.back() : core::base::joined(choice.options)) + ")";
    }
    const long long all = description::combination_count(loaded.choices);
    const auto search = studies::ChoiceSearch::create(loaded.choices, loaded.conditions, 1);
    for (const Error& error : search.errors()) verdict.warnings.push_back("choices: " + error.message);
    verdict.facts["choices"] = std::move(json);
    verdict.facts["combinations"] = all;
    verdict.facts["allowed_combinations"] = search ? Json(search->allowed()) : Json();
    if (search && static_cast<long long>(search->allowed()) != all)
        text += "; the relations allow " + std::to_string(search->allowed()) + " of " + std::to_string(all) + " combinations";
    verdict.text += text + "\n";
}

Verdict validate_model(const std::string& path, FileKind kind, const CommonOptions& common) {
    Verdict verdict;
    begin_to_read(path);
    const Result<LoadedModel> loaded = reading::load_model(path, kind, input_options(common));
    if (!loaded) {
        verdict.errors = loaded.errors();
        return verdict;
    }
    verdict.warnings = loaded->warnings;
    verdict.facts["bodies"] = answers::body_names(loaded->model);
    verdict.facts["parts"] = parts_json(loaded->model);
    verdict.text = parts_text(loaded->model);
    if (loaded->problem == nullptr) return verdict;
    const description::Design& design = loaded->problem->design();
    verdict.facts["parameters"] = answers::parameters_json(design, description::values_of(design.parameters));
    Json names = Json::array();
    for (const auto& constraint : design.constraints) names.push_back(constraint.name);
    verdict.facts["constraints"] = names;
    names = Json::array();
    for (const auto& relation : design.relations) names.push_back(relation.name);
    verdict.facts["relations"] = names;
    add_choices(*loaded, verdict);
    for (std::string& line : problem::described(design, problem::try_bounds(*loaded->problem))) {
        verdict.warnings.push_back("bounds: " + line);
    }
    return verdict;
}

struct ValidateArguments {
    std::string path, unit, trajectory, source, minimum;
    reading::StepWishes step;
};

int run_validate(const ValidateArguments& options, const CommonOptions& common, Console& console) {
    const std::string& path = options.path;
    const FileKind kind = file_kind(path);
    if (kind == FileKind::certificate && options.unit.empty())
        return validate_certificate({path, options.trajectory, options.source, options.minimum}, common, console);
    Errors not_taken;
    if (!options.unit.empty() && kind != FileKind::mesh)
        not_taken.push_back({ErrorCode::inconsistent, "--unit", "is for meshes; this file states its own unit"});
    for (const auto& [option, value] :
         {std::pair{"--minimum", options.minimum}, {"--trajectory", options.trajectory}, {"--source", options.source}})
        if (!value.empty() && kind != FileKind::certificate)
            not_taken.push_back(
                {ErrorCode::inconsistent, option,
                 std::string("is for a certificate") + (option == std::string_view("--source") ? "" : "; use fettle clearance")});
    const bool is_step = kind == FileKind::mesh && core::mesh_files::is_step(path);
    for (const auto& [option, value] :
         {std::pair{"--facets", options.step.facets}, {"--surface-tolerance", options.step.surface_tolerance}})
        if (!value.empty() && !is_step) not_taken.push_back({ErrorCode::inconsistent, option, "is for STEP files"});
    if (!not_taken.empty()) return console.input_errors(not_taken);
    if (core::records::is_poses_file(path))
        return console.input_errors(
            {{ErrorCode::unsupported, path, "poses are checked with their scene: fettle clearance SCENE --poses FILE"}});
    const Verdict verdict = is_step                        ? validate_step_file(path, options.step, common.strict)
                            : kind == FileKind::mesh       ? validate_mesh_file(path, options.unit, common.strict)
                            : kind == FileKind::trajectory ? validate_trajectory(path)
                                                           : validate_model(path, kind, common);
    if (!verdict.errors.empty()) return console.input_errors(verdict.errors);
    const char* kinds[] = {"scene", "design", "trajectory", "mesh"};
    const bool is_part = kind == FileKind::scene && path.ends_with(core::part_files::part_file_ending);
    const char* const kind_name = is_part ? "part" : kinds[static_cast<int>(kind)];
    Json json;
    json["status"] = "ok";
    json["kind"] = kind_name;
    json.update(verdict.facts);
    json["warnings"] = verdict.warnings;
    tell_warnings(console, verdict.warnings, path);
    console.found({path, CheckOutcome::passed, "valid", std::string("a valid ") + kind_name, path});
    const std::string doubts = verdict.warnings.empty() ? "" : ", with " + core::base::counted(verdict.warnings.size(), "warning");
    console.result(json, path + ": a valid " + kind_name + doubts + "\n" + verdict.text);
    return exit_done;
}

}  // namespace

Command add_validate(CommandLine& program, const CommonOptions& common) {
    CommandLine app =
        program.command("validate", "Checks a scene, design, part, trajectory, certificate or mesh, and lists every fault with its place");
    auto options = std::make_shared<ValidateArguments>();
    app.option("FILE", options->path,
               "Scene, design, part, trajectory, certificate (.json) or mesh (" + core::mesh_files::mesh_extensions() + ")")
        .required();
    app.option("--unit", options->unit, "Unit of a mesh that states none: mm, um, cm, m, in, ft, or auto: as its size suggests");
    add_step_options(app, options->step);
    app.option("--trajectory", options->trajectory,
               "For a certificate: the path that it is about (default: FILE's name, .trajectory.json)");
    app.option("--source", options->source,
               "For a certificate: the scene or design that it is to be about (default: the one that it names)");
    app.option("--minimum", options->minimum,
               "For a certificate: do its bounds meet this clearance, per side, with its unit: 0.3mm (default: the minima that it states)");
    app.closing_words(
        "Example:  fettle validate examples/slider_crank/slider_crank.design.json\n"
        "          fettle validate fit.certificate.json     is every claim proven? exit code 0: accepted, 1: rejected");
    return {app, [options, &common](Console& console) { return run_validate(*options, common, console); }};
}

}  // namespace fettle::design::cli
