// SPDX-License-Identifier: MIT
#include "fettle/design/cli/clearance_subject.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "fettle/core/base/text.hpp"
#include "fettle/core/base/units.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/model/start_check.hpp"
#include "fettle/core/records/poses_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/core/stepper/jointed_motion.hpp"
#include "fettle/core/stepper/scripted_motion.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/core/stepper/step_count.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/cli/mesh_subject.hpp"

namespace fettle::design::cli {

namespace {

using core::scene::BodyType;

// What moves without dynamics is kinematic, what does not move is static: whoever reads the stored trajectory then knows.
void mark_as_scripted(Subject& subject) {
    for (size_t i = 0; i < subject.model.bodies.size(); ++i) {
        bool moves = false;
        for (const auto& step : subject.trajectory.steps) {
            for (const auto& node : step.nodes)
                moves = moves || node[i].rotation_vector != Vector3::Zero() || node[i].position != subject.trajectory.poses[0][i].position;
        }
        subject.model.bodies[i].type = moves ? BodyType::kinematic_body : BodyType::static_body;
    }
}

Result<Subject> from_trajectory(const SubjectOptions& options) {
    if (!options.poses.empty() || options.kinematic)
        return Error{ErrorCode::inconsistent, options.path,
                     "a trajectory has its motion; --poses and --kinematic go with a scene or design"};
    Result<core::records::StoredTrajectory> stored = core::records::read_trajectory(options.path);
    if (!stored) return stored.errors();
    Subject subject;
    subject.model = std::move(stored->model);
    subject.trajectory = std::move(stored->trajectory);
    subject.source = SubjectSource::trajectory;
    subject.scene_path = stored->scene_path;
    subject.notes.insert(subject.notes.end(), stored->warnings.begin(), stored->warnings.end());
    return subject;
}

Errors take_poses(const SubjectOptions& options, Subject& subject) {
    std::optional<double> unit;
    if (!options.poses_unit.empty()) {
        const Result<double> metres = core::base::metres_per_unit(options.poses_unit, "--poses-unit");
        if (!metres) return metres.errors();
        unit = *metres;
    }
    auto read = core::records::read_poses(options.poses, subject.model, unit);
    if (!read) return read.errors();
    subject.trajectory = std::move(read->trajectory);
    subject.source = SubjectSource::poses;
    for (size_t i = 0; i < subject.model.bodies.size(); ++i) subject.model.bodies[i].pose_start = subject.trajectory.poses[0][i];
    if (!read->still.empty())
        subject.notes.push_back("not in " + options.poses + ", so held where the scene has them: " + joined(read->still));
    if (read->largest_rotation_error > 1e-12) {
        subject.notes.push_back(
            formatted("rotations in %s are off by up to %.2g; the nearest rotations were taken, and bounds speak of those",
                      options.poses.c_str(), read->largest_rotation_error));
    }
    const double cut = read->largest_cut, unit_length = subject.model.length_unit;
    if (cut > 1e-6) {
        subject.notes.push_back(
            formatted("between two poses a body's centre of mass goes straight while the body turns (by up to %.3g degrees): of one "
                      "that goes round an axis instead, bounds are of a path up to %.2g %s off; poses twice as often make that a quarter",
                      read->largest_turn.value_or(0) * 180 / M_PI, cut / unit_length, answers::unit_name(unit_length).c_str()));
    }
    return {};
}

std::string joints_note(const Subject& subject, const core::stepper::JointedMotion& followed) {
    const double unit = subject.model.length_unit;
    const std::string name = answers::unit_name(unit);
    std::string note = formatted(
        "--kinematic: joints and motors are met at every node, each step in %d; between nodes joints of the path "
        "as stored part by at most %.2g %s",
        followed.parts, followed.joint_gap / unit, name.c_str());
    if (!subject.joints->joints)
        return note + "; where joints met at all times would have the bodies is not proven: " + subject.joints->refusal;
    const auto& deviations = subject.joints->joints->deviations;
    const auto most = std::max_element(deviations.begin(), deviations.end());
    if (most == deviations.end()) return note;
    const int body = subject.joints->joints->bodies[static_cast<size_t>(most - deviations.begin())];
    return note + formatted(
                      "; bounds are of joints met at all times, which have the bodies within %.2g %s of that path (the most: %s): each "
                      "bound is wider by what its two bodies are off",
                      *most / unit, name.c_str(), subject.model.bodies[static_cast<size_t>(body)].name.c_str());
}

// Where joints and motors have the bodies.
Errors take_joints(const SubjectOptions& options, int steps, Subject& subject) {
    auto followed = core::stepper::follow_joints(subject.model, steps, core::stepper::default_joint_gap(subject.model));
    if (!followed) {
        Errors errors = followed.errors();
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        return errors;
    }
    subject.joints = core::clearance::jointed_path(subject.model, *followed);
    subject.trajectory = std::move(followed->trajectory);
    subject.source = SubjectSource::scripted;
    if (!followed->held.empty())
        subject.notes.push_back("--kinematic: no motor and no script drives these, which are held at their start poses: " +
                                joined(followed->held));
    subject.notes.push_back(joints_note(subject, *followed));
    mark_as_scripted(subject);
    return {};
}

void simulate(int steps, Subject& subject, Console& console) {
    core::stepper::SimulationOptions simulate_options;
    simulate_options.steps = steps;
    simulate_options.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    simulate_options.should_stop = interrupted;
    core::stepper::Simulation simulation = core::stepper::simulate(subject.model, simulate_options);
    subject.trajectory = std::move(simulation.trajectory);
    subject.source = SubjectSource::simulated;
    const std::string status = core::stepper::to_string(simulation.report.status), &why = simulation.report.message;
    if (simulation.report.status != core::stepper::SimulationStatus::ok)
        subject.incomplete = why.empty() || why == status ? status : status + ": " + why;
}

std::vector<std::string> all_paths(const SubjectOptions& options) {
    std::vector<std::string> paths{options.path};
    paths.insert(paths.end(), options.more.begin(), options.more.end());
    return paths;
}

// What goes with meshes, and with them alone.
Errors check_inputs(const SubjectOptions& options, bool meshes) {
    if (meshes && (options.motion || options.kinematic))
        return {{ErrorCode::inconsistent, options.path, "meshes do not move; --poses FILE moves them, or write a scene"}};
    const bool makes_motion = options.motion || options.kinematic;
    if ((options.steps >= 0 || options.time >= 0) && !makes_motion)
        return {
            {ErrorCode::inconsistent, options.steps >= 0 ? "--steps" : "--time",
             "is of a motion that is made here: add --motion or --kinematic (as assembled nothing moves; a trajectory or poses are judged "
             "whole)"}};
    if (meshes) return {};
    if (!options.more.empty())
        return {{ErrorCode::inconsistent, options.more.front(), "several files are judged together only if all are meshes"}};
    const bool is_json = std::filesystem::path(options.path).extension() == ".json";  // of what is none it is told what it is
    if (!options.unit.empty() && is_json) return {{ErrorCode::inconsistent, "--unit", "is of meshes; this file says its own"}};
    return {};
}

Result<LoadedModel> loaded_meshes(const std::vector<std::string>& paths, const std::string& unit, const CommonOptions& common,
                                  Subject& subject) {
    Result<MeshSubject> meshes = load_meshes(paths, unit, common);
    if (!meshes) return meshes.errors();
    subject.files = std::move(meshes->files);
    LoadedModel loaded;
    loaded.kind = FileKind::mesh;
    loaded.model = std::move(meshes->model);
    loaded.warnings = std::move(meshes->warnings);
    return loaded;
}

}  // namespace

const char* to_string(SubjectSource source) {
    switch (source) {
        case SubjectSource::as_assembled:
            return "as assembled";
        case SubjectSource::simulated:
            return "over the simulated motion";
        case SubjectSource::scripted:
            return "over the scripted motion, without dynamics";
        case SubjectSource::poses:
            return "over the poses read";
        case SubjectSource::trajectory:
            return "over the trajectory";
    }
    return "";
}

Result<Subject> load_subject(const SubjectOptions& options, const CommonOptions& common, Console& console) {
    const std::vector<std::string> paths = all_paths(options);
    const bool meshes = are_meshes(paths);
    if (const Errors errors = check_inputs(options, meshes); !errors.empty()) return errors;
    if (!meshes && file_kind(options.path) == FileKind::trajectory) return from_trajectory(options);
    Subject subject;
    Result<LoadedModel> loaded = meshes ? loaded_meshes(paths, options.unit, common, subject) : load_model(options.path, common, false);
    if (!loaded) return loaded.errors();
    tell_warnings(console, loaded->warnings);
    subject.model = std::move(loaded->model);
    subject.scene_path = loaded->scene_path;
    subject.warnings = std::move(loaded->warnings);
    const auto& bodies = subject.model.bodies;
    const bool all_scripted = std::all_of(bodies.begin(), bodies.end(), core::stepper::is_scripted);
    const int steps = options.steps >= 0  ? options.steps
                      : options.time >= 0 ? core::stepper::step_count(options.time, subject.model.timestep)
                                          : loaded->steps;
    if (!options.poses.empty()) {
        const Errors errors = take_poses(options, subject);
        if (!errors.empty()) return errors;
        mark_as_scripted(subject);
    } else if (options.kinematic && !subject.model.mechanism.rows.empty()) {
        Errors errors = take_joints(options, steps, subject);
        if (!errors.empty()) return errors;
    } else if (options.kinematic || (options.motion && all_scripted)) {
        subject.trajectory = core::stepper::follow_scripts(subject.model, steps);
        subject.source = SubjectSource::scripted;
        const auto held = core::stepper::held_bodies(subject.model);
        if (!held.empty()) subject.notes.push_back("--kinematic: what would move freely is held at its start pose: " + joined(held));
        mark_as_scripted(subject);
    } else if (options.motion) {
        // Only what starts apart can be simulated; a report as assembled tells of the rest.
        Errors errors = core::model::check_start(subject.model);
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        if (!errors.empty()) return errors;
        simulate(steps, subject, console);
    } else {
        subject.trajectory = core::clearance::as_assembled(subject.model);
    }
    if (subject.source != SubjectSource::as_assembled && !subject.motion())
        subject.notes.push_back("there is no motion, only a start: judged as assembled");
    return subject;
}

std::vector<core::clearance::PairClearance> certified(const Subject& subject, const std::vector<core::clearance::PairRequest>& pairs,
                                                      const core::clearance::ClearanceOptions& certify) {
    if (!subject.joints) return core::clearance::certify_clearance(subject.model, subject.trajectory, pairs, certify);
    return core::clearance::certify_jointed(subject.model, subject.trajectory, pairs, certify, *subject.joints);
}

double joint_charge(const Subject& subject, int a, int b) {
    if (!subject.joints || !subject.joints->joints) return 0;
    return core::certificate::joint_charge(*subject.joints->joints, a, b);
}

bool judged_by_default(const core::model::Model& model, int a, int b) {
    const auto dynamic = [](const core::model::Body& body) { return body.type == BodyType::dynamic_body; };
    if (std::any_of(model.bodies.begin(), model.bodies.end(), dynamic)) return core::model::may_collide(model, a, b);
    const core::model::Body &first = model.bodies[static_cast<size_t>(a)], &second = model.bodies[static_cast<size_t>(b)];
    if (a == b || (first.group >= 0 && first.group == second.group)) return false;
    const auto& joined_bodies = model.mechanism.not_colliding;
    if (std::binary_search(joined_bodies.begin(), joined_bodies.end(), std::pair<int, int>(std::minmax(a, b)))) return false;
    const auto still = [](const core::model::Body& body) { return body.type == BodyType::static_body; };
    return !still(first) || !still(second) || std::all_of(model.bodies.begin(), model.bodies.end(), still);
}

bool may_push(const Subject& subject, int a, int b) {
    const bool dynamics = subject.source == SubjectSource::simulated || subject.source == SubjectSource::trajectory;
    return dynamics && subject.motion() && core::model::may_collide(subject.model, a, b);
}

}  // namespace fettle::design::cli
