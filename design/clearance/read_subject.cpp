// SPDX-License-Identifier: MIT
#include "design/clearance/read_subject.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/driven_ranges.hpp"
#include "core/model/start_check.hpp"
#include "core/records/poses_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/scene/step_count.hpp"
#include "core/stepper/branch_warnings.hpp"
#include "core/stepper/jointed_motion.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "core/stepper/simulate.hpp"
#include "design/answers/answer_json.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/problem/toleranced_bodies.hpp"

namespace fettle::design::clearance {

namespace {

using core::base::formatted;
using core::base::joined;
using core::clearance::Domain;
using core::scene::BodyType;

// Bodies that move without dynamics are kinematic, those that do not move are static: whoever reads the stored trajectory then knows.
void mark_as_scripted(Subject& subject) {
    const core::stepper::Trajectory& path = subject.domain.path();
    for (size_t i = 0; i < subject.model.bodies.size(); ++i) {
        bool moves = false;
        for (const auto& step : path.steps) {
            for (const auto& node : step.nodes)
                moves = moves || node[i].rotation_vector != Vector3::Zero() || node[i].position != path.poses[0][i].position;
        }
        subject.model.bodies[i].type = moves ? BodyType::kinematic_body : BodyType::static_body;
    }
}

Result<Subject> from_trajectory(const SubjectOptions& options) {
    if (options.tolerances)
        return Error{ErrorCode::unsupported, options.path, "a trajectory has no tolerances: --tolerances wants a design that has some"};
    if (options.ranges) return Error{ErrorCode::unsupported, options.path, "a trajectory has no joints: --ranges wants a scene or design"};
    if (!options.poses.empty() || options.kinematic)
        return Error{ErrorCode::inconsistent, options.path,
                     "a trajectory has its motion; --poses and --kinematic go with a scene or design"};
    Result<core::records::StoredTrajectory> stored = core::records::read_trajectory(options.path);
    if (!stored) return stored.errors();
    Subject subject;
    subject.model = std::move(stored->model);
    subject.domain = Domain(std::move(stored->trajectory));
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
    subject.domain = Domain(std::move(read->trajectory));
    subject.source = SubjectSource::poses;
    for (size_t i = 0; i < subject.model.bodies.size(); ++i) subject.model.bodies[i].pose_start = subject.domain.path().poses[0][i];
    if (!read->still.empty())
        subject.notes.push_back("not in " + options.poses + ", so held where the scene has them: " + joined(read->still));
    if (read->largest_rotation_error > 1e-12) {
        subject.notes.push_back(
            formatted("rotations in %s are off by up to %.2g; the nearest rotations are used, and bounds hold for those",
                      options.poses.c_str(), read->largest_rotation_error));
    }
    const double cut = read->largest_cut, unit_length = subject.model.length_unit;
    if (cut > 1e-6) {
        subject.notes.push_back(
            formatted("between two poses a body's centre of mass goes straight while the body turns (by up to %.3g degrees): for one that "
                      "goes round an axis instead, bounds hold for a path up to %.2g %s off; poses twice as often make that a quarter",
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
    const core::clearance::JointedPath& path = *subject.domain.joints();
    if (!path.joints) return note + "; where the bodies are if joints are met at all times is not proven: " + path.refusal;
    const auto& deviations = path.joints->deviations;
    const auto most = std::max_element(deviations.begin(), deviations.end());
    if (most == deviations.end()) return note;
    const int body = path.joints->bodies[most - deviations.begin()];
    return note + formatted(
                      "; bounds hold for joints met at all times, which keep the bodies within %.2g %s of that path (farthest: %s): each "
                      "bound is wider by the distances of its two bodies from it",
                      *most / unit, name.c_str(), subject.model.bodies[body].name.c_str());
}

// Where joints and motors have the bodies.
Errors take_joints(const SubjectOptions& options, int steps, Subject& subject) {
    auto followed = core::stepper::follow_joints(subject.model, steps, core::stepper::default_joint_gap(subject.model));
    if (!followed) {
        Errors errors = followed.errors();
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        return errors;
    }
    core::clearance::JointedPath joints = core::clearance::jointed_path(subject.model, *followed);
    subject.domain = Domain(std::move(followed->trajectory), std::move(joints));
    subject.source = SubjectSource::scripted;
    if (!followed->held.empty())
        subject.notes.push_back("--kinematic: no motor and no script drives these, which are held at their start poses: " +
                                joined(followed->held));
    subject.notes.push_back(joints_note(subject, *followed));
    mark_as_scripted(subject);
    return {};
}

// A motion that passes a dead centre is one of two.
void warn_of_branches(const SubjectWatch& watch, Subject& subject) {
    const std::vector<std::string> found = core::stepper::branch_warnings(subject.model, subject.domain.path());
    if (watch.on_warnings && !found.empty()) watch.on_warnings(found);
    subject.warnings.insert(subject.warnings.end(), found.begin(), found.end());
}

void simulate(int steps, const SubjectWatch& watch, Subject& subject) {
    core::stepper::SimulationOptions simulate_options;
    simulate_options.steps = steps;
    simulate_options.on_step = watch.on_step;
    simulate_options.should_stop = watch.should_stop;
    core::stepper::Simulation simulation = core::stepper::simulate(subject.model, simulate_options);
    subject.domain = Domain(std::move(simulation.trajectory));
    subject.source = SubjectSource::simulated;
    const std::string status = core::stepper::to_string(simulation.report.status), &why = simulation.report.message;
    if (simulation.report.status != core::stepper::SimulationStatus::ok)
        subject.incomplete = why.empty() || why == status ? status : status + ": " + why;
}

// The subject of a scene or design whose joints have ranges.
Result<Subject> from_ranges(const SubjectOptions& options, reading::LoadedModel& loaded) {
    Result<Subject> subject = subject_over_joints(std::move(loaded.model));
    if (subject) return subject;
    Errors errors = subject.errors();
    for (Error& error : errors) error.where = options.path + ": " + error.where;
    return errors;
}

// What is said of one scenario is not said of the others.
void tell_other_scenarios(const description::Design& design, int scenario, Subject& subject) {
    std::vector<std::string> others;
    for (int k = 0; k < count_of(design.scenarios); ++k)
        if (k != scenario) others.push_back("`" + design.scenarios[k].name + "`");
    if (!others.empty())
        subject.notes.push_back("this is about the scenario `" + design.scenarios[scenario].name +
                                "` alone; not looked at: " + joined(others) + " (--scenario)");
}

std::vector<std::string> notes_of_tolerances(const core::certificate::Toleranced& toleranced) {
    std::vector<std::string> notes{"within tolerances: bounds hold for every combination of " +
                                   core::base::counted(toleranced.deviations.size(), "deviation") +
                                   ", each anywhere between its limits, and for parts with the facets of the design"};
    const auto is_driven = [](const core::certificate::TolerancedBody& body) {
        return std::any_of(body.screws.begin(), body.screws.end(), [](const auto& screw) { return screw.driven.has_value(); });
    };
    if (std::any_of(toleranced.bodies.begin(), toleranced.bodies.end(), is_driven))
        notes.emplace_back(
            "how far motors or scripts go deviates; a position where a pair is worst is told as they have it as designed, and looked at as "
            "made");
    std::vector<std::string> shifted;
    for (const core::certificate::Deviation& d : toleranced.deviations)
        if (d.base != 0) shifted.push_back(d.of);
    if (!shifted.empty()) notes.push_back("0 is not within their limits, so meshes are those of the middle: " + joined(shifted));
    return notes;
}

Result<int> steps_of(const SubjectOptions& options, const core::model::Model& model, int own) {
    if (options.steps >= 0 || !(options.time >= 0)) return options.steps >= 0 ? options.steps : own;
    Result<int> steps = core::scene::step_count(options.time, model.timestep);
    return steps ? steps : Error{ErrorCode::out_of_range, "--time", steps.errors().front().message};
}

// The duration of a motion without dynamics [s].
double duration_of(const SubjectOptions& options, const core::model::Model& model, int design_steps) {
    if (options.time >= 0) return options.time;
    if (options.steps < 0 && model.end_time > 0) return model.end_time;
    const int steps = options.steps >= 0 ? options.steps : design_steps > 0 ? design_steps : core::scene::default_step_count;
    return steps * model.timestep;
}

bool is_carried(const core::certificate::Linkage& linkage, int body) {
    for (int at = body; at >= 0; at = linkage.bodies[at].parent)
        if (!linkage.bodies[at].screws.empty()) return true;
    return false;
}

// What bodies that joints hold are looked at over; nothing: trees as assembled.
Result<std::optional<core::clearance::LoopedRanges>> positions_of(const SubjectOptions& options, const core::model::Model& model,
                                                                  double duration) {
    using Positions = std::optional<core::clearance::LoopedRanges>;
    if (!options.ranges && !options.kinematic && !core::clearance::closes_loops(model)) return Positions{};
    if (options.kinematic && !(duration > 0)) return Error{ErrorCode::out_of_range, "--time", "more than 0 s is expected"};
    Result<core::clearance::LoopedRanges> found =
        options.kinematic ? core::clearance::driven_ranges(model, duration) : core::clearance::looped_ranges(model, !options.ranges);
    if (!found) return found.errors();
    return Positions{*std::move(found)};
}

// @param positions  nothing: as assembled, where the coordinates are there and have no range
Subject subject_as_made(const SubjectOptions& options, core::model::Model model,
                        const std::optional<core::clearance::LoopedRanges>& positions, core::certificate::Toleranced made) {
    core::clearance::JointRanges ranges;
    if (options.ranges || options.kinematic)
        ranges = positions->ranges;
    else
        ranges.linkage.coordinates = made.coordinates;
    const double duration = made.duration;
    const bool has_loops = !made.loops.empty();
    core::stepper::Trajectory start = core::clearance::as_assembled(model);
    Domain tree(std::move(start), std::move(ranges), std::move(made));
    if (options.ranges) return subject_over(std::move(model), std::move(tree));
    Subject subject;
    subject.model = std::move(model);
    subject.domain = std::move(tree);
    if (!options.kinematic) return subject;
    if (has_loops) subject.notes.emplace_back(follow_note);
    subject.source = SubjectSource::prescribed;
    const core::clearance::JointRanges& driven = *subject.domain.ranges();
    for (size_t i = 0; i < subject.model.bodies.size(); ++i)
        subject.model.bodies[i].type = is_carried(driven.linkage, static_cast<int>(i)) ? BodyType::kinematic_body : BodyType::static_body;
    subject.notes.push_back(core::base::formatted("for %.6g s from the start", duration));
    if (!driven.held.empty())
        subject.notes.push_back("--kinematic: these would move freely and are held at their start pose: " + joined(driven.held));
    return subject;
}

// The design as made, over its tolerances.
Result<Subject> from_tolerances(const SubjectOptions& options, const reading::InputOptions& input, reading::FileKind kind,
                                const SubjectWatch& watch) {
    const auto with_file = [&](Errors errors) {
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        return errors;
    };
    if (kind != reading::FileKind::design)
        return Error{ErrorCode::unsupported, options.path,
                     "--tolerances wants a design that has `tolerances` (docs/interface.md); a scene alone has none"};
    if (options.motion || !options.poses.empty())
        return Error{
            ErrorCode::unsupported, "--tolerances",
            "goes as assembled, with --ranges or with --kinematic: over a motion that depends on the parts nothing can be proven of "
            "all of them"};
    reading::DesignReadOptions read{.mesh_dirs = input.mesh_dirs, .programs = input.programs, .as_made = true};
    read.process = options.process;
    Result<reading::DesignFile> file = reading::read_design(options.path, read);
    if (!file) return file.errors();
    if (watch.on_warnings) watch.on_warnings(file->warnings);
    if (file->tolerances.empty())
        return Error{
            ErrorCode::missing_key, options.path,
            "it has no `tolerances`: say, for instance, \"tolerances\": {\"pin_radius\": \"+-0.05 mm\"}, by names of parameters or "
            "of the scene's variables, or by places (\"/bodies/pin/shape/dimensions/radius\")"};
    const Result<int> scenario = reading::scenario_of(file->design, input.scenario, options.path);
    if (!scenario) return scenario.errors();
    const Result<problem::DesignProblem> problem = problem::DesignProblem::create(file->design);
    if (!problem) return problem.errors();
    const description::Design& design = problem->design();
    const VectorX base = description::with_deviations(design, file->tolerances, problem::base_of(file->tolerances));
    Result<core::model::Model> model = problem->model_at(base, *scenario);
    if (!model) return model.errors();
    const double duration = options.kinematic ? duration_of(options, *model, problem->steps(*scenario)) : 0;
    const Result<std::optional<core::clearance::LoopedRanges>> positions = positions_of(options, *model, duration);
    if (!positions) return with_file(positions.errors());
    Result<core::certificate::Toleranced> toleranced =
        problem::toleranced_bodies(description::design_of_scenario(design, *scenario), file->tolerances, *model, *positions);
    if (!toleranced) return with_file(toleranced.errors());
    toleranced->duration = duration;
    std::vector<std::string> notes = notes_of_tolerances(*toleranced);
    Subject subject = subject_as_made(options, *std::move(model), *positions, *std::move(toleranced));
    subject.notes.insert(subject.notes.begin(), notes.begin(), notes.end());
    tell_other_scenarios(design, *scenario, subject);
    subject.scene_path = file->scene_path;
    subject.warnings = file->warnings;
    subject.wanted = design_pairs(design);
    subject.required = design_minima(design, *scenario,
                                     options.ranges      ? MinimumOver::ranges
                                     : options.kinematic ? MinimumOver::motion
                                                         : MinimumOver::assembly);
    return subject;
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
             "needs a motion that is made here: add --motion or --kinematic (as assembled nothing moves; a trajectory or poses are judged "
             "whole)"}};
    if (options.ranges && !options.more.empty())
        return {{ErrorCode::inconsistent, "--ranges", "needs one scene or design: meshes have no joints"}};
    if (meshes) return {};
    if (!options.more.empty())
        return {{ErrorCode::inconsistent, options.more.front(), "several files are judged together only if all are meshes"}};
    const bool is_json = std::filesystem::path(options.path).extension() == ".json";  // a file of another kind is told what it is
    if (!options.unit.empty() && is_json) return {{ErrorCode::inconsistent, "--unit", "is for meshes; this file states its own unit"}};
    if (options.split) return {{ErrorCode::inconsistent, "--split", "is for meshes; in a scene a body has \"split_components\": true"}};
    if (!options.step.facets.empty())
        return {{ErrorCode::inconsistent, "--facets", "is for STEP files; in a scene a body has \"mesh_facets\""}};
    if (!options.step.surface_tolerance.empty())
        return {{ErrorCode::inconsistent, "--surface-tolerance", "is for STEP files; in a scene a body has \"surface_tolerance\""}};
    return {};
}

Result<reading::LoadedModel> loaded_meshes(const std::vector<std::string>& paths, const SubjectOptions& options,
                                           const reading::InputOptions& input, Subject& subject) {
    Result<MeshParts> meshes = load_meshes(paths, options.unit, input, options.split, options.step);
    if (!meshes) return meshes.errors();
    subject.files = std::move(meshes->files);
    reading::LoadedModel loaded;
    loaded.kind = reading::FileKind::mesh;
    loaded.model = std::move(meshes->model);
    loaded.warnings = std::move(meshes->warnings);
    return loaded;
}

}  // namespace

Result<Subject> read_subject(const SubjectOptions& options, const reading::InputOptions& input, const SubjectWatch& watch) {
    const std::vector<std::string> paths = all_paths(options);
    std::error_code ignored;
    if (options.ranges && options.more.empty() && std::filesystem::is_directory(options.path, ignored))
        return Error{ErrorCode::unsupported, options.path, "is a folder: --ranges wants a scene or design, whose joints have ranges"};
    const bool meshes = are_meshes(paths) && !(options.ranges && options.more.empty());
    if (const Errors errors = check_inputs(options, meshes); !errors.empty()) return errors;
    const reading::FileKind kind = meshes ? reading::FileKind::mesh : reading::file_kind(options.path);
    if (kind == reading::FileKind::trajectory) return from_trajectory(options);
    if (options.tolerances) return from_tolerances(options, input, kind, watch);
    Subject subject;
    reading::InputOptions any_start = input;
    any_start.check_start = false;
    Result<reading::LoadedModel> loaded =
        meshes ? loaded_meshes(paths, options, input, subject) : reading::load_model(options.path, kind, any_start);
    if (!loaded) return loaded.errors();
    if (watch.on_warnings) watch.on_warnings(loaded->warnings);
    if (options.ranges) {
        Result<Subject> over = from_ranges(options, *loaded);
        if (!over) return over;
        subject = *std::move(over);
    } else {
        subject.model = std::move(loaded->model);
    }
    subject.warnings = std::move(loaded->warnings);
    subject.scene_path = loaded->scene_path;
    if (loaded->problem != nullptr) {
        const description::Design& design = loaded->problem->design();
        const int scenario = reading::scenario_of(design, input.scenario, options.path).value();
        tell_other_scenarios(design, scenario, subject);
        subject.wanted = design_pairs(design);
        const bool moves = options.motion || options.kinematic || !options.poses.empty();
        subject.required = design_minima(design, scenario,
                                         options.ranges ? MinimumOver::ranges
                                         : moves        ? MinimumOver::motion
                                                        : MinimumOver::assembly);
    }
    if (subject.domain.is_tree()) return subject;
    const auto& bodies = subject.model.bodies;
    const bool all_scripted = std::all_of(bodies.begin(), bodies.end(), core::stepper::is_scripted);
    const Result<int> steps = steps_of(options, subject.model, loaded->steps);
    if (!steps) return steps.errors();
    if (!options.poses.empty()) {
        const Errors errors = take_poses(options, subject);
        if (!errors.empty()) return errors;
        mark_as_scripted(subject);
    } else if (options.kinematic && !subject.model.mechanism.rows.empty()) {
        Errors errors = take_joints(options, *steps, subject);
        if (!errors.empty()) return errors;
        warn_of_branches(watch, subject);
    } else if (options.kinematic || (options.motion && all_scripted)) {
        subject.domain = Domain(core::stepper::follow_scripts(subject.model, *steps));
        subject.source = SubjectSource::scripted;
        const auto held = core::stepper::held_bodies(subject.model);
        if (!held.empty())
            subject.notes.push_back("--kinematic: these would move freely and are held at their start pose: " + joined(held));
        mark_as_scripted(subject);
    } else if (options.motion) {
        // Only what starts apart can be simulated; a report as assembled tells of the rest.
        Errors errors = core::model::check_start(subject.model);
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        if (!errors.empty()) return errors;
        simulate(*steps, watch, subject);
        warn_of_branches(watch, subject);
    } else {
        subject.domain = core::clearance::as_started(subject.model);
    }
    if (subject.source != SubjectSource::as_assembled && !subject.motion())
        subject.notes.push_back("there is no motion, only a start: judged as assembled");
    return subject;
}

}  // namespace fettle::design::clearance
