// SPDX-License-Identifier: MIT
#include "design/clearance/mesh_parts.hpp"

#include <algorithm>
#include <filesystem>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/unique_names.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/shells.hpp"

namespace fettle::design::clearance {

namespace {

namespace fs = std::filesystem;
using core::geometry::Mesh;

std::vector<std::string> meshes_in(const fs::path& folder) {
    std::vector<std::string> files;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder, code))
        if (entry.is_regular_file(code) && core::mesh_files::has_mesh_extension(entry.path().string()))
            files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

// Folders below it that hold meshes, which are not looked at.
std::vector<std::string> folders_left_out(const fs::path& folder) {
    std::vector<std::string> folders;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder, code))
        if (entry.is_directory(code) && !meshes_in(entry.path()).empty()) folders.push_back(entry.path().string());
    std::sort(folders.begin(), folders.end());
    return folders;
}

Result<std::vector<std::string>> mesh_files(const std::vector<std::string>& paths, std::vector<std::string>& warnings) {
    std::vector<std::string> files;
    Errors errors;
    for (const std::string& path : paths) {
        std::error_code code;
        if (fs::is_directory(path, code)) {
            const std::vector<std::string> found = meshes_in(path);
            files.insert(files.end(), found.begin(), found.end());
            if (found.empty())
                errors.push_back({ErrorCode::file_not_found, path,
                                  "this folder has no mesh (" + core::mesh_files::mesh_extensions() +
                                      ") and no trajectory.json; folders below it are not looked into"});
            for (const std::string& below : folders_left_out(path))
                warnings.push_back(below + ": the meshes in this folder are left out; name it too if they belong together");
        } else if (core::mesh_files::has_mesh_extension(path)) {
            files.push_back(path);
        } else if (!fs::exists(path, code)) {
            errors.push_back({ErrorCode::file_not_found, path, "no such file"});
        } else {
            errors.push_back({ErrorCode::inconsistent, path, "is not a mesh; several files are judged together only if all are meshes"});
        }
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        const bool again = std::any_of(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i), [&](const std::string& other) {
            std::error_code ignored;
            return fs::equivalent(other, files[i], ignored);
        });
        if (again) errors.push_back({ErrorCode::inconsistent, files[i], "is named twice, and would be judged against itself"});
    }
    if (!errors.empty()) return errors;
    return files;
}

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

// A mesh that a file has, mended; of one that is split each solid.
std::vector<NamedMesh> solids_of(NamedMesh whole, const reading::InputOptions& input, bool split, core::files::UniqueNames& names,
                                 std::vector<std::string>& warnings) {
    if (!input.strict)
        for (const std::string& done : core::solids::repair_mesh(whole.mesh)) warnings.push_back("body `" + whole.name + "`: " + done);
    std::vector<Mesh> solids;
    if (split) solids = core::solids::split_solids(whole.mesh);
    std::vector<NamedMesh> out;
    if (solids.size() < 2) {
        out.push_back(std::move(whole));
        return out;
    }
    for (std::size_t i = 0; i < solids.size(); ++i)
        out.push_back({names.unique(whole.name + "#" + std::to_string(i + 1)), std::move(solids[i])});
    return out;
}

core::scene::Body body_of(NamedMesh solid, const std::string& path, const reading::InputOptions& input) {
    core::scene::Body body;
    body.name = std::move(solid.name);
    body.where = path;
    body.type = core::scene::BodyType::static_body;
    body.density_given = false;
    if (!input.strict) body.mesh_policy = core::scene::MeshPolicy::tolerant;
    body.mesh = std::move(solid.mesh);
    return body;
}

double longest_side(const Mesh& mesh) { return core::geometry::box_sides(mesh.vertices).maxCoeff(); }

}  // namespace

std::string body_name(const std::string& of_file, core::files::UniqueNames& names) {
    std::string name = core::base::shown_on_one_line(of_file);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ':' || c == ',' || c == '*'; }, '_');
    if (name.empty()) name = "part";
    return names.unique(name);
}

std::string proposed_unit(const std::vector<std::string>& files, std::vector<std::string>& warnings) {
    constexpr double least = 0.3, largest = 3000;  // [mm]
    double side = 0;
    std::string of;
    for (const std::string& path : files) {
        if (core::mesh_files::states_its_unit(path)) continue;
        const Result<Mesh> mesh = core::mesh_files::read_mesh(path);
        if (!mesh || mesh->vertices.cols() == 0 || !(longest_side(*mesh) > side)) continue;
        side = longest_side(*mesh);
        of = path;
    }
    if (of.empty()) return {};
    const std::string unit = side > largest ? "um" : side < least ? "m" : "mm";
    const double metres = core::base::metres_per_unit(unit).value();
    warnings.push_back("--unit auto: lengths are taken as " + unit + ", in which the longest side of " + of + " is " +
                       core::base::formatted("%.4g mm (in inches it would be %.4g mm); say --unit where that is not meant",
                                             1e3 * metres * side, 25.4 * side));
    return unit;
}

std::string doubted_side(double side, const std::string& unit) {
    constexpr double largest = 3, printed = 0.3, smallest = 1e-4, micrometre = 1e-6;  // [m]
    const Result<double> metres = unit.empty() ? Result<double>(1e-3) : core::base::metres_per_unit(unit, "--unit");
    if (!metres || !(side > 0)) return {};
    const bool is_large = side > (*metres > 1e-3 ? printed : largest), is_small = side<smallest&& * metres> micrometre;
    if (!is_large && !is_small) return {};
    std::string text = "its longest side is " + core::base::formatted("%.4g mm", 1e3 * side);
    if (unit.empty()) return text + ", which is hardly meant; is the unit that the file states right?";
    if (*metres != 1e-3)
        return text + ", and would be " + core::base::formatted("%.4g mm", side / *metres) + " in mm; is --unit " + unit + " right?";
    return text + ", which is hardly meant; is --unit " + unit + " right?";
}

std::optional<std::string> trajectory_in(const std::string& path) {
    std::error_code code;
    for (const char* name : {"trajectory.json", "trajectory.running.json"})
        if (fs::exists(fs::path(path) / name, code)) return (fs::path(path) / name).string();
    return std::nullopt;
}

bool are_meshes(const std::vector<std::string>& paths) {
    if (paths.empty()) return false;
    std::error_code code;
    const fs::path first = paths.front();
    if (fs::is_directory(first, code)) return !trajectory_in(first.string());
    return core::mesh_files::has_mesh_extension(paths.front());
}

Result<MeshParts> load_meshes(const std::vector<std::string>& paths, const std::string& given_unit, const reading::InputOptions& input,
                              bool split, const reading::StepWishes& step) {
    MeshParts subject;
    const Result<std::vector<std::string>> files = mesh_files(paths, subject.warnings);
    if (!files) return files.errors();
    const std::string unit = given_unit == "auto" ? proposed_unit(*files, subject.warnings) : given_unit;
    core::scene::Scene scene;
    scene.length_unit = 1e-3;
    Errors errors;
    if (!unit.empty()) {
        const Result<double> metres = core::base::metres_per_unit(unit, "--unit");
        if (!metres) return metres.errors();
        scene.length_unit = *metres;
    }
    core::mesh_files::MeshReadOptions read{scene.length_unit, true, input.should_stop};
    if (Errors faults = reading::take_step_wishes(step, read); !faults.empty()) return faults;
    subject.files = *files;
    core::files::UniqueNames names(" ");
    std::error_code code;
    for (const std::string& path : *files) {
        if (unit.empty() && !core::mesh_files::states_its_unit(path) && fs::exists(path, code)) {  // else its reader says why
            errors.push_back({ErrorCode::missing_key, path, "the file states no unit of length; say it: --unit mm"});
            continue;
        }
        Result<std::vector<Mesh>> parts = core::mesh_files::read_mesh_parts(path, read);
        errors.insert(errors.end(), parts.errors().begin(), parts.errors().end());
        if (!parts) continue;
        const std::vector<std::string> items = core::mesh_files::item_names(*parts);
        const bool has_items = parts->size() > 1 || core::mesh_files::is_step(path);
        for (std::size_t k = 0; k < parts->size(); ++k) {
            Mesh& mesh = (*parts)[k];
            constexpr double told_with_the_model = 10;  // [m]: of larger bodies check_scene says it
            const double side = longest_side(mesh);
            const std::string name = body_name(mesh.name, names);
            const std::string doubt = doubted_side(side, core::mesh_files::states_its_unit(path) ? "" : unit);
            std::vector<NamedMesh> solids = solids_of({name, std::move(mesh)}, input, split, names, subject.warnings);
            for (std::size_t i = 0; i < solids.size(); ++i) {
                subject.sources.push_back({path, has_items ? items[k] : "", solids.size() > 1 ? static_cast<int>(i) + 1 : 0});
                scene.bodies.push_back(body_of(std::move(solids[i]), path, input));
            }
            if (!doubt.empty() && side <= told_with_the_model) subject.warnings.push_back("body `" + name + "`: " + doubt);
        }
    }
    if (!errors.empty()) return errors;
    core::setup::BuildOptions options;
    options.check_start = false;
    Result<core::model::Model> model = core::setup::build_model(scene, options);
    if (!model) return model.errors();
    subject.model = std::move(*model);
    const auto& more = subject.model.warnings;
    subject.warnings.insert(subject.warnings.end(), more.begin(), more.end());
    if (input.strict && !subject.warnings.empty()) return reading::as_errors(subject.warnings, paths.front());
    return subject;
}

}  // namespace fettle::design::clearance
