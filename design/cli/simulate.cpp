// SPDX-License-Identifier: MIT
/// fettle simulate SCENE: runs a scene, or a design at its values, and writes the trajectory.
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/rounded_lengths.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/part_files/part_file.hpp"
#include "core/records/continuation.hpp"
#include "core/records/poses_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/scene/step_count.hpp"
#include "core/stepper/balance.hpp"
#include "core/stepper/branch_warnings.hpp"
#include "core/stepper/simulate.hpp"
#include "core/stepper/split_path.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/growing_tables.hpp"
#include "design/answers/growing_trajectory.hpp"
#include "design/answers/made_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/answers/run_folder.hpp"
#include "design/answers/simulate_json.hpp"
#include "design/answers/travels.hpp"
#include "design/clearance/left_out.hpp"
#include "design/clearance/path_proof.hpp"
#include "design/clearance/report_json.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/report_made.hpp"
#include "design/studies/made_sample.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::base::RoundedLengths;
using core::base::Towards;
using core::stepper::Simulation;
using core::stepper::SimulationStatus;

struct SimulateArguments {
    std::string path, out, poses, earlier, joint_gap;
    int steps = -1;
    double time = -1;
    bool no_report = false;
    int made = -1;  // sample of the design's tolerances; none
    int seed = 1;
    std::string process, samples_file;
};

// What is simulated: the file as it stands, or a sample of its tolerances.
Result<LoadedModel> load_subject(const SimulateArguments& options, const CommonOptions& common, Json& json, std::string& told) {
    if (options.path.ends_with(core::part_files::part_file_ending))
        return core::base::Error{
            ErrorCode::unsupported, options.path,
            "this is a part, which nothing moves: `fettle validate` and `fettle draw` take it; `fettle simulate` takes "
            "a scene, in which it is the shape of a body"};
    if (options.made < 0) return load_model(options.path, common);
    begin_to_read(options.path);
    Result<studies::MadeMechanism> made =
        studies::load_made(options.path, input_options(common),
                           {options.made, static_cast<std::uint64_t>(options.seed), options.samples_file, options.process});
    if (!made) return made.errors();
    json["made"] = answers::made_json(*made, options.made);
    told = answers::made_text(*made, options.made);
    return std::move(made->loaded);
}

// @param warns  not where the answer's own message says it.
void add_balance(const core::model::Model& model, const core::stepper::Balance& balance, const std::string& file, bool warns, Json& json,
                 Console& console) {
    json["balance"] = answers::balance_json(balance);
    const std::string warning = balance_warning(model, balance);
    if (warning.empty() || !warns) return;
    tell_warnings(console, {warning}, file);
    json["warnings"].push_back(warning);
}

// A line of the answer.
std::string balance_text(const core::stepper::Balance& b) {
    std::string text = formatted("energy: %.4g J at the start, %.4g J at the end; %.4g J supplied, %.4g J lost by friction and dampers",
                                 b.energy_start, b.energy_end, b.work, b.dissipated);
    if (std::abs(b.energy_error) <= b.energy_rounding)
        text += "; the time integration kept it to rounding";
    else
        text +=
            formatted("; %.4g J %s by the time integration (%s of what was there or was supplied)", std::abs(b.energy_error),
                      b.energy_error > 0 ? "gained" : "lost", core::base::percent(std::abs(b.energy_error) / b.energy_available).c_str());
    return text + "\n";
}

// Adds nodes to the path until joints hold between them as well as is asked for. @return what of that could not be done; empty: all.
std::string hold_joints(const std::string& allowed, const core::model::Model& model, Simulation& simulation, Json& json) {
    if (allowed.empty()) return {};
    const core::stepper::SplitPath split =
        core::stepper::split_at_joints(model, *core::base::parse_length(allowed, "--joint-gap"), simulation.trajectory);
    json["nodes_added"] = split.added;
    for (core::stepper::StepReport& step : simulation.report.steps) step.path_joint_gap = std::min(step.path_joint_gap, split.left.gap);
    return split.refusal;
}

// With --out: what is written while the motion grows.
struct Writing {
    Writing(const SimulateArguments& options, const LoadedModel& loaded)
        : trajectory(options.out, loaded.model, loaded.scene_path, options.earlier), tables(options.out, loaded.model) {
        if (!options.no_report && options.earlier.empty()) steps.emplace(loaded.model, report::linear_motors(loaded.model));
    }

    void add(const Simulation& so_far, const core::model::Model& model) {
        tables.write(so_far);
        if (steps) steps->add(so_far.outputs.back(), model);
    }

    answers::GrowingTrajectory trajectory;
    answers::GrowingTables tables;
    std::optional<report::StepCurves> steps;  // for the report; none of a run that goes on: tables have what was before
};

struct FinishedRun {
    const LoadedModel& loaded;
    const std::string& about;         // what the answer begins with
    Simulation& simulation;           // nodes may be added to its path
    const Simulation& earlier;        // that it went on with
    std::optional<Writing>& writing;  // with --out
    clearance::PathProver& prover;    // has followed the motion, unless nodes are to be added to it
};

// All of it beside what the folder holds of an earlier run, which may be the one that this run goes on with.
Errors add_motion(const SimulateArguments& options, const FinishedRun& run, core::files::FilesTogether& files, Console& console) {
    const std::filesystem::path file = std::filesystem::path(options.out) / "trajectory.json";
    const Simulation& simulation = run.simulation;
    const core::model::Model& model = run.loaded.model;
    const std::string kept = answers::name_for_longer_run(file, simulation.trajectory.steps.size());
    if (!kept.empty()) {
        console.narrate("warning: a longer run was there, which is kept as " + kept);
        files.keep_as(file, kept);
    }
    answers::replace_motion(files, options.out);  // what is there is about another motion
    Errors errors = core::records::add_trajectory(files, file, simulation.trajectory, model, run.loaded.scene_path, &simulation.checkpoint);
    if (errors.empty()) errors = run.writing->tables.add_to(files);
    if (errors.empty()) errors = answers::add_animation(files, options.out, model, simulation.trajectory);
    return errors;
}

// Reads the run to go on with. Errors: not a run of this scene, or one that has got further already.
Result<Simulation> read_earlier(const SimulateArguments& options, const core::model::Model& model, int steps, Console& console) {
    const auto stored = core::records::read_trajectory(options.earlier);
    if (!stored) return stored.errors();
    tell_warnings(console, stored->warnings, options.earlier);
    const std::size_t done = stored->trajectory.steps.size();
    if (steps >= 0 && static_cast<std::size_t>(steps) < done)
        return Error{ErrorCode::out_of_range, options.earlier,
                     "this run has " + core::base::counted(done, "step") + " already, and goes on to no fewer: " + std::to_string(steps) +
                         " are asked for"};
    Result<Simulation> resumed = core::records::resumable(*stored, model);
    if (resumed) console.narrate("going on from step " + std::to_string(resumed->checkpoint.step));
    return resumed;
}

Errors try_outputs(const SimulateArguments& options) {
    Errors errors = options.out.empty() ? Errors{} : answers::try_run_folder(options.out, {answers::running_file});
    if (errors.empty() && !options.poses.empty()) errors = answers::try_output_file(options.poses);
    return errors;
}

// "ok" is said of a path that is proven.
struct Outcome {
    std::string status, message;
    int exit_code = exit_undecided;
};

Outcome outcome_of(const core::stepper::SimulationReport& report, const clearance::PathProof& proof) {
    if (report.status != SimulationStatus::ok) return {core::stepper::to_string(report.status), report.message, exit_undecided};
    switch (proof.state) {
        case clearance::ProofState::proven:
        case clearance::ProofState::nothing:
            return {"ok", "", exit_done};
        case clearance::ProofState::surfaces:
            return {"ok", "no two surfaces pass through each other, which is proven; " + proof.reason, exit_done};
        case clearance::ProofState::stopped:
            return {"interrupted", "every step was simulated; " + proof.reason, exit_undecided};
        case clearance::ProofState::not_certified:
            break;
    }
    return {"not_certified", "every step was solved, but the path is not proven: " + proof.reason, exit_undecided};
}

std::string answer_text(const Outcome& outcome, const Simulation& simulation, const clearance::PathProof& proof, const std::string& out,
                        const core::model::Model& model, const Console& console) {
    const RoundedLengths lengths(answers::unit_name(model.length_unit));
    const auto proven = [&](double distance) {
        return "at least " + lengths.fixed(distance, Towards::down) + " " + lengths.unit() + ", proven\n";
    };
    std::string text =
        console.coloured(outcome.status, outcome.exit_code == exit_done) + " after " +
        core::base::counted(simulation.trajectory.steps.size(), "step") +
        formatted(", %d iterations of the solver, %.3g s\n", simulation.report.newton_iterations, simulation.report.wall_seconds);
    if (!outcome.message.empty()) text += outcome.message + "\n";
    if (proof.state == clearance::ProofState::nothing) {
        text += "smallest distance: none, no two bodies may collide\n";
    } else if (proof.state == clearance::ProofState::proven) {
        text += "smallest distance of two bodies over the path: " + proven(*proof.lower);
    } else if (proof.state == clearance::ProofState::surfaces) {
        text += "smallest distance of two surfaces over the path: " + proven(*proof.lower);
    } else {
        text += "smallest distance of two bodies over the path: not certified\n";
        if (proof.state == clearance::ProofState::stopped && proof.lower)
            text += "smallest distance of two bodies over the first " + core::base::counted(static_cast<size_t>(proof.steps), "step") +
                    ": " + proven(*proof.lower);
    }
    text += clearance::left_out_text(clearance::left_out_of_contact(model));
    if (!simulation.trajectory.steps.empty()) text += answers::travels_text(model, answers::travels(model, simulation.trajectory)) + "\n";
    if (!out.empty()) text += "trajectory: " + (std::filesystem::path(out) / "trajectory.json").string() + "\n";
    return text;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Once the motion is there: proves what is left of its path, writes all and answers. Until then the growing file has what was simulated.
int finish(const SimulateArguments& options, const CommonOptions& common, const FinishedRun& run, Json json, Console& console) {
    Simulation& simulation = run.simulation;
    const Simulation& earlier = run.earlier;
    const core::model::Model& model = run.loaded.model;
    const std::string loose = hold_joints(options.joint_gap, model, simulation, json);
    // Stopped before it got as far as the run that it goes on with: that run stays.
    const bool writes_out = !options.out.empty() && simulation.trajectory.steps.size() >= earlier.trajectory.steps.size();
    if (!options.out.empty() && !writes_out)
        console.narrate("warning: nothing is written to " + options.out + ": " + options.earlier + " has more steps");
    console.narrate("certifying the path");
    const clearance::PathProof proof = run.prover.finish(simulation);
    Outcome outcome = outcome_of(simulation.report, proof);
    if (outcome.status == "ok" && !loose.empty()) outcome = {"joints_part", loose, exit_undecided};
    json["status"] = outcome.status;
    if (!outcome.message.empty()) json["message"] = outcome.message;
    json.update(answers::run_json(simulation));
    json.update(clearance::proof_json(proof, run.prover.seconds()));
    json["left_out"] = clearance::left_out_json(clearance::left_out_of_contact(model));
    answers::add_end(model, simulation, json);
    json["moved"] = answers::travels_text(model, answers::travels(model, simulation.trajectory));
    json["peak_memory_bytes"] = peak_memory_bytes();
    if (!options.poses.empty())
        console.unwritten(core::records::write_poses(options.poses, simulation.trajectory, model, answers::unit_name(model.length_unit)));
    const std::optional<core::stepper::Balance>& balance = simulation.balance;
    if (balance) add_balance(model, *balance, options.path, outcome.status != to_string(SimulationStatus::energy_gained), json, console);
    for (const std::string& warning : core::stepper::branch_warnings(model, simulation.trajectory)) {
        tell_warnings(console, {warning}, options.path);
        json["warnings"].push_back(warning);
    }
    bool written = false;
    if (writes_out) {
        json["out"] = options.out;
        core::files::FilesTogether files;
        Errors errors = add_motion(options, run, files, console);
        if (errors.empty()) errors = answers::add_result(files, options.out, json, common.command);
        if (errors.empty()) errors = files.take_names();
        console.unwritten(errors);
        written = errors.empty();
    }
    std::string told = run.about + answer_text(outcome, simulation, proof, written ? options.out : "", model, console);
    if (balance) told += balance_text(*balance);
    if (run.writing && (written || !writes_out)) run.writing->trajectory.remove();
    if (written && !options.no_report)
        leave_report(options.out, common, console, json, told,
                     {.motion = report::Motion{model, std::move(simulation.trajectory), run.loaded.scene_path},
                      .steps = std::move(run.writing->steps)});
    const CheckOutcome checked = outcome.exit_code == exit_done ? CheckOutcome::passed : CheckOutcome::undecided;
    console.found({"the motion is simulated and proven", checked, outcome.status, outcome.message, options.path});
    console.result(json, told);
    return outcome.exit_code;
}

int run_simulate(SimulateArguments options, const CommonOptions& common, Console& console) {
    options.earlier = answers::run_to_continue(options.earlier);
    const auto begin = std::chrono::steady_clock::now();
    Json json;
    json["status"] = "";
    std::string about;
    Result<LoadedModel> loaded = load_subject(options, common, json, about);
    if (!loaded) return console.input_errors(loaded.errors());
    const core::model::Model& model = loaded->model;
    tell_warnings(console, loaded->warnings, options.path);
    core::stepper::SimulationOptions simulate_options;
    simulate_options.steps = options.steps >= 0 ? options.steps : loaded->steps;
    if (options.time >= 0) {
        const Result<int> steps = core::scene::step_count(options.time, model.timestep);
        if (!steps) return console.input_errors({{ErrorCode::out_of_range, "--time", steps.errors().front().message}});
        simulate_options.steps = *steps;
    }
    std::optional<Writing> writing;
    clearance::PathProver prover(model, interrupted);
    const bool adds_nodes = !options.joint_gap.empty();  // the path is another one then
    simulate_options.on_step = [&](const core::stepper::Progress& p) {
        if (writing) {
            const std::string fault = writing->trajectory.write(*p.so_far);
            if (!fault.empty()) console.narrate("warning: " + fault + "; a run that is killed from here on leaves less");
            writing->add(*p.so_far, model);
        }
        if (!adds_nodes) prover.follow(*p.so_far);
        console.progress("simulating", p.step, p.steps);
    };
    simulate_options.should_stop = interrupted;
    simulate_options.outputs = simulate_options.last_outputs_only = true;  // the tables have those before
    Simulation earlier;
    if (!options.earlier.empty()) {
        Result<Simulation> read = read_earlier(options, model, core::stepper::step_count(model, simulate_options), console);
        if (!read) return console.input_errors(read.errors());
        earlier = *std::move(read);
        simulate_options.resume = &earlier;
    }
    if (!options.joint_gap.empty()) {
        const Result<double> gap = core::base::parse_length(options.joint_gap, "--joint-gap");
        if (!gap) return console.input_errors(gap.errors());
        if (!(*gap > 0)) return console.input_errors({{ErrorCode::out_of_range, "--joint-gap", "a length greater than 0 is expected"}});
    }
    const Errors unwritable = try_outputs(options);
    if (!unwritable.empty()) return console.input_errors(unwritable);
    json["start_seconds"] = seconds_since(begin);
    if (!loaded->warnings.empty()) json["warnings"] = loaded->warnings;
    if (!options.out.empty()) writing.emplace(options, *loaded);
    if (writing && !options.earlier.empty())
        writing->tables.go_on_with(options.earlier, (earlier.checkpoint.step + 0.5) * earlier.trajectory.timestep);
    Simulation simulation = core::stepper::simulate(model, simulate_options);
    simulation.report.wall_seconds -= prover.seconds();
    return finish(options, common, {*loaded, about, simulation, earlier, writing, prover}, std::move(json), console);
}

}  // namespace

Command add_simulate(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("simulate", "Runs a scene (or a design at its values) through time");
    auto options = std::make_shared<SimulateArguments>();
    app.option("SCENE", options->path, "Scene or design").required();
    Option steps = app.option("--steps", options->steps, "Number of steps (default: up to the scene's end time)").at_least(0);
    app.option("--time", options->time, "How long, in seconds").at_least(0).excludes(steps);
    app.option("--out", options->out,
               "Folder for trajectory.json, result.json and, per step, steps.csv (energies, momenta, least distance), contacts.csv "
               "(forces between bodies), drives.csv (what motors and guides supply); motion.glb and report.html; while it runs, "
               "trajectory.running.json");
    app.flag("--no-report", options->no_report, "With --out: no report.html");
    app.option("--continue", options->earlier,
               "An earlier run of this scene, its trajectory or its folder (also of a killed run); goes on to --steps or --time in all");
    app.option("--poses", options->poses, "Write the poses at the ends of the steps for other programs (.csv or .json)");
    app.option("--joint-gap", options->joint_gap,
               "Largest distance by which joints may part between nodes, with its unit: 0.01mm (adds nodes; default: any gap)");
    Option made = app.option("--made", options->made,
                             "Of a design with `tolerances`: sample number K of fettle tolerance, as made, in place of the design as drawn")
                      .at_least(0);
    Option seed = app.option("--seed", options->seed, "With --made: that fettle tolerance had (default 1)").at_least(0).needs(made);
    app.option("--samples-file", options->samples_file,
               "With --made: the file that fettle tolerance kept its samples in, whose seed is taken; the answer tells what it has of K")
        .needs(made)
        .excludes(seed);
    app.option("--process", options->process, "With --made: that fettle tolerance had").needs(made);
    app.closing_words(
        "Example:  fettle simulate examples/slider_crank/slider_crank.scene.json --steps 50 --out out\n"
        "          fettle simulate examples/slider_crank/slider_crank.scene.json --continue out/trajectory.json --steps 100 --out out\n"
        "          fettle simulate examples/slider_crank/robust.design.json --made 17 --out out_17");
    return {app, [options, &common](Console& console) { return run_simulate(*options, common, console); }};
}

}  // namespace fettle::design::cli
