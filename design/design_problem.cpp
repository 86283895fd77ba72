// SPDX-License-Identifier: MIT
#include "fettle/design/design_problem.hpp"

#include <chrono>
#include <limits>

#include "fettle/adjoint/stepper/reverse_sweep.hpp"
#include "fettle/core/base/contract.hpp"
#include "fettle/core/model/build_model.hpp"

namespace fettle::design {

namespace {

using core::model::Model;
using objectives::Quantity;
using objectives::Seeds;
using objectives::Simulated;

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

std::string first_reason(const Errors& errors) {
    std::string reason = (errors.front().where.empty() ? "" : errors.front().where + ": ") + errors.front().message;
    if (errors.size() > 1) reason += " (and " + std::to_string(errors.size() - 1) + " more)";
    return reason;
}

void add(adjoint::ModelGradient& sum, const adjoint::ModelGradient& part) {
    for (size_t i = 0; i < sum.bodies.size(); ++i) {
        adjoint::BodyGradient& to = sum.bodies[i];
        const adjoint::BodyGradient& from = part.bodies[i];
        if (from.vertices_bar.cols() > 0) to.vertices_bar += from.vertices_bar;
        to.pose_start_bar += from.pose_start_bar;
        to.velocity_start_bar += from.velocity_start_bar;
        to.density_bar += from.density_bar;
        to.force_bar += from.force_bar;
        for (size_t t = 0; t < to.increment_bar.size() && t < from.increment_bar.size(); ++t) to.increment_bar[t] += from.increment_bar[t];
    }
    sum.gravity_bar += part.gravity_bar;
}

// Seeds on the start configuration alone are passed on as they are: the sweep is linear, and maps what is zero to zero.
bool reaches_past_start(const adjoint::TrajectoryGradient& seed) {
    for (size_t t = 1; t < seed.pose_bar.size(); ++t) {
        for (const Matrix34& bar : seed.pose_bar[t]) {
            if (!bar.isZero(0)) return true;
        }
    }
    return false;
}

// All seeds through one sweep. @return one gradient per seed
Result<std::vector<adjoint::ModelGradient>> sweep(const Simulated& simulated, std::vector<Seeds>& seeds) {
    std::vector<adjoint::TrajectoryGradient> moving;
    std::vector<size_t> of;
    for (size_t k = 0; k < seeds.size(); ++k) {
        if (!reaches_past_start(seeds[k].trajectory_bar)) continue;
        moving.push_back(std::move(seeds[k].trajectory_bar));
        of.push_back(k);
    }
    std::vector<adjoint::ModelGradient> result;
    for (Seeds& seed : seeds) result.push_back(std::move(seed.model_bar));
    std::vector<bool> swept(seeds.size(), false);
    if (!moving.empty()) {
        const Result<std::vector<adjoint::ModelGradient>> parts =
            adjoint::stepper::reverse_sweep(simulated.model, simulated.trajectory, moving);
        if (!parts) return parts.errors();
        for (size_t j = 0; j < of.size(); ++j) {
            add(result[of[j]], (*parts)[j]);
            swept[of[j]] = true;
        }
    }
    for (size_t k = 0; k < seeds.size(); ++k) {
        if (swept[k]) continue;
        for (size_t i = 0; i < result[k].bodies.size(); ++i) result[k].bodies[i].pose_start_bar += seeds[k].trajectory_bar.pose_bar[0][i];
    }
    return result;
}

}  // namespace

Result<DesignProblem> DesignProblem::create(Design design) {
    Result<Model> model = core::model::build_model(design.scene);
    if (!model) return model.errors();
    DesignProblem problem;
    for (const core::model::Body& body : model->bodies) problem.reference_points_.push_back(body.reference_point);
    problem.kappa_ = model->kappa;
    // Their defaults are functions of the scene's size, which parameters change.
    design.scene.dhat = model->dhat;
    design.scene.velocity_tolerance = model->velocity_tolerance;
    problem.design_ = std::move(design);
    return problem;
}

Result<Model> DesignProblem::build(const core::scene::Scene& scene) const {
    core::model::BuildOptions options;
    options.reference_points = reference_points_;
    options.kappa = kappa_;
    options.check_meshes = false;  // the scene's were checked; generators make valid solids only
    return core::model::build_model(scene, options);
}

Result<Model> DesignProblem::model_at(const VectorX& p) const {
    const Result<MovedScene> moved = move_scene(design_.scene, design_.parameters, p);
    if (!moved) return moved.errors();
    return build(moved->scene);
}

DesignEvaluation DesignProblem::evaluate(const VectorX& p, const EvaluateOptions& options) const {
    const Stopwatch forward;
    DesignEvaluation evaluation;
    const Result<MovedScene> moved = move_scene(design_.scene, design_.parameters, p);
    if (!moved) {
        evaluation.reason = first_reason(moved.errors());
        return evaluation;
    }
    Result<Model> model = build(moved->scene);
    if (!model) {
        evaluation.reason = first_reason(model.errors());
        return evaluation;
    }
    evaluation.model = std::make_shared<const Model>(std::move(model).value());
    core::stepper::SimulationOptions simulation;
    simulation.steps = design_.steps;
    simulation.for_gradient = true;  // also without gradients: the same numbers for the same design
    simulation.on_step = options.on_step;
    simulation.should_stop = options.should_stop;
    evaluation.simulation = core::stepper::simulate(*evaluation.model, simulation);
    const core::stepper::SimulationReport& report = evaluation.simulation.report;
    if (report.status != core::stepper::SimulationStatus::ok) {
        evaluation.interrupted = report.status == core::stepper::SimulationStatus::interrupted;
        evaluation.reason = report.message.empty() ? core::stepper::to_string(report.status) : report.message;
        evaluation.forward_seconds = forward.seconds();
        return evaluation;
    }
    measure(evaluation);
    evaluation.usable = true;
    evaluation.forward_seconds = forward.seconds();
    if (options.gradients) {
        const Stopwatch backward;
        differentiate(*moved, evaluation);
        evaluation.backward_seconds = backward.seconds();
    }
    return evaluation;
}

void DesignProblem::measure(DesignEvaluation& evaluation) const {
    const Simulated simulated{*evaluation.model, evaluation.simulation.trajectory, design_.clearance_tolerance};
    for (const ObjectiveTerm& term : design_.objective) {
        evaluation.terms.push_back(term.objective->value(simulated));
        evaluation.objective += term.weight * evaluation.terms.back().value / term.unit;
    }
    for (const auto& constraint : design_.constraints) {
        evaluation.constraints.push_back(constraint->value(simulated));
        evaluation.violation = std::max(evaluation.violation, constraint->violation(evaluation.constraints.back()));
    }
}

void DesignProblem::differentiate(const MovedScene& moved, DesignEvaluation& evaluation) const {
    const Simulated simulated{*evaluation.model, evaluation.simulation.trajectory, design_.clearance_tolerance};
    std::vector<Seeds> seeds{zero_seeds(simulated)};
    for (size_t k = 0; k < design_.objective.size(); ++k) {
        const ObjectiveTerm& term = design_.objective[k];
        term.objective->add_seeds(simulated, evaluation.terms[k], term.weight / term.unit, seeds[0]);
    }
    for (size_t i = 0; i < design_.constraints.size(); ++i) {
        seeds.push_back(zero_seeds(simulated));
        design_.constraints[i]->add_seeds(simulated, evaluation.constraints[i], 1, seeds.back());
    }
    const Result<std::vector<adjoint::ModelGradient>> gradients = sweep(simulated, seeds);
    if (!gradients) {
        evaluation.usable = false;
        evaluation.reason = first_reason(gradients.errors());
        return;
    }
    const int n = parameter_count();
    evaluation.gradient = pull_back(moved, *evaluation.model, (*gradients)[0], n);
    evaluation.jacobian.resize(static_cast<Eigen::Index>(design_.constraints.size()), n);
    for (Eigen::Index i = 0; i < evaluation.jacobian.rows(); ++i) {
        evaluation.jacobian.row(i) = pull_back(moved, *evaluation.model, (*gradients)[static_cast<size_t>(i) + 1], n).transpose();
    }
}

optimisers::Problem DesignProblem::optimiser_problem() const {
    optimisers::Problem problem;
    const auto n = static_cast<Eigen::Index>(design_.parameters.size()), m = static_cast<Eigen::Index>(design_.constraints.size());
    problem.start = values_of(design_.parameters);
    problem.lower.resize(n);
    problem.upper.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        problem.lower[k] = design_.parameters[static_cast<size_t>(k)].lower;
        problem.upper[k] = design_.parameters[static_cast<size_t>(k)].upper;
    }
    problem.representable = [this](const VectorX& p) {
        VectorX q = p;
        for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = representable(p[k], design_.parameters[static_cast<size_t>(k)].unit);
        return q;
    };
    problem.constraint_lower.resize(m);
    problem.constraint_upper.resize(m);
    for (Eigen::Index i = 0; i < m; ++i) {
        problem.constraint_lower[i] = design_.constraints[static_cast<size_t>(i)]->target_lower();
        problem.constraint_upper[i] = design_.constraints[static_cast<size_t>(i)]->target_upper();
    }
    return problem;
}

HistoryEntry DesignProblem::history_entry(const VectorX& p, const DesignEvaluation& evaluation) const {
    if (evaluation.interrupted) throw optimisers::Interrupted();
    HistoryEntry entry;
    entry.point = p;
    entry.forward_seconds = evaluation.forward_seconds;
    entry.backward_seconds = evaluation.backward_seconds;
    optimisers::Evaluation& e = entry.evaluation;
    e.usable = evaluation.usable;
    e.reason = evaluation.reason;
    if (!e.usable) return entry;
    e.objective = evaluation.objective;
    e.gradient = evaluation.gradient;
    e.constraints.resize(static_cast<Eigen::Index>(evaluation.constraints.size()));
    for (size_t i = 0; i < evaluation.constraints.size(); ++i) {
        e.constraints[static_cast<Eigen::Index>(i)] = evaluation.constraints[i].value;
        entry.certified.emplace_back(design_.constraints[i]->name(), evaluation.constraints[i].lower);
    }
    e.jacobian = evaluation.jacobian;
    e.violation = evaluation.violation;
    for (size_t k = 0; k < evaluation.terms.size(); ++k) entry.terms.emplace_back(design_.objective[k].name, evaluation.terms[k].value);
    // A number that is not finite is a failure: it must not reach the history, where JSON could not hold it.
    if (std::isfinite(e.objective) && e.gradient.allFinite() && e.constraints.allFinite() && e.jacobian.allFinite()) return entry;
    HistoryEntry failed;
    failed.point = p;
    failed.evaluation.reason = "a value or derivative is not finite";
    return failed;
}

}  // namespace fettle::design
