// SPDX-License-Identifier: MIT
/// fettle clearance FILE --minimum L: certified distances of pairs of bodies, as assembled or over the motion.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fettle/core/base/units.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/scene/nearest_word.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/core/stepper/trajectory_io.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
    std::string path, minimum, pairs, tolerance = "0.001mm";
    bool motion = false;
};

struct Subject {
    core::model::Model model;
    core::stepper::Trajectory trajectory;
    bool motion = false;
    std::string not_simulated;  ///< why the motion is not whole; empty: it is, or none was asked for
};

Result<int> find_body(const core::model::Model& model, const std::string& name) {
    std::vector<std::string_view> known;
    for (size_t i = 0; i < model.bodies.size(); ++i) {
        if (model.bodies[i].name == name) return static_cast<int>(i);
        known.push_back(model.bodies[i].name);
    }
    std::string message = "there is no body \"" + name + "\"";
    if (const auto nearest = core::scene::nearest_word(name, known)) {
        message += "; did you mean \"" + *nearest + "\"?";
    } else {
        message += "; there are";
        for (size_t i = 0; i < known.size(); ++i) message += (i ? ", " : " ") + std::string(known[i]);
    }
    return Error{ErrorCode::out_of_range, "--pairs", message};
}

// "a:b,c:d"; empty: every pair that may collide.
Result<std::vector<core::clearance::PairRequest>> requested_pairs(const core::model::Model& model, const std::string& list,
                                                                  double minimum) {
    std::vector<core::clearance::PairRequest> pairs;
    if (list.empty()) {
        const int count = static_cast<int>(model.bodies.size());
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
                if (core::model::may_collide(model, a, b)) pairs.push_back({a, b, minimum});
            }
        }
        return pairs;
    }
    Errors errors;
    std::istringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        const size_t colon = part.find(':');
        if (colon == std::string::npos) {
            errors.push_back({ErrorCode::parse, "--pairs", "\"" + part + "\" is no pair; write A:B,C:D with names of bodies"});
            continue;
        }
        const Result<int> a = find_body(model, part.substr(0, colon)), b = find_body(model, part.substr(colon + 1));
        errors.insert(errors.end(), a.errors().begin(), a.errors().end());
        errors.insert(errors.end(), b.errors().begin(), b.errors().end());
        if (!a || !b) continue;
        if (*a == *b) errors.push_back({ErrorCode::inconsistent, "--pairs", "\"" + part + "\" pairs a body with itself"});
        pairs.push_back({*a, *b, minimum});
    }
    if (!errors.empty()) return errors;
    return pairs;
}

Result<Subject> load_subject(const Options& options, const CommonOptions& common, Console& console) {
    Subject subject;
    if (file_kind(options.path) == FileKind::trajectory) {
        Result<core::stepper::StoredTrajectory> stored = core::stepper::read_trajectory(options.path);
        if (!stored) return stored.errors();
        subject.model = std::move(stored->model);
        subject.trajectory = std::move(stored->trajectory);
        subject.motion = true;
        return subject;
    }
    Result<LoadedModel> loaded = load_model(options.path, common);
    if (!loaded) return loaded.errors();
    tell_warnings(console, loaded->warnings);
    subject.model = std::move(loaded->model);
    subject.trajectory = core::clearance::as_assembled(subject.model);
    if (!options.motion) return subject;
    core::stepper::SimulationOptions simulate_options;
    simulate_options.steps = loaded->steps;
    simulate_options.on_step = [&](const core::stepper::Progress& p) { console.progress("simulating", p.step, p.steps); };
    simulate_options.should_stop = interrupted;
    core::stepper::Simulation simulation = core::stepper::simulate(subject.model, simulate_options);
    subject.trajectory = std::move(simulation.trajectory);
    subject.motion = true;
    if (simulation.report.status != core::stepper::SimulationStatus::ok) {
        subject.not_simulated = std::string(core::stepper::to_string(simulation.report.status)) + ": " + simulation.report.message;
    }
    return subject;
}

int exit_code(core::clearance::PairStatus status, bool whole) {
    if (status == core::clearance::PairStatus::violated) return exit_violated;
    return status == core::clearance::PairStatus::undecided || !whole ? exit_undecided : exit_done;
}

int run_clearance(const Options& options, const CommonOptions& common, Console& console) {
    const Result<double> minimum = core::base::parse_length(options.minimum, "--minimum");
    const Result<double> tolerance = core::base::parse_length(options.tolerance, "--tolerance");
    Errors errors = minimum.errors();
    errors.insert(errors.end(), tolerance.errors().begin(), tolerance.errors().end());
    if (minimum && *minimum < 0) errors.push_back({ErrorCode::out_of_range, "--minimum", "a clearance is not negative"});
    if (tolerance && !(*tolerance > 0)) errors.push_back({ErrorCode::out_of_range, "--tolerance", "a tolerance is greater than 0"});
    if (!errors.empty()) return console.input_errors(errors);
    const Result<Subject> subject = load_subject(options, common, console);
    if (!subject) return console.input_errors(subject.errors());
    const auto pairs = requested_pairs(subject->model, options.pairs, *minimum);
    if (!pairs) return console.input_errors(pairs.errors());

    core::clearance::ClearanceOptions certify;
    certify.tolerance = *tolerance;
    certify.motion = subject->motion;
    certify.on_pair = [&](int done, int of) { console.progress("certifying", done, of); };
    const auto results = core::clearance::certify_clearance(subject->model, subject->trajectory, *pairs, certify);
    const std::vector<std::string> names = body_names(subject->model);
    Json json = clearance_json(results, names);
    json["minimum"] = *minimum;
    const core::clearance::PairStatus status = overall_status(results);
    const bool whole = subject->not_simulated.empty();
    if (!whole && status != core::clearance::PairStatus::violated) json["status"] = "undecided";
    json["motion"] = subject->motion;
    if (!whole) json["message"] = "the motion is known up to there only: " + subject->not_simulated;
    const std::string unit = unit_name(subject->model.length_unit);
    std::string text = clearance_text(results, names, unit, console);
    text += std::string("overall: ") + json["status"].get<std::string>() + (subject->motion ? ", over the motion\n" : ", as assembled\n");
    if (!whole) text += json["message"].get<std::string>() + "\n";
    console.result(json, text);
    return exit_code(status, whole);
}

}  // namespace

Command add_clearance(CLI::App& program, const CommonOptions& common) {
    CLI::App* app = program.add_subcommand("clearance", "Certified least distance of each pair of bodies");
    auto options = std::make_shared<Options>();
    app->add_option("FILE", options->path, "Scene, design (at its values), or trajectory")->required();
    app->add_option("--minimum", options->minimum, "Required clearance, with its unit: 0.3mm")->required();
    app->add_option("--pairs", options->pairs, "A:B,C:D by names of bodies (default: every pair that may collide)");
    app->add_option("--tolerance", options->tolerance, "How far the two bounds may be apart (default 0.001mm)");
    app->add_flag("--motion", options->motion, "Over the motion, which is simulated first (a trajectory: always); else as assembled");
    app->footer("Example:  fettle clearance examples/slider_crank/slider_crank.scene.json --minimum 0.3mm --pairs crank:rod,rod:piston");
    return {app, [options, &common](Console& console) { return run_clearance(*options, common, console); }};
}

}  // namespace fettle::design::cli
