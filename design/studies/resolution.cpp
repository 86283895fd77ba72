// SPDX-License-Identifier: MIT
#include "design/studies/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/part_files/part_file.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::studies {

namespace {

using description::Design;
using problem::DesignEvaluation;
using problem::DesignProblem;

constexpr int times = 2;

// The scenes that are simulated, by the numbers of DesignProblem's scenarios.
std::vector<core::scene::Scene*> simulated_scenes(Design& design) {
    if (design.scenarios.empty()) return {&design.scene};
    std::vector<core::scene::Scene*> scenes;
    for (auto& scenario : design.scenarios) scenes.push_back(&scenario.scene);
    return scenes;
}

// Settings of contact that the scene leaves open would be chosen anew, for another step and other meshes.
void take_contact(const DesignProblem& from, Design& design) {
    const std::vector<core::scene::Scene*> scenes = simulated_scenes(design);
    for (int s = 0; s < count_of(scenes); ++s) {
        const core::scene::Scene& own = from.design().scenarios.empty() ? from.design().scene : from.design().scenarios[s].scene;
        scenes[s]->dhat = own.dhat;
        scenes[s]->velocity_tolerance = own.velocity_tolerance;
        scenes[s]->kappa = from.kappa(s);
    }
}

// Which scenarios have friction whose normal forces and directions are those of a round before, as built?
std::vector<bool> lagging_friction(const DesignProblem& problem) {
    const VectorX p = description::values_of(problem.design().parameters);
    std::vector<bool> lagging;
    for (int s = 0; s < problem.scenario_count(); ++s) {
        const Result<core::model::Model> model = problem.model_at(p, s);
        lagging.push_back(model && model->friction.rounds > 0 && model->friction.mu.maxCoeff() > 0);
    }
    return lagging;
}

void settle_friction(const std::vector<bool>& lagging, Design& design) {
    const std::vector<core::scene::Scene*> scenes = simulated_scenes(design);
    for (size_t s = 0; s < scenes.size(); ++s)
        if (lagging[s]) scenes[s]->friction.rounds = -1;
}

std::vector<std::string> fixed_meshes(const Design& design) {
    std::vector<std::string> names;
    for (const core::scene::Body& body : design.scene.bodies)
        if (!body.shape || body.shape->part.empty()) names.push_back(body.name);
    return names;
}

double share_of_change(double from, double to) {
    return from == 0 && to == 0 ? 0 : std::abs(to - from) / std::max(std::abs(from), std::abs(to));
}

std::vector<ResolvedQuantity> quantities_of(const Design& design) {
    std::vector<ResolvedQuantity> quantities;
    for (size_t k = 0; k < design.objective.size(); ++k) quantities.push_back({design.objective[k].name, true, static_cast<int>(k)});
    for (size_t i = 0; i < design.constraints.size(); ++i) quantities.push_back({design.constraints[i].name, false, static_cast<int>(i)});
    return quantities;
}

// The runs of one design, one after the other.
class ResolutionStudy {
public:
    ResolutionStudy(const std::string& path, reading::DesignReadOptions read, const ResolutionOptions& options)
        : path_(path), read_(std::move(read)), options_(options) {
        read_.made.reset();  // whose parts have other facets
    }

    Result<ResolutionReport> run() {
        if (options_.on_variant) options_.on_variant("as written");
        Result<DesignProblem> written = problem({1, 1});
        if (!written) return written.errors();
        written_.emplace(std::move(written).value());
        const std::vector<bool> lagging = lagging_friction(*written_);
        report_.friction_lags = std::find(lagging.begin(), lagging.end(), true) != lagging.end();
        report_.quantities = quantities_of(written_->design());
        report_.fixed_meshes = fixed_meshes(written_->design());
        measure(*written_, add("as written", &ResolvedQuantity::as_written));
        vary("with twice the facets", &ResolvedQuantity::finer_facets, {times, 1});
        vary("with half the time step", &ResolvedQuantity::finer_steps, {1, times});
        vary("with both", &ResolvedQuantity::finer_both, {times, times});
        if (report_.friction_lags)
            vary("with settled friction", &ResolvedQuantity::settled_friction, {1, 1},
                 [&](Design& design) { settle_friction(lagging, design); });
        return std::move(report_);
    }

private:
    Result<DesignProblem> problem(const reading::Resolution& resolution, const std::function<void(Design&)>& change = {}) {
        read_.resolution = resolution;
        Result<reading::DesignFile> file = reading::read_design(path_, read_);
        if (!file) return file.errors();
        if (written_) take_contact(*written_, file->design);
        if (change) change(file->design);
        return DesignProblem::create(std::move(file->design));
    }

    ResolutionRun& add(const char* name, double ResolvedQuantity::*value) { return report_.runs.emplace_back(ResolutionRun{name, value}); }

    void vary(const char* name, double ResolvedQuantity::*value, const reading::Resolution& resolution,
              const std::function<void(Design&)>& change = {}) {
        ResolutionRun& run = add(name, value);
        if (report_.interrupted) {
            run.failure = "not begun";
            return;
        }
        if (options_.on_variant) options_.on_variant(name);
        const Result<DesignProblem> varied = problem(resolution, change);
        if (varied) {
            measure(*varied, run);
        } else {
            run.failure = varied.errors().front().where + ": " + varied.errors().front().message;
        }
    }

    void measure(const DesignProblem& problem, ResolutionRun& run) {
        problem::EvaluateOptions evaluate;
        evaluate.gradients = false;
        evaluate.should_stop = options_.should_stop;
        const DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters), evaluate);
        report_.interrupted = at.interrupted;
        if (!at.usable) run.failure = at.reason;
        for (ResolvedQuantity& quantity : report_.quantities)
            if (at.usable) quantity.*run.value = (quantity.of_objective ? at.terms : at.constraints)[quantity.index].value;
    }

    const std::string& path_;
    reading::DesignReadOptions read_;
    const ResolutionOptions& options_;
    std::optional<DesignProblem> written_;
    ResolutionReport report_;
};

bool has_same_meshes(const DesignProblem& a, const DesignProblem& b, const VectorX& point) {
    for (int s = 0; s < a.scenario_count(); ++s) {
        const Result<core::model::Model> of_a = a.model_at(point, s), of_b = b.model_at(point, s);
        if (!of_a || !of_b) return false;
        for (size_t i = 0; i < of_a->bodies.size(); ++i)
            if (of_a->bodies[i].mesh.vertices.cols() != of_b->bodies[i].mesh.vertices.cols()) return false;
    }
    return true;
}

// With the numbers of `at`.
void take_values(const DesignEvaluation& at, FinerRun& run) {
    if (!at.usable) {
        run.failure = at.reason;
        return;
    }
    run.objective = at.objective;
    run.terms = at.terms;
    run.constraints = at.constraints;
}

// By a run in which it is met otherwise, if there is one; else, or of several, by the one that changes it most.
FinerValue finer_value(const std::string& name, bool of_objective, size_t index, const DesignEvaluation& found, const FinerReport& report,
                       const description::Bounds* bounds) {
    const auto is_met = [&](const description::Measurement& m) { return bounds == nullptr || description::violation(*bounds, m) <= 0; };
    const description::Measurement& own = (of_objective ? found.terms : found.constraints)[index];
    FinerValue out{name, of_objective, static_cast<int>(index), own.value, own.value};
    out.is_met = is_met(own);
    bool is_flipped = false;
    for (const FinerRun& run : report.runs) {
        if (!run.failure.empty()) continue;
        const description::Measurement& measured = (of_objective ? run.terms : run.constraints)[index];
        const double share = share_of_change(own.value, measured.value);
        const bool met = is_met(measured), flips = met != out.is_met;
        if (out.run == nullptr || (flips && !is_flipped) || (flips == is_flipped && share > out.share)) {
            is_flipped = flips;
            out.finer = measured.value;
            out.share = share;
            out.run = &run;
        }
        out.is_met_finer = out.is_met_finer && met;
    }
    return out;
}

}  // namespace

FinerReport measure_finer(const reading::DesignFile& file, const DesignProblem& problem, const VectorX& point,
                          reading::DesignReadOptions read, const ResolutionOptions& options) {
    FinerReport report;
    read.made.reset();  // whose parts have other facets
    const auto add = [&](const char* name, const char* key, const reading::Resolution& resolution) {
        if (report.interrupted) return;
        read.resolution = resolution;
        Result<reading::DesignFile> finer = reading::parse_design(file.text, file.path, read);
        if (finer) take_contact(problem, finer->design);
        const Result<DesignProblem> made = finer ? DesignProblem::create(std::move(finer->design)) : finer.errors();
        if (made && resolution.steps == 1 && has_same_meshes(problem, *made, point)) return;
        FinerRun& run = report.runs.emplace_back();
        run.name = name;
        run.key = key;
        if (!made) {
            run.failure = made.errors().front().where + ": " + made.errors().front().message;
            return;
        }
        if (options.on_variant) options.on_variant(name);
        problem::EvaluateOptions evaluate;
        evaluate.gradients = false;
        evaluate.should_stop = options.should_stop;
        const DesignEvaluation at = made->evaluate(point, evaluate);
        report.interrupted = at.interrupted;
        take_values(at, run);
    };
    add("with twice the facets", "finer_facets", {times, 1});
    int steps = 0;
    for (int s = 0; s < problem.scenario_count(); ++s) steps += problem.steps(s);
    if (steps > 0) add("with half the time step", "finer_steps", {1, times});
    return report;
}

bool is_flip(const FinerValue& value) {
    constexpr double beyond_rounding = 1e-3;  // share that what is at its limit changes by
    return value.is_met != value.is_met_finer && value.share > beyond_rounding;
}

std::vector<FinerValue> finer_values(const Design& design, const DesignEvaluation& found, const FinerReport& report) {
    std::vector<FinerValue> values;
    const auto has_numbers = [](const FinerRun& run) { return run.failure.empty(); };
    if (!found.usable || std::none_of(report.runs.begin(), report.runs.end(), has_numbers)) return values;
    for (size_t k = 0; k < design.objective.size(); ++k)
        values.push_back(finer_value(design.objective[k].name, true, k, found, report, nullptr));
    for (size_t i = 0; i < design.constraints.size(); ++i)
        values.push_back(finer_value(design.constraints[i].name, false, i, found, report, &design.constraints[i].bounds));
    return values;
}

double change_of_best(const DesignEvaluation& found, const VectorX& multipliers, const FinerRun& run) {
    if (!run.failure.empty()) return std::nan("");
    double change = run.objective - found.objective;
    for (size_t i = 0; i < run.constraints.size() && multipliers.size() > 0; ++i) {
        const double cost = multipliers[static_cast<Eigen::Index>(i)];
        const auto judged = [&](const description::Measurement& m) { return cost > 0 ? m.lower : m.upper; };
        if (cost != 0) change -= cost * (judged(run.constraints[i]) - judged(found.constraints[i]));
    }
    return change;
}

double ResolvedQuantity::change() const { return share_of_change(as_written, finer_both); }

double ResolvedQuantity::change_by_friction() const { return share_of_change(as_written, settled_friction); }

bool ResolutionReport::is_complete() const {
    return std::all_of(runs.begin(), runs.end(), [](const ResolutionRun& run) { return run.failure.empty(); });
}

Result<ResolutionReport> check_resolution(const std::string& path, reading::DesignReadOptions read, const ResolutionOptions& options) {
    return ResolutionStudy(path, std::move(read), options).run();
}

}  // namespace fettle::design::studies
