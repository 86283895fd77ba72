// SPDX-License-Identifier: MIT
#include "fettle/design/optimise_design.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/design_file.hpp"
#include "fettle/design/history.hpp"

namespace fettle::design {

namespace {

HistoryHeader header_of(const Design& design) {
    HistoryHeader header;
    header.design_hash = design_hash(design);
    for (const Parameter& parameter : design.parameters) header.parameters.push_back(parameter.name);
    for (const auto& constraint : design.constraints) header.constraints.push_back(constraint->name());
    return header;
}

std::string evaluation_line(int number, const optimisers::Evaluation& e, bool best) {
    char line[200];
    if (!e.usable) {
        std::snprintf(line, sizeof line, "%4d  cannot be evaluated: ", number);
        return line + e.reason;
    }
    std::snprintf(line, sizeof line, "%4d  objective %-13.8g violation %-11.4g%s", number, e.objective, e.violation, best ? " best" : "");
    return line;
}

std::vector<std::string> limits_of(const Design& design, const VectorX& point, const DesignEvaluation& final) {
    std::vector<std::string> limits;
    char text[300];
    for (size_t i = 0; i < design.constraints.size() && i < final.constraints.size(); ++i) {
        const constraints::Constraint& constraint = *design.constraints[i];
        if (constraint.violation(final.constraints[i]) <= 0) continue;
        const double unit = constraint.bounds().unit;
        std::snprintf(text, sizeof text, "%s is proven within [%.6g, %.6g], required is [%.6g, %.6g]", constraint.name().c_str(),
                      final.constraints[i].lower / unit, final.constraints[i].upper / unit, constraint.bounds().lower / unit,
                      constraint.bounds().upper / unit);
        limits.emplace_back(text);
    }
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& p = design.parameters[k];
        const double value = point[static_cast<Eigen::Index>(k)], near = 1e-3 * (p.upper - p.lower);
        const bool at_lower = value <= p.lower + near, at_upper = value >= p.upper - near;
        if (!at_lower && !at_upper) continue;
        std::snprintf(text, sizeof text, "parameter %s is at its %s bound %.6g %s", p.name.c_str(), at_lower ? "lower" : "upper",
                      from_si(at_lower ? p.lower : p.upper, p.unit), p.unit.name.c_str());
        limits.emplace_back(text);
    }
    return limits;
}

Errors write_files(const DesignProblem& problem, const OptimiseOptions& options, const OptimiseOutcome& outcome) {
    const std::filesystem::path folder = options.directory;
    const std::string text = design_text(problem.design(), outcome.report.point, options.directory);
    Errors errors = core::files::write_file_atomically(folder / "design.final.json", text);
    if (!errors.empty() || !outcome.final.usable) return errors;
    return core::records::write_trajectory(folder / "trajectory.json", outcome.final.simulation.trajectory, *outcome.final.model,
                                           problem.design().scene_path);
}

}  // namespace

Result<OptimiseOutcome> optimise_design(const DesignProblem& problem, const OptimiseOptions& options) {
    const Design& design = problem.design();
    const std::string name = options.optimiser.empty() ? design.optimiser.name : options.optimiser;
    const auto optimiser = optimisers::make_optimiser(name, "--optimiser");
    if (!optimiser) return optimiser.errors();
    const HistoryMode mode = options.resume ? HistoryMode::resume : HistoryMode::fresh;
    Result<History> history = History::open(options.directory, header_of(design), mode);
    if (!history) return history.errors();

    OptimiseOutcome outcome;
    outcome.history_kept_as = history->kept_as();
    EvaluateOptions evaluate;
    evaluate.should_stop = options.should_stop;
    evaluate.on_step = options.on_step;
    int computed = 0;
    optimisers::Problem scaled = problem.optimiser_problem();
    scaled.evaluate = recorded(*history, [&](const VectorX& p) {
        ++computed;
        return problem.history_entry(p, problem.evaluate(p, evaluate));
    });
    optimisers::OptimiserOptions settings;
    settings.max_evaluations = design.optimiser.max_evaluations;
    settings.tolerance = design.optimiser.tolerance;
    settings.should_stop = options.should_stop;
    settings.on_evaluation = [&](int number, const VectorX&, const optimisers::Evaluation& e, bool best) {
        if (options.narrate) options.narrate(evaluation_line(number, e, best));
    };
    outcome.report = optimisers::optimise(scaled, **optimiser, settings);
    outcome.replayed = outcome.report.evaluations - computed;

    if (outcome.report.best.usable) {
        EvaluateOptions last;  // not interruptible: it is what makes the result of an interrupted run usable
        last.gradients = false;
        outcome.final = problem.evaluate(outcome.report.point, last);
        for (const objectives::Quantity& quantity : outcome.final.constraints) {
            if (quantity.clearance) outcome.clearance.push_back(*quantity.clearance);
        }
        if (!outcome.report.feasible) outcome.limits = limits_of(design, outcome.report.point, outcome.final);
    }
    const Errors errors = write_files(problem, options, outcome);
    if (!errors.empty()) return errors;
    return outcome;
}

}  // namespace fettle::design
