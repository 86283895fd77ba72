// SPDX-License-Identifier: MIT
#include "design/cli/shown_motion.hpp"
#include "design/cli/step_options.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/certificate/certificate.hpp"
#include "core/files/nearest_word.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/answers/answer_json.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/inputs.hpp"
#include "design/reading/scene_shapes.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> up_names{"x", "-x", "y", "-y", "z", "-z"};

/// A folder's file to read is the trajectory in it, a certificate's the one beside it.
Result<std::string> file_to_read(const ShownOptions& options, std::string& certificate) {
    const std::string& path = options.path;
    std::error_code code;
    if (const auto trajectory = clearance::trajectory_in(path)) return *trajectory;
    if (!fs::is_directory(path, code) && file_kind(path) == FileKind::certificate) {
        certificate = path;
        return options.trajectory.empty() ? clearance::certificate_trajectory(path) : options.trajectory;
    }
    if (!options.trajectory.empty())
        return Error{ErrorCode::inconsistent, "--trajectory", "is for a certificate, and " + path + " is none"};
    return path;
}

/// "runs/fit.trajectory.json" -> "fit", "out/trajectory.json" -> "out", "parts/" -> "parts".
std::string stem_of(const std::string& path) {
    std::string name = fs::path(path).filename().string();
    if (name.empty()) name = fs::path(path).parent_path().filename().string();
    const fs::path folder = fs::absolute(path).parent_path();
    if (name == "trajectory.json" || name == "trajectory.running.json") return folder.filename().string();
    for (const char* ending : {".scene.json", ".design.json", ".part.json", ".trajectory.json", ".certificate.json", ".json"})
        if (name.size() > std::string_view(ending).size() && name.ends_with(ending))
            return name.substr(0, name.size() - std::string_view(ending).size());
    return fs::is_directory(path) ? name : fs::path(name).stem().string();
}

/// A stored trajectory has no gravity; its scene has, if it is still there.
void take_gravity(const CommonOptions& common, clearance::Subject& subject) {
    std::error_code code;
    if (subject.source != clearance::SubjectSource::trajectory || !fs::is_regular_file(subject.scene_path, code)) return;
    if (file_kind(subject.scene_path) != FileKind::scene) return;
    const auto scene =
        core::scene_files::read_scene(subject.scene_path, reading::scene_read_options(common.mesh_dirs, programs_of(common)));
    if (scene) subject.model.gravity = scene->gravity;
}

}  // namespace

Result<std::vector<int>> shown_bodies(const std::string& wanted, const std::vector<std::string>& bodies) {
    std::vector<int> shown;
    Errors errors;
    std::vector<bool> is_shown(bodies.size(), wanted.empty());
    std::istringstream names(wanted);
    for (std::string name; std::getline(names, name, ',');) {
        const auto at = std::find(bodies.begin(), bodies.end(), name);
        if (at != bodies.end()) {
            is_shown[at - bodies.begin()] = true;
            continue;
        }
        const std::vector<std::string_view> known(bodies.begin(), bodies.end());
        errors.push_back(
            {ErrorCode::out_of_range, "--bodies", "there is no body \"" + name + "\"; " + core::files::did_you_mean(name, known)});
    }
    if (!errors.empty()) return errors;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (is_shown[i]) shown.push_back(static_cast<int>(i));
    return shown;
}

void add_shown_options(CommandLine& app, ShownOptions& options) {
    app.option(
           "FILE", options.path,
           "Scene or design (as assembled), part file, trajectory, certificate (its path), mesh, or a folder (of a run, or with meshes)")
        .required();
    app.option("--bodies", options.bodies, "Only these, by their names with commas (default: all)");
    app.option("--unit", options.unit, "Unit of meshes that state none: mm, um, cm, m, in, ft, or auto: as their size suggests");
    app.flag("--split", options.split, "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2");
    add_step_options(app, options.step);
    app.option("--trajectory", options.trajectory, "For a certificate: the path that it is about (default: beside it)");
    app.option("--up", options.up, "The world's up: x, -x, y, -y, z, -z (default: against gravity; z where that is not known)")
        .one_of(up_names);
}

Result<ShownMotion> load_shown(const ShownOptions& options, const CommonOptions& common, Console& console) {
    ShownMotion shown;
    const Result<std::string> file = file_to_read(options, shown.certificate);
    if (!file) return file.errors();
    shown.file = *file;
    shown.stem = stem_of(options.path);
    clearance::SubjectOptions subject_options;
    subject_options.path = *file;
    subject_options.unit = options.unit;
    subject_options.split = options.split;
    subject_options.step = options.step;
    clearance::SubjectWatch watch;
    watch.on_warnings = [&](const std::vector<std::string>& warnings) { tell_warnings(console, warnings, *file); };
    watch.should_stop = interrupted;
    begin_to_read(*file);
    Result<clearance::Subject> subject = clearance::read_subject(subject_options, input_options(common), watch);
    if (!subject) return subject.errors();
    Result<std::vector<int>> bodies = shown_bodies(options.bodies, answers::body_names(subject->model));
    if (!bodies) return bodies.errors();
    shown.bodies = *std::move(bodies);
    shown.subject = std::move(*subject);
    take_gravity(common, shown.subject);
    shown.assembly = exports::assembly_of(shown.subject.model, shown.subject.domain.path());
    shown.assembly.parts = only(shown.bodies, shown.assembly.parts);
    for (exports::Keyframe& keyframe : shown.assembly.keyframes) keyframe.poses = only(shown.bodies, keyframe.poses);
    if (!options.up.empty()) {
        const int axis = options.up.back() - 'x';
        shown.assembly.up = (options.up.size() > 1 ? -1.0 : 1.0) * Vector3::Unit(axis);
    }
    return shown;
}

}  // namespace fettle::design::cli
