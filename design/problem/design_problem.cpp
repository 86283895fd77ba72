// SPDX-License-Identifier: MIT
#include "fettle/design/problem/design_problem.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "fettle/adjoint/stepper/seeded_sweep.hpp"
#include "fettle/core/base/contract.hpp"
#include "fettle/core/model/build_model.hpp"
#include "fettle/design/problem/check_design.hpp"

namespace fettle::design::problem {

namespace {

using core::model::Model;
using description::Design;
using description::Simulated;

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

core::model::TermScales term_scales_of(const Model& model) {
    core::model::TermScales scales;
    for (const core::model::Body& body : model.bodies) scales.radii.push_back(body.radius);
    for (const core::model::MeasureTerm& term : model.mechanism.terms)
        if (term.kind == core::model::LawKind::stop) scales.stop_stiffness = term.coefficient;
    return scales;
}

// Vertices are looked at where parameters move them, and are named then.
bool is_finite(const adjoint::Seeds& seeds) {
    const adjoint::TrajectoryGradient& seed = seeds.trajectory_bar;
    for (const adjoint::BodyGradient& body : seeds.model_bar.bodies)
        if (!std::isfinite(body.density_bar)) return false;
    const auto is_finite_row = [](const auto& row) {
        return std::all_of(row.begin(), row.end(), [](const auto& x) { return x.allFinite(); });
    };
    if (!seeds.parameters_bar.allFinite()) return false;
    for (const auto* rows : {&seed.pose_bar, &seed.velocity_bar, &seed.lag_bar})
        if (!std::all_of(rows->begin(), rows->end(), is_finite_row)) return false;
    return is_finite_row(seed.multiplier_bar);
}

// By numbers alone: two designs that say the same are the same.
Design with_plain_places(Design design) {
    const core::scene::Scene scene = description::described_scene(design);
    for (core::scene::BoundNumber& number : design.numbers)
        number.place = pointer_to(scene, core::scene::find_place(scene, number.place).value());
    return design;
}

std::string name_of(const description::ObjectiveTerm& term) { return "objective `" + term.name + "`"; }
std::string name_of(const description::Constraint& constraint) { return "constraint `" + constraint.name + "`"; }

// d/d(parameters) of each: by the model, and what follows from parameters itself. Contract: parameters_bar is that of the seeds.
MatrixX rows_of(const MovedScene& moved, const Model& model, const std::vector<adjoint::ModelGradient>& gradients,
                const std::vector<VectorX>& parameters_bar, int parameter_count) {
    MatrixX rows(gradients.size(), parameter_count);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const auto k = static_cast<size_t>(i);
        rows.row(i) = pull_back(moved, model, gradients[k], parameter_count).transpose();
        if (parameters_bar[k].size() > 0) rows.row(i) += parameters_bar[k].transpose();
    }
    return rows;
}

std::vector<VectorX> parameters_bars(const std::vector<adjoint::Seeds>& seeds) {
    std::vector<VectorX> bars;
    for (const adjoint::Seeds& seed : seeds) bars.push_back(seed.parameters_bar);
    return bars;
}

}  // namespace

Simulated simulated_at(const Design& design, const DesignEvaluation& evaluation) {
    return {*evaluation.model, evaluation.simulation.trajectory, design.clearance_tolerance, description::names_of(design.parameters),
            evaluation.parameters};
}

Result<DesignProblem> DesignProblem::create(Design design) {
    core::model::BuildOptions options;
    options.check_start = false;  // parts that intersect at the parameters' values are a trial that cannot begin: other trials may
    Result<Model> model = core::model::build_model(design.scene, options);
    if (!model) return model.errors();
    const Errors errors = check_design(design, *model);
    if (!errors.empty()) return errors;
    DesignProblem problem;
    problem.warnings_ = model->warnings;
    if (const VectorX reference = description::references_of(design.parameters); reference != description::values_of(design.parameters)) {
        const Result<MovedScene> moved = move_scene(design, reference, SceneDerivative::not_wanted);
        model = moved ? core::model::build_model(moved->scene, options) : moved.errors();
        if (!model) return description::at_reference(model.errors());
    }
    for (const core::model::Body& body : model->bodies) problem.reference_points_.push_back(body.reference_point);
    problem.kappa_ = model->kappa;
    problem.term_scales_ = term_scales_of(*model);
    if (model->proximal_weight > 0) problem.proximal_weight_ = model->proximal_weight;
    // Their defaults are functions of the scene's size, which parameters change.
    design.scene.dhat = model->dhat;
    design.scene.velocity_tolerance = model->velocity_tolerance;
    problem.design_ = with_plain_places(std::move(design));
    return problem;
}

Result<Model> DesignProblem::build(const core::scene::Scene& scene) const {
    core::model::BuildOptions options;
    options.reference_points = reference_points_;
    options.kappa = kappa_;
    options.term_scales = term_scales_;
    options.proximal_weight = proximal_weight_;
    // The scene's were checked; what a shape makes that does not vouch for it has to be checked each time.
    options.check_meshes = std::any_of(design_.shapes.begin(), design_.shapes.end(),
                                       [](const auto& shape) { return shape != nullptr && !shape->is_always_solid(); });
    Result<Model> model = core::model::build_model(scene, options);
    if (model) model.value().for_gradient = true;
    return model;
}

Result<Model> DesignProblem::model_at(const VectorX& p) const {
    const Result<MovedScene> moved = move_scene(design_, p, SceneDerivative::not_wanted);
    if (!moved) return moved.errors();
    return build(moved->scene);
}

// A trial stands in no file: what is wrong with it is told by bodies and dimensions alone.
Result<MovedScene> DesignProblem::trial_scene(const VectorX& p, SceneDerivative derivative) const {
    Result<MovedScene> moved = move_scene(design_, p, derivative);
    if (moved) moved->scene.path.clear();
    return moved;
}

optimisers::Rows DesignProblem::relations(const VectorX& p) const {
    const auto k = static_cast<Eigen::Index>(design_.relations.size());
    optimisers::Rows all{VectorX(k), MatrixX(k, parameter_count())};
    for (Eigen::Index i = 0; i < k; ++i) {
        const description::RelationValue at = design_.relations[i].at(p);
        FETTLE_ASSERT(at.gradient.size() == p.size(), "a relation's gradient has one entry per parameter");
        all.values[i] = at.value;
        all.jacobian.row(i) = at.gradient.transpose();
    }
    return all;
}

// The relations that are not defined there.
Errors DesignProblem::undefined(const optimisers::Rows& relations) const {
    Errors errors;
    for (Eigen::Index i = 0; i < relations.values.size(); ++i) {
        if (std::isfinite(relations.values[i]) && relations.jacobian.row(i).allFinite()) continue;
        errors.push_back({ErrorCode::not_finite, "relation `" + design_.relations[i].name + "`",
                          "its value or its derivative is not a finite number here"});
    }
    return errors;
}

Errors DesignProblem::obstacles(const VectorX& p) const {
    Errors errors = undefined(relations(p));
    if (!errors.empty()) return errors;
    const Result<MovedScene> moved = trial_scene(p, SceneDerivative::not_wanted);
    if (!moved) return moved.errors();
    const Result<Model> model = build(moved->scene);
    return model ? Errors() : model.errors();
}

std::string DesignProblem::refusal(const VectorX& p) const {
    const Errors errors = obstacles(p);
    return errors.empty() ? std::string() : first_reason(errors);
}

DesignEvaluation DesignProblem::evaluate(const VectorX& p, const EvaluateOptions& options) const {
    const Stopwatch forward;
    DesignEvaluation evaluation;
    evaluation.parameters = p;
    evaluation.relations = relations(p);
    if (const Errors errors = undefined(evaluation.relations); !errors.empty()) {
        evaluation.reason = first_reason(errors);
        return evaluation;
    }
    const Result<MovedScene> moved = trial_scene(p, options.gradients ? SceneDerivative::wanted : SceneDerivative::not_wanted);
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
    simulate(options, evaluation);
    if (!evaluation.reason.empty()) {
        evaluation.forward_seconds = forward.seconds();
        return evaluation;
    }
    measure(evaluation);
    evaluation.usable = evaluation.reason.empty();
    evaluation.forward_seconds = forward.seconds();
    if (options.gradients && evaluation.usable) {
        const Stopwatch backward;
        differentiate(*moved, options.branches, evaluation);
        evaluation.backward_seconds = backward.seconds();
    }
    if (!evaluation.usable) evaluation.objective = evaluation.violation = std::nan("");
    return evaluation;
}

std::vector<int> DesignProblem::rest_constraints() const {
    std::vector<int> indices;
    for (size_t i = 0; i < design_.constraints.size(); ++i)
        if (design_.constraints[i].quantity->is_at_rest()) indices.push_back(static_cast<int>(i));
    return indices;
}

std::optional<optimisers::Rows> DesignProblem::rest_rows(const VectorX& p) const {
    const Result<MovedScene> moved = move_scene(design_, p);
    if (!moved) return std::nullopt;
    const Result<Model> model = build(moved->scene);
    if (!model) return std::nullopt;
    core::stepper::SimulationOptions nothing;
    nothing.steps = 0;
    const core::stepper::Trajectory start = core::stepper::simulate(*model, nothing).trajectory;
    const Simulated simulated{*model, start, design_.clearance_tolerance, description::names_of(design_.parameters), p};
    optimisers::Rows rows;
    std::vector<adjoint::Seeds> seeds;
    const std::vector<int> indices = rest_constraints();
    rows.values.resize(indices.size());
    for (const int i : indices) {
        const description::Quantity& quantity = *design_.constraints[i].quantity;
        const description::Measurement measured = quantity.value(simulated);
        rows.values[seeds.size()] = measured.value;
        seeds.push_back(adjoint::zero_seeds(*model, 0));
        quantity.add_seeds(simulated, measured, 1, seeds.back());
    }
    const std::vector<VectorX> bars = parameters_bars(seeds);
    const Result<std::vector<adjoint::ModelGradient>> gradients = adjoint::stepper::seeded_sweep(*model, start, std::move(seeds));
    if (!gradients) return std::nullopt;
    rows.jacobian = rows_of(*moved, *model, *gradients, bars, parameter_count());
    if (!rows.values.allFinite() || !rows.jacobian.allFinite()) return std::nullopt;
    return rows;
}

Result<DesignProblem> DesignProblem::with_contact_width(double dhat) const {
    Design design = design_;
    design.scene.dhat = dhat;
    return create(std::move(design));
}

// Sets the reason where it did not end well.
void DesignProblem::simulate(const EvaluateOptions& options, DesignEvaluation& evaluation) const {
    core::stepper::SimulationOptions simulation;
    simulation.steps = design_.steps;
    simulation.on_step = options.on_step;
    simulation.should_stop = options.should_stop;
    evaluation.simulation = core::stepper::simulate(*evaluation.model, simulation);
    const core::stepper::SimulationReport& report = evaluation.simulation.report;
    if (report.status == core::stepper::SimulationStatus::ok) return;
    evaluation.interrupted = report.status == core::stepper::SimulationStatus::interrupted;
    evaluation.reason = report.message.empty() ? core::stepper::to_string(report.status) : report.message;
}

// Sets the reason where a value is not a finite number. (A bound of it may be infinite: nothing is known on that side.)
void DesignProblem::measure(DesignEvaluation& evaluation) const {
    const Simulated simulated = simulated_at(design_, evaluation);
    const auto look_at = [&](const auto& of, const description::Measurement& measured) {
        if (std::isfinite(measured.value) && !std::isnan(measured.lower) && !std::isnan(measured.upper)) return;
        if (!evaluation.reason.empty()) return;
        const std::string why = of.quantity->explanation(measured);
        evaluation.reason = name_of(of) + ": its value is not a finite number" + (why.empty() ? "" : " (" + why + ")");
    };
    evaluation.objective = evaluation.violation = 0;
    for (const description::ObjectiveTerm& term : design_.objective) {
        evaluation.terms.push_back(term.quantity->value(simulated));
        evaluation.objective += term.weight * evaluation.terms.back().value / term.unit;
        look_at(term, evaluation.terms.back());
    }
    for (const auto& constraint : design_.constraints) {
        evaluation.constraints.push_back(constraint.quantity->value(simulated));
        look_at(constraint, evaluation.constraints.back());
        evaluation.violation = std::max(evaluation.violation, description::violation(constraint.bounds, evaluation.constraints.back()));
    }
    for (size_t i = 0; i < design_.relations.size(); ++i) {
        const double value = evaluation.relations.values[i];
        evaluation.violation = std::max(evaluation.violation, description::violation(design_.relations[i], value));
    }
}

void DesignProblem::differentiate(const MovedScene& moved, BranchReach reach, DesignEvaluation& evaluation) const {
    const Simulated simulated = simulated_at(design_, evaluation);
    const auto zero = [&] { return adjoint::zero_seeds(simulated.model, count_of(simulated.trajectory.steps)); };
    std::vector<adjoint::Seeds> seeds{zero()};
    const auto refuse = [&](const std::string& reason) {
        evaluation.usable = false;
        evaluation.reason = reason;
    };
    const std::string no_number = ": its derivative is not a finite number";
    for (size_t k = 0; k < design_.objective.size(); ++k) {
        const description::ObjectiveTerm& term = design_.objective[k];
        term.quantity->add_seeds(simulated, evaluation.terms[k], term.weight / term.unit, seeds[0]);
        if (!is_finite(seeds[0])) return refuse(name_of(term) + no_number);
    }
    for (size_t i = 0; i < design_.constraints.size(); ++i) {
        seeds.push_back(zero());
        design_.constraints[i].quantity->add_seeds(simulated, evaluation.constraints[i], 1, seeds.back());
        if (!is_finite(seeds.back())) return refuse(name_of(design_.constraints[i]) + no_number);
    }
    const size_t first_residual = seeds.size();
    std::vector<double> residuals;
    for (const description::ObjectiveTerm& term : design_.objective) {
        const double root = std::sqrt(std::max(0.0, term.weight / term.unit));
        const VectorX deviations = root > 0 ? term.quantity->deviations(simulated) : VectorX();
        for (Eigen::Index i = 0; i < deviations.size(); ++i) {
            residuals.push_back(root * deviations[i]);
            seeds.push_back(zero());
            term.quantity->add_deviation_seeds(simulated, static_cast<int>(i), root, seeds.back());
        }
    }
    const size_t first_branch = seeds.size();
    std::vector<QuantityBranches> branches = branches_of(design_, simulated, {evaluation.terms, evaluation.constraints}, reach);
    for (const QuantityBranches& quantity : branches) add_seeds(quantity, simulated, seeds);
    const std::vector<VectorX> bars = parameters_bars(seeds);
    const Result<std::vector<adjoint::ModelGradient>> gradients =
        adjoint::stepper::seeded_sweep(simulated.model, simulated.trajectory, std::move(seeds));
    if (!gradients) return refuse(first_reason(gradients.errors()));
    const MatrixX rows = rows_of(moved, *evaluation.model, *gradients, bars, parameter_count());
    for (int k = 0; k < parameter_count(); ++k) {
        const std::string by = ": its derivative by `" + design_.parameters[k].name + "` is not a finite number";
        if (!std::isfinite(rows(0, k))) return refuse("objective" + by);
        for (size_t i = 0; i < design_.constraints.size(); ++i)
            if (!std::isfinite(rows(static_cast<Eigen::Index>(i) + 1, k))) return refuse(name_of(design_.constraints[i]) + by);
    }
    evaluation.gradient = rows.row(0).transpose();
    evaluation.jacobian = rows.middleRows(1, design_.constraints.size());
    evaluation.residuals = Eigen::Map<const VectorX>(residuals.data(), residuals.size());
    evaluation.residual_jacobian = rows.middleRows(first_residual, evaluation.residuals.size());
    take_jacobians(rows.bottomRows(rows.rows() - static_cast<Eigen::Index>(first_branch)), evaluation.jacobian, branches);
    if (reach == BranchReach::tied) {
        evaluation.ties = ties_of(design_, branches);
    } else {
        evaluation.constraint_branches = constraint_rows(design_, branches);
        evaluation.objective_branches = objective_rows(design_, branches);
    }
}

}  // namespace fettle::design::problem
