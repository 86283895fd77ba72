// SPDX-License-Identifier: MIT
#include "design/report/report_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "core/files/atomic_file.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/step_tables.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/answers/run_folder.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/kept_steps.hpp"
#include "design/report/quantity_curves.hpp"
#include "design/report/report_page.hpp"
#include "design/studies/history.hpp"

namespace fettle::design::report {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using core::model::Model;
using core::stepper::Simulation;

Result<Json> read_result(const fs::path& folder) {
    const fs::path file = folder / "result.json";
    const Result<std::string> text = core::files::read_file(file);
    if (!text)
        return Error{ErrorCode::file_not_found, file.string(),
                     "is not there: a report is made of a folder that optimise, simulate or clearance wrote with --out"};
    Json result = parsed_json(*text);
    if (result.is_discarded()) return Error{ErrorCode::parse, file.string(), "is not JSON"};
    if (!kind_of(result)) return Error{ErrorCode::unsupported, file.string(), "is not an answer of optimise, simulate or clearance"};
    return result;
}

// "slider_crank.scene.json" -> "slider_crank"; of no file the folder's own name.
std::string name_of(const std::string& scene, const fs::path& folder) {
    const std::string file = fs::path(scene).filename().string();
    if (!file.empty()) return file.substr(0, file.find('.'));
    const fs::path whole = fs::absolute(folder).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

Vector3 gravity_in(const std::string& text) {
    Json json = parsed_json(text);
    if (json.is_object() && json.contains("rigid_body_problem")) json = Json(json["rigid_body_problem"]);
    Vector3 gravity = Vector3::Zero();
    if (!json.is_object() || !json.contains("gravity") || !json["gravity"].is_array()) return gravity;
    const Json& list = json["gravity"];
    for (std::size_t k = 0; k < std::min<std::size_t>(3, list.size()); ++k)
        if (list[k].is_number()) gravity[k] = list[k].get<double>();
    return gravity;
}

std::vector<std::string> names_of(const Model& model) {
    std::vector<std::string> names;
    for (const auto& body : model.bodies) names.push_back(body.name);
    return names;
}

StepCurves curves_of(const Simulation& simulation, const Model& model) {
    StepCurves curves(model, linear_motors(model));
    for (const core::stepper::StepOutputs& step : simulation.outputs) curves.add(step, model);
    return curves;
}

// For the next report of this folder.
Errors add_tables(core::files::FilesTogether& files, const fs::path& folder, const Simulation& simulation, const Model& model) {
    const std::vector<std::string> names = names_of(model);
    const auto add = [&](const char* name, const std::string& text) { return files.add(folder / name, text); };
    Errors errors = add("steps.csv", core::records::steps_csv(simulation));
    if (errors.empty()) errors = add("contacts.csv", core::records::contacts_csv(simulation, names));
    if (errors.empty()) errors = add("drives.csv", core::records::drives_csv(simulation, names));
    if (errors.empty() && !model.mechanism.joints.empty())
        errors = add("joints.csv", core::records::joints_csv(simulation, model.mechanism));
    return errors;
}

// What a reader of the page may want to take from beside it.
std::vector<std::string> files_beside(const fs::path& folder) {
    std::vector<std::string> names;
    for (const char* name : {"motion.glb", "design.final.json", "trajectory.json", "result.json"})
        if (fs::exists(folder / name)) names.emplace_back(name);
    return names;
}

Simulation simulated(const Model& model, int steps, bool outputs, const std::function<bool()>& should_stop) {
    core::stepper::SimulationOptions options;
    options.steps = steps;
    options.outputs = outputs;
    options.should_stop = should_stop;
    return core::stepper::simulate(model, options);
}

bool same_poses(const core::stepper::Trajectory& x, const core::stepper::Trajectory& y) {
    return std::equal(x.poses.begin(), x.poses.end(), y.poses.begin(), y.poses.end(), [](const auto& p, const auto& q) {
        return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                          [](const auto& a, const auto& b) { return a.position == b.position && a.rotation == b.rotation; });
    });
}

// Values of an answer's `parameters_start`, SI; nothing if they are not all there.
std::optional<VectorX> start_values(const description::Design& design, const Json& result) {
    VectorX p(design.parameters.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const description::Parameter& parameter = design.parameters[k];
        const Json start = result.value("parameters_start", Json());
        if (!start.is_object() || !start.contains(parameter.name) || !start[parameter.name].is_number()) return std::nullopt;
        p[k] = core::base::to_si(start[parameter.name].get<double>(), parameter.unit);
    }
    return p;
}

// The folder being read into a source; what takes computing is left out once a stop is asked for.
class FolderReader {
public:
    /// @param files  gets what the report had to compute, for the next one
    FolderReader(const fs::path& folder, ReportOptions& options, ReportSource& source, core::files::FilesTogether& files)
        : folder_(folder), options_(options), source_(source), files_(files) {}

    Errors read() {
        if (Errors errors = read_motion(); !errors.empty()) return errors;
        if (source_.kind == ReportKind::optimise) return read_design();
        const std::string scene = text_or_empty(scene_path_);
        source_.description = description_of(scene);
        source_.gravity = gravity_in(scene);
        source_.name = name_of(scene_path_, folder_);
        if (source_.kind == ReportKind::simulate && source_.motion) take_steps(scene);
        return {};
    }

private:
    // Forces and energies of a simulation: of the run itself, or as its tables have them.
    void take_steps(const std::string& scene) {
        if (options_.at_hand.steps) {
            source_.steps = *std::move(options_.at_hand.steps);
            return;
        }
        const StepTables tables = read_step_tables(folder_);
        LinearMotors linear;
        if (!tables.joints.empty() && !scene.empty()) {
            const auto read =
                core::scene_files::read_scene(scene_path_, reading::scene_read_options(options_.mesh_dirs, options_.programs));
            if (read) linear = linear_motors(read->mechanism);
        }
        source_.steps = StepCurves(source_.motion->model, std::move(linear));
        add_steps(tables, source_.steps);
    }

    Errors read_motion() {
        if (source_.result.value("status", "") == "start_failed") return {};  // a trajectory that is there is not its own
        if (options_.at_hand.motion) {
            source_.motion = std::move(options_.at_hand.motion);
            scene_path_ = source_.motion->scene_path;
            return {};
        }
        Result<core::records::StoredTrajectory> stored = core::records::read_trajectory(folder_ / "trajectory.json");
        if (!stored) return stored.errors();
        source_.notices.insert(source_.notices.end(), stored->warnings.begin(), stored->warnings.end());
        scene_path_ = stored->scene_path;
        source_.motion = Motion{std::move(stored->model), std::move(stored->trajectory)};
        return {};
    }

    Errors read_design() {
        if (const auto& design = options_.at_hand.design) return take_design(*design->file, design->values, design->problem);
        const Result<reading::DesignFile> file =
            reading::read_design((folder_ / "design.final.json").string(), {options_.mesh_dirs, options_.programs});
        if (!file) return file.errors();
        return take_design(*file, description::values_of(file->design.parameters), nullptr);
    }

    // @param known  of file.design; null: it has to be made
    Errors take_design(const reading::DesignFile& file, const VectorX& values, const problem::DesignProblem* known) {
        source_.description = description_of(file.text);
        source_.gravity = file.design.scene.gravity;
        source_.name = name_of(file.scene_path, folder_);
        if (Errors errors = read_history(); !errors.empty()) return errors;
        source_.design = file.design;
        for (Eigen::Index k = 0; k < values.size(); ++k) source_.design->parameters[k].value = values[k];
        source_.values = values;
        source_.quantities = quantities_with_curves(file.quantities, file.design);
        if (!source_.motion) return {};
        std::optional<problem::DesignProblem> made;
        if (known == nullptr) {
            Result<problem::DesignProblem> problem = problem::DesignProblem::create(file.design);
            if (!problem) return problem.errors();
            made = std::move(problem).value();
        }
        const problem::DesignProblem& problem = known != nullptr ? *known : *made;
        if (!problem.design().scenarios.empty()) source_.scenario = problem.design().scenarios.front().name;
        if (Errors errors = take_steps(problem, values); !errors.empty()) return errors;
        if (Errors errors = take_scenarios(problem, values, file.scene_path); !errors.empty()) return errors;
        return take_before(problem, file.scene_path);
    }

    Errors read_history() {
        const fs::path path = folder_ / "history.jsonl";
        source_.history = text_or_empty(path);
        const std::size_t end = source_.history.rfind('\n') + 1;
        const bool whole = end == source_.history.size();
        source_.history.resize(end);
        if (!whole) {
            source_.notices.push_back(path.filename().string() + ": " + cut_off);
            if (options_.tell) options_.tell(path.string() + ": " + cut_off);
        }
        return studies::history_faults(source_.history, path.string());
    }

    // Forces of the final design: as they are kept, or simulated once more, with the same bits.
    Errors take_steps(const problem::DesignProblem& problem, const VectorX& values) {
        source_.steps = StepCurves(source_.motion->model, linear_motors(problem.design().scene.mechanism));
        add_steps(read_step_tables(folder_), source_.steps);
        if (!source_.steps.empty() || options_.should_stop()) return {};
        const Result<Model> model = problem.model_at(values);
        if (!model) return model.errors();
        const Simulation simulation = simulated(*model, problem.steps(), true, options_.should_stop);
        if (!same_poses(simulation.trajectory, source_.motion->trajectory)) {
            if (!options_.should_stop())
                source_.notices.emplace_back(
                    "No forces are shown: the scene or the program has changed since trajectory.json was written.");
            return {};
        }
        source_.steps = curves_of(simulation, *model);
        return add_tables(files_, folder_, simulation, *model);
    }

    // The motions and forces of the design's other scenarios, simulated once more; their trajectories stay in the folder.
    Errors take_scenarios(const problem::DesignProblem& problem, const VectorX& values, const std::string& scene_path) {
        if (source_.steps.empty()) return {};  // a simulation now would not be the one that was
        for (int s = 1; s < problem.scenario_count() && !options_.should_stop(); ++s) {
            const std::string& name = problem.design().scenarios[s].name;
            const Result<Model> model = problem.model_at(values, s);
            if (!model) return model.errors();
            Simulation simulation = simulated(*model, problem.steps(s), true, options_.should_stop);
            if (options_.should_stop()) return {};
            const fs::path file = folder_ / answers::scenario_trajectory(name);
            if (Errors errors = answers::others_file(file); !errors.empty()) return errors;
            if (Errors errors = core::records::add_trajectory(files_, file, simulation.trajectory, *model, scene_path); !errors.empty())
                return errors;
            StepCurves steps = curves_of(simulation, *model);
            source_.others.push_back({name, Motion{*model, std::move(simulation.trajectory), scene_path}, std::move(steps)});
        }
        return {};
    }

    Errors take_before(const problem::DesignProblem& problem, const std::string& scene_path) {
        const std::optional<VectorX> p = start_values(problem.design(), source_.result);
        if (!p || options_.should_stop()) return {};
        const Errors obstacles = problem.obstacles(*p);
        const Result<Model> model = obstacles.empty() ? problem.model_at(*p) : Result<Model>(obstacles);
        if (!model) {
            source_.notices.push_back("The design before is not shown: " + model.errors().front().message);
            return {};
        }
        const fs::path file = folder_ / "trajectory.start.json";
        if (core::records::is_trajectory_file(file)) {
            auto stored = core::records::read_trajectory(file);
            if (stored && core::records::geometry_hash(stored->model) == core::records::geometry_hash(*model)) {
                source_.before = Motion{std::move(stored->model), std::move(stored->trajectory)};
                return {};
            }
        }
        Simulation simulation = simulated(*model, problem.steps(), false, options_.should_stop);
        if (options_.should_stop()) return {};
        if (simulation.report.status != core::stepper::SimulationStatus::ok)
            source_.notices.push_back("The design before could not be simulated to the end: " + simulation.report.message);
        const Errors errors = core::records::add_trajectory(files_, file, simulation.trajectory, *model, scene_path);
        source_.before = Motion{*model, std::move(simulation.trajectory)};
        return errors;
    }

    const fs::path& folder_;
    ReportOptions& options_;
    ReportSource& source_;
    core::files::FilesTogether& files_;
    std::string scene_path_;
};

}  // namespace

AtHand at_hand(const reading::DesignFile& file, const problem::DesignProblem& problem, const studies::OptimiseOutcome& outcome) {
    AtHand known;
    const problem::DesignEvaluation& final = outcome.final;
    if (!final.usable) return known;
    known.motion = Motion{*final.runs.front().model, final.runs.front().simulation.trajectory, file.scene_path};
    known.design = FinalDesign{&file, &problem, outcome.report.point};
    return known;
}

Result<std::string> write_report(const std::string& folder, ReportOptions options) {
    Result<Json> result = options.at_hand.answer ? Result<Json>(*std::move(options.at_hand.answer)) : read_result(folder);
    if (!result) return result.errors();
    const fs::path path = folder;
    ReportSource source;
    source.kind = *kind_of(*result);
    source.folder = folder;
    source.result = *std::move(result);
    const std::string file = options.out.empty() ? (path / "report.html").string() : options.out;
    if (options.out.empty())
        if (Errors errors = answers::others_file(file); !errors.empty()) return errors;
    try {
        core::files::FilesTogether files;
        if (Errors errors = FolderReader(path, options, source, files).read(); !errors.empty()) return errors;
        if (options.out.empty()) source.files = files_beside(path);
        if (Errors errors = files.add(file, page_of(report_data(source, options.should_stop))); !errors.empty()) return errors;
        if (Errors errors = files.take_names(); !errors.empty()) return errors;
    } catch (const Json::exception& fault) {  // a key that is not there, or has another type
        return Error{ErrorCode::wrong_type, (path / "result.json").string(),
                     std::string("it, or the history.jsonl beside it, is damaged: ") + fault.what() +
                         "; make them anew, by the command that wrote this folder"};
    }
    return file;
}

}  // namespace fettle::design::report
