// SPDX-License-Identifier: MIT
#include "design/session/opened.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/read_record.hpp"
#include "core/base/stop.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_dump.hpp"
#include "core/model/start_check.hpp"
#include "core/part_files/part_file.hpp"
#include "core/scene/step_count.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/features/assembly_scene.hpp"
#include "design/reading/parameter_reader.hpp"

namespace fettle::design::session {

namespace {

using Json = nlohmann::ordered_json;
using reading::DesignFile;

constexpr double less = 0.5, more = 2, about_zero = 10;

// What a person would give as bounds of the scene's variables that are numbers.
Json parameters_of(const std::vector<core::scene::Variable>& variables, const Unit& length_unit) {
    Json list = Json::array();
    for (const core::scene::Variable& variable : variables) {
        const auto dimension = core::expression::named_dimension(variable.formula.dimension);
        if (!variable.formula.is_constant() || !dimension) continue;
        const Unit unit = reading::usual_unit(*dimension, length_unit);
        const double value = description::from_si(variable.value, unit), size = std::abs(value);
        const double one = value == 0 ? -about_zero : value > 0 ? less * size : -more * size;
        const double other = value == 0 ? about_zero : value > 0 ? more * size : -less * size;
        list.push_back({{"name", variable.name}, {"unit", unit.name}, {"lower", one}, {"upper", other}});
    }
    return list;
}

// The scene as it stands, in which nothing can be changed.
Result<DesignFile> fixed_scene(const std::string& path, const reading::InputOptions& options) {
    core::scene::ReadOptions read = reading::scene_read_options(options.mesh_dirs, options.programs);
    read.strict_meshes = options.strict;
    const core::base::ReadRecord record;
    Result<core::scene::Scene> scene = reading::read_scene_or_part(path, read);
    if (!scene) return scene.errors();
    DesignFile file;
    file.path = file.scene_path = path;
    file.length_unit = *find_unit("mm");
    file.warnings = scene->warnings;
    file.design.steps = core::scene::step_count(*scene);
    file.design.scene = std::move(scene).value();
    file.files = record.files();
    return file;
}

// Pairs of bodies that overlap as assembled, which nothing could be simulated with.
std::vector<std::string> overlapping_pairs(const core::scene::Scene& scene) {
    core::setup::BuildOptions build;
    build.check_start = false;
    const Result<core::model::Model> model = core::setup::build_model(scene, build);
    std::vector<std::string> pairs;
    if (!model) return pairs;  // told when the scene is built for good
    for (const auto& [a, b] : core::model::report_start(*model).overlapping)
        pairs.push_back(model->bodies[a].name + ":" + model->bodies[b].name);
    return pairs;
}

Result<DesignFile> meshes_as_design(const std::string& path, const OpenOptions& options, std::string& made_scene) {
    const core::base::ReadRecord record;
    const Result<clearance::MeshParts> parts = clearance::load_meshes({path}, options.unit, options.inputs, options.split);
    if (!parts) return parts.errors();
    features::AssemblyQuestion question;
    question.to = (std::filesystem::path(path).parent_path() / std::filesystem::path(path).stem()).string() + ".scene.json";
    question.joints = true;
    question.limits = false;
    if (options.inputs.should_stop) question.should_stop = options.inputs.should_stop;
    question.mesh_dirs = options.inputs.mesh_dirs;
    const Result<features::AssemblyScene> made = features::assembly_scene(*parts, question);
    if (!made) return made.errors();
    if (made->interrupted) throw core::base::Stopped();
    const core::base::StopScope scope(options.inputs.should_stop);
    Result<core::scene::Scene> scene = core::scene_files::parse_scene(
        made->text, question.to, reading::scene_read_options(options.inputs.mesh_dirs, options.inputs.programs));
    if (!scene) return scene.errors();
    DesignFile file;
    file.path = path;
    file.scene_path = question.to;
    made_scene = made->text;
    file.length_unit = *find_unit("mm");
    file.warnings = parts->warnings;
    for (const std::string& pair : overlapping_pairs(*scene)) {
        file.warnings.push_back(pair + " overlap as assembled: they pass through each other here");
        scene->ignore.push_back(pair);
    }
    for (const features::AssemblyJoint& joint : made->joints) file.warnings.push_back("joint " + joint.name + ": " + joint.reason);
    file.design.scene = std::move(scene).value();
    file.files = record.files();
    return file;
}

Result<DesignFile> scene_as_design(const std::string& path, const reading::InputOptions& options) {
    if (path.ends_with(core::part_files::part_file_ending)) return fixed_scene(path, options);
    auto document = core::files::JsonDocument::read(path);
    if (!document) return document.errors();
    const std::string units = document->root()["units"].string().value_or("m");
    const std::vector<core::scene::Variable> variables = core::scene_files::variables_of(*document);
    const Unit* unit = find_unit(units);  // a wrong one is told by the reader
    const Json parameters = parameters_of(variables, unit != nullptr ? *unit : *find_unit("m"));
    if (parameters.empty()) return fixed_scene(path, options);
    const Json design{{"fettle_design", 1},
                      {"scene", std::filesystem::path(path).filename().string()},
                      {"units", unit != nullptr ? units : "m"},
                      {"parameters", parameters}};
    return reading::parse_design(core::files::dumped(design), path, {.mesh_dirs = options.mesh_dirs, .programs = options.programs});
}

}  // namespace

Result<std::shared_ptr<const Opened>> open(const std::string& path, const OpenOptions& options) {
    const bool is_of_meshes = clearance::are_meshes({path});
    const reading::FileKind kind = is_of_meshes ? reading::FileKind::mesh : reading::file_kind(path);
    if (Errors errors = reading::not_wanted(path, kind, "scene or design"); !errors.empty()) return errors;
    auto opened = std::make_shared<Opened>();
    opened->is_scene = kind != reading::FileKind::design;
    Result<DesignFile> file = is_of_meshes       ? meshes_as_design(path, options, opened->made_scene)
                              : opened->is_scene ? scene_as_design(path, options.inputs)
                                                 : reading::open_design(path, options.inputs);
    if (!file) return file.errors();
    const core::base::StopScope scope(options.inputs.should_stop);
    Result<problem::DesignProblem> problem = problem::DesignProblem::create(file->design);
    if (!problem) return problem.errors();
    opened->warnings = file->warnings;
    opened->warnings.insert(opened->warnings.end(), problem->warnings().begin(), problem->warnings().end());
    opened->file = std::move(file).value();
    opened->problem = std::make_shared<const problem::DesignProblem>(std::move(problem).value());
    return std::shared_ptr<const Opened>(std::move(opened));
}

std::vector<std::string> paths_of(const Opened& opened) {
    std::vector<std::string> paths{opened.file.path};
    for (const auto& [path, hash] : opened.file.files) paths.push_back(path);
    return paths;
}

WatchedFiles::WatchedFiles(const std::vector<std::string>& paths, std::filesystem::file_time_type begin) {
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const std::string& path : paths) {
        const Stamp stamp = stamp_of(path);
        const bool is_newer = begin <= stamp.time && stamp.time <= now;  // times to come are of another machine's clock
        files_.emplace_back(path, is_newer ? Stamp{} : stamp);
    }
}

// One that is not there has a stamp too: editors take a file away before they write it anew.
WatchedFiles::Stamp WatchedFiles::stamp_of(const std::filesystem::path& path) {
    std::error_code none;
    Stamp stamp;
    stamp.time = std::filesystem::last_write_time(path, none);
    if (none) return {};
    stamp.size = std::filesystem::file_size(path, none);
    return none ? Stamp{} : stamp;
}

bool WatchedFiles::have_changed() {
    bool changed = false;
    for (auto& [path, stamp] : files_) {
        const Stamp now = stamp_of(path);
        changed = changed || !(now == stamp);
        stamp = now;
    }
    return changed;
}

}  // namespace fettle::design::session
