// SPDX-License-Identifier: MIT
/// fettle simulate SCENE: runs a scene, or a design at its values, and writes the trajectory.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/continuation.hpp"
#include "fettle/core/records/poses_file.hpp"
#include "fettle/core/records/step_tables.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::stepper::Simulation;
using core::stepper::SimulationStatus;

struct Options {
    std::string path, out, poses, earlier;
    int steps = -1;
    double time = -1;
};

// Of the file's frame: its origin is at -c in the body's frame.
Json bodies_at_end(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    Json list = Json::array();
    for (size_t i = 0; i < model.bodies.size(); ++i) {
        const core::kinematics::Pose& pose = trajectory.poses.back()[i];
        Json rotation = Json::array();
        for (int row = 0; row < 3; ++row) rotation.push_back(vector_json(pose.rotation.row(row).transpose()));
        list.push_back({{"name", model.bodies[i].name},
                        {"position", vector_json(core::kinematics::world_position(pose, -model.bodies[i].reference_point))},
                        {"rotation", rotation}});
    }
    return list;
}

// Proven for the continuous path, to 1% of what the steps' ends saw; null when no two bodies may touch.
Json certified_minimum(const core::model::Model& model, const Simulation& simulation) {
    double seen = model.dhat;
    for (const auto& step : simulation.report.steps) seen = std::min(seen, step.minimum_distance);
    std::vector<core::clearance::PairRequest> pairs;
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (core::model::may_collide(model, a, b)) pairs.push_back({a, b, 0});
        }
    }
    if (pairs.empty()) return nullptr;
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-2 * seen;
    options.sample_nodes = false;
    double minimum = std::numeric_limits<double>::infinity();
    for (const auto& pair : core::clearance::certify_clearance(model, simulation.trajectory, pairs, options))
        minimum = std::min(minimum, pair.lower);
    return minimum;
}

int exit_code(SimulationStatus status) { return status == SimulationStatus::ok ? exit_done : exit_undecided; }

// With the rows of the run that this one goes on with, if its tables are beside its trajectory.
std::string whole_table(const std::string& name, const std::string& text, const Options& options, const Simulation& earlier) {
    if (options.earlier.empty()) return text;
    const Result<std::string> before = core::files::read_file(std::filesystem::path(options.earlier).parent_path() / name);
    const double until = (earlier.checkpoint.step + 0.5) * earlier.trajectory.timestep;
    return before ? core::records::joined_table(*before, text, until) : text;
}

Errors write_outputs(const Options& options, const core::model::Model& model, const Simulation& simulation, const Simulation& earlier,
                     const std::string& scene_path, const Json& json) {
    const std::filesystem::path folder = options.out;
    // Read before anything is written: the earlier run's folder may be this one.
    std::vector<std::pair<std::string, std::string>> tables;
    const std::vector<std::string> names = body_names(model);
    for (const auto& [name, text] : {std::pair{"steps.csv", core::records::steps_csv(simulation)},
                                     {"contacts.csv", core::records::contacts_csv(simulation, names)},
                                     {"drives.csv", core::records::drives_csv(simulation, names)}})
        tables.emplace_back(name, whole_table(name, text, options, earlier));
    Errors errors =
        core::records::write_trajectory(folder / "trajectory.json", simulation.trajectory, model, scene_path, &simulation.checkpoint);
    if (!errors.empty()) return errors;
    for (const auto& [name, text] : tables) {
        errors = core::files::write_file_atomically(folder / name, text);
        if (!errors.empty()) return errors;
    }
    return core::files::write_file_atomically(folder / "result.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

int run_simulate(const Options& options, const CommonOptions& common, Console& console) {
    const Result<LoadedModel> loaded = load_model(options.path, common);
    if (!loaded) return console.input_errors(loaded.errors());
    tell_warnings(console, loaded->warnings);
    const core::model::Model& model = loaded->model;
    core::stepper::SimulationOptions simulate_options;
    simulate_options.steps = options.steps >= 0  ? options.steps
                             : options.time >= 0 ? static_cast<int>(std::ceil(options.time / model.timestep - 1e-9))
                                                 : loaded->steps;
    simulate_options.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    simulate_options.should_stop = interrupted;
    simulate_options.outputs = !options.out.empty();
    Simulation earlier;
    if (!options.earlier.empty()) {
        const auto stored = core::records::read_trajectory(options.earlier);
        if (!stored) return console.input_errors(stored.errors());
        Result<Simulation> resumed = core::records::resumable(*stored, model);
        if (!resumed) return console.input_errors(resumed.errors());
        earlier = *std::move(resumed);
        simulate_options.resume = &earlier;
        console.narrate("going on from step " + std::to_string(earlier.checkpoint.step));
    }
    const Simulation simulation = core::stepper::simulate(model, simulate_options);
    const core::stepper::SimulationReport& report = simulation.report;
    console.narrate("certifying the path");
    Json json;
    json["status"] = core::stepper::to_string(report.status);
    if (!report.message.empty()) json["message"] = report.message;
    json["steps"] = simulation.trajectory.steps.size();
    json["newton_iterations"] = report.newton_iterations;
    json["wall_seconds"] = report.wall_seconds;
    json["minimum_distance"] = certified_minimum(model, simulation);
    json["bodies"] = bodies_at_end(model, simulation.trajectory);
    json["peak_memory_bytes"] = peak_memory_bytes();
    if (!options.out.empty()) {
        json["out"] = options.out;
        const Errors errors = write_outputs(options, model, simulation, earlier, loaded->scene_path, json);
        if (!errors.empty()) return console.input_errors(errors);
    }
    if (!options.poses.empty()) {
        const Errors errors = core::records::write_poses(options.poses, simulation.trajectory, model, unit_name(model.length_unit));
        if (!errors.empty()) return console.input_errors(errors);
    }
    const bool ok = report.status == SimulationStatus::ok;
    std::string text = formatted("%s after %zu steps, %d Newton iterations, %.3g s\n",
                                 console.coloured(core::stepper::to_string(report.status), ok).c_str(), simulation.trajectory.steps.size(),
                                 report.newton_iterations, report.wall_seconds);
    if (!report.message.empty()) text += report.message + "\n";
    if (json["minimum_distance"].is_number()) {
        text += formatted("smallest distance of two bodies over the path: %.6g m, proven\n", json["minimum_distance"].get<double>());
    }
    if (!options.out.empty()) text += "trajectory: " + (std::filesystem::path(options.out) / "trajectory.json").string() + "\n";
    console.result(json, text);
    return exit_code(report.status);
}

}  // namespace

Command add_simulate(CLI::App& program, const CommonOptions& common) {
    CLI::App* app = program.add_subcommand("simulate", "Runs a scene (or a design at its values) through time");
    auto options = std::make_shared<Options>();
    app->add_option("SCENE", options->path, "Scene or design")->required();
    CLI::Option* steps =
        app->add_option("--steps", options->steps, "How many steps (default: the scene's end time)")->check(CLI::NonNegativeNumber);
    app->add_option("--time", options->time, "How long, in seconds")->check(CLI::NonNegativeNumber)->excludes(steps);
    app->add_option("--out", options->out,
                    "Folder for trajectory.json, result.json and, per step, steps.csv (energies, momenta, least distance), contacts.csv "
                    "(forces between bodies) and drives.csv (what motors and guides supply)");
    app->add_option("--continue", options->earlier, "trajectory.json of an earlier run of this scene: goes on to --steps or --time in all");
    app->add_option("--poses", options->poses, "Write the poses at the ends of the steps for other programs (.csv or .json)");
    app->footer(
        "Example:  fettle simulate examples/slider_crank/slider_crank.scene.json --steps 50 --out out\n"
        "          fettle simulate examples/slider_crank/slider_crank.scene.json --continue out/trajectory.json --steps 100 --out out");
    return {app, [options, &common](Console& console) { return run_simulate(*options, common, console); }};
}

}  // namespace fettle::design::cli
