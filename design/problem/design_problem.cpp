// SPDX-License-Identifier: MIT
#include "design/problem/design_problem.hpp"

#include <algorithm>
#include <cmath>

#include "adjoint/stepper/seeded_sweep.hpp"
#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"
#include "core/setup/build_model.hpp"
#include "design/description/made_design.hpp"
#include "design/problem/check_design.hpp"
#include "design/problem/evaluate_over_tolerances.hpp"
#include "design/problem/stopwatch.hpp"

namespace fettle::design::problem {

namespace {

using core::model::Model;
using description::Design;
using description::Simulated;

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

Errors in_scenario(const Design& design, int scenario, Errors errors) {
    for (Error& error : errors) error.where = scenario_prefix(design, scenario) + error.where;
    return errors;
}

void add_once(const std::string& text, std::vector<std::string>& texts) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
}

constexpr const char* no_number = ": its derivative is not a finite number";

std::string name_of(const description::ObjectiveTerm& term) { return "objective `" + term.name + "`"; }
std::string name_of(const description::Constraint& constraint) { return "constraint `" + constraint.name + "`"; }

// d/d(parameters) of each: by the model, and what follows from parameters itself. Contract: parameters_bar is that of the seeds.
MatrixX rows_of(const MovedScene& moved, const Model& model, const std::vector<adjoint::ModelGradient>& gradients,
                const std::vector<VectorX>& parameters_bar, int parameter_count) {
    MatrixX rows = pull_back(moved, model, gradients, parameter_count);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const auto k = static_cast<size_t>(i);
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

SimulatedDesign::SimulatedDesign(const Design& design, const DesignEvaluation& evaluation) {
    const std::vector<std::string> names = description::names_of(design.parameters);
    for (const Run& run : evaluation.runs)
        scenarios_.push_back({*run.model, run.simulation.trajectory, design.clearance_tolerance, names, evaluation.parameters,
                              count_of(scenarios_), nullptr});
    for (Simulated& scenario : scenarios_) scenario.scenarios = scenarios_.data();
}

Result<DesignProblem> DesignProblem::create(Design design) {
    core::setup::BuildOptions options;
    options.check_start = false;  // parts that intersect at the parameters' values are a trial that cannot begin: other trials may
    DesignProblem problem;
    std::vector<Model> models;
    for (int s = 0; s < description::scenario_count(design); ++s) {
        Result<Model> model = core::setup::build_model(description::design_of_scenario(design, s).scene, options);
        if (!model) return in_scenario(design, s, model.errors());
        for (const std::string& warning : model->warnings) add_once(warning, problem.warnings_);
        models.push_back(std::move(model).value());
    }
    const Errors errors = check_design(design, models);
    if (!errors.empty()) return errors;
    problem.design_ = std::move(design);
    for (int s = 0; s < count_of(models); ++s) {
        Result<Setting> setting = fixed(description::design_of_scenario(problem.design_, s), std::move(models[s]));
        if (!setting) return in_scenario(problem.design_, s, setting.errors());
        problem.settings_.push_back(std::move(setting).value());
        const Design& own = problem.settings_.back().design;
        if (problem.design_.scenarios.empty()) {
            problem.design_.scene = own.scene;
            problem.design_.numbers = own.numbers;
        } else {
            problem.design_.scenarios[s].scene = own.scene;
            problem.design_.scenarios[s].numbers = own.numbers;
        }
    }
    if (problem.design_.as_made) {
        Result<DesignProblem> made = create(problem.design_.as_made->design);
        if (!made) return made.errors();
        problem.as_made_ = std::make_shared<const DesignProblem>(std::move(made).value());
    }
    return problem;
}

// @param model  The model of the scene as written.
Result<DesignProblem::Setting> DesignProblem::fixed(Design design, Model model) {
    core::setup::BuildOptions options;
    options.check_start = false;
    if (const VectorX reference = description::references_of(design.parameters); reference != description::values_of(design.parameters)) {
        const Result<MovedScene> moved = move_scene(design, reference, SceneDerivative::not_wanted);
        Result<Model> there = moved ? core::setup::build_model(moved->scene, options) : moved.errors();
        if (!there) return description::at_reference(there.errors());
        model = std::move(there).value();
    }
    Setting setting;
    for (const core::model::Body& body : model.bodies) setting.reference_points.push_back(body.reference_point);
    setting.kappa = model.kappa;
    setting.facet_sides = model.facet_sides;
    setting.term_scales = term_scales_of(model);
    if (model.proximal_weight > 0) setting.proximal_weight = model.proximal_weight;
    // Their defaults are functions of the scene's size, which parameters change.
    design.scene.dhat = model.dhat;
    design.scene.velocity_tolerance = model.velocity_tolerance;
    setting.design = with_plain_places(std::move(design));
    return setting;
}

Result<Model> DesignProblem::build(const Setting& setting, const core::scene::Scene& scene) {
    core::setup::BuildOptions options;
    options.reference_points = setting.reference_points;
    options.kappa = setting.kappa;
    options.term_scales = setting.term_scales;
    options.proximal_weight = setting.proximal_weight;
    options.facet_sides = setting.facet_sides;
    // The scene's were checked; what a shape makes that does not vouch for it has to be checked each time.
    options.check_meshes = std::any_of(setting.design.shapes.begin(), setting.design.shapes.end(),
                                       [](const auto& shape) { return shape != nullptr && !shape->is_always_solid(); });
    Result<Model> model = core::setup::build_model(scene, options);
    if (model) model.value().for_gradient = true;
    return model;
}

Result<Model> DesignProblem::model_at(const VectorX& p, int scenario) const {
    const Setting& setting = settings_[scenario];
    const Result<MovedScene> moved = move_scene(setting.design, p, SceneDerivative::not_wanted);
    if (!moved) return in_scenario(design_, scenario, moved.errors());
    return build(setting, moved->scene);
}

// A trial stands in no file: what is wrong with it is told by bodies and dimensions alone.
Result<MovedScene> DesignProblem::trial_scene(const Setting& setting, const VectorX& p, SceneDerivative derivative) {
    Result<MovedScene> moved = move_scene(setting.design, p, derivative);
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
    for (int s = 0; s < scenario_count() && errors.empty(); ++s) {
        const Result<MovedScene> moved = trial_scene(settings_[s], p, SceneDerivative::not_wanted);
        const Result<Model> model = moved ? build(settings_[s], moved->scene) : Result<Model>(moved.errors());
        if (!model) errors = in_scenario(design_, s, model.errors());
    }
    return errors;
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
    if (as_made_) return evaluate_robust(p, options);
    const int m = scenario_count();
    evaluation.runs.resize(m);
    std::vector<MovedScene> moved(m);
    std::vector<std::string> reasons(m);
    const EvaluateOptions shared = m == 1 ? options : for_several(options);
    core::base::parallel_for(m, 1, [&](int s) {
        Result<MovedScene> scene = trial_scene(settings_[s], p, options.gradients ? SceneDerivative::wanted : SceneDerivative::not_wanted);
        Result<Model> model = scene ? build(settings_[s], scene->scene) : Result<Model>(scene.errors());
        if (!model) {
            reasons[s] = first_reason(model.errors());
            return;
        }
        moved[s] = std::move(scene).value();
        evaluation.runs[s].model = std::make_shared<const Model>(std::move(model).value());
        reasons[s] = simulate(s, shared, evaluation.runs[s]);
    });
    for (int s = 0; s < m; ++s) {
        evaluation.interrupted =
            evaluation.interrupted || evaluation.runs[s].simulation.report.status == core::stepper::SimulationStatus::interrupted;
        if (evaluation.reason.empty() && !reasons[s].empty()) evaluation.reason = scenario_prefix(design_, s) + reasons[s];
    }
    if (!evaluation.reason.empty()) {
        evaluation.forward_seconds = forward.seconds();
        return evaluation;
    }
    measure(evaluation);
    evaluation.usable = evaluation.reason.empty();
    evaluation.forward_seconds = forward.seconds();
    if (options.gradients && evaluation.usable) {
        if (options.on_values) options.on_values(evaluation);
        const Stopwatch backward;
        differentiate(moved, options.branches, evaluation);
        evaluation.backward_seconds = backward.seconds();
    }
    if (!evaluation.usable) evaluation.objective = evaluation.violation = std::nan("");
    return evaluation;
}

EvaluateAsMade DesignProblem::as_made() const {
    return {[this](const VectorX& at, const EvaluateOptions& asked) { return as_made_->evaluate(at, asked); },
            [this](const VectorX& at) { return as_made_->rest_rows(at); }, [this](const VectorX& at) { return as_made_->model_at(at); }};
}

DesignEvaluation DesignProblem::evaluate_robust(const VectorX& p, const EvaluateOptions& options) const {
    DesignEvaluation evaluation = evaluate_over_tolerances(design_, as_made(), p, options);
    evaluation.relations = relations(p);
    if (!evaluation.usable) return evaluation;
    for (size_t i = 0; i < design_.relations.size(); ++i)
        evaluation.violation = std::max(evaluation.violation, description::violation(design_.relations[i], evaluation.relations.values[i]));
    return evaluation;
}

std::vector<int> DesignProblem::rest_constraints() const {
    std::vector<int> indices;
    for (size_t i = 0; i < design_.constraints.size(); ++i)
        if (design_.constraints[i].quantity->is_at_rest()) indices.push_back(static_cast<int>(i));
    return indices;
}

std::optional<optimisers::Rows> DesignProblem::rest_rows(const VectorX& p) const {
    const std::vector<int> indices = rest_constraints();
    if (as_made_) {
        // Behind these the design as made has what its objective asks for.
        std::optional<optimisers::Rows> rows = as_made_->rest_rows(design_.as_made->extended(p));
        if (!rows) return rows;
        rows->values.conservativeResize(count_of(indices));
        rows->jacobian.conservativeResize(count_of(indices), rows->jacobian.cols());
        if (!add_reserves(design_, as_made(), p, indices, *rows)) return std::nullopt;
        return rows;
    }
    optimisers::Rows rows{VectorX(indices.size()), MatrixX::Zero(static_cast<Eigen::Index>(indices.size()), parameter_count())};
    DesignEvaluation rest;  // of no step
    rest.parameters = p;
    std::vector<MovedScene> moved;
    for (const Setting& setting : settings_) {
        Result<MovedScene> scene = move_scene(setting.design, p);
        if (!scene) return std::nullopt;
        Result<Model> model = build(setting, scene->scene);
        if (!model) return std::nullopt;
        core::stepper::SimulationOptions nothing;
        nothing.steps = 0;
        Run run{std::make_shared<const Model>(std::move(model).value()), {}};
        run.simulation = core::stepper::simulate(*run.model, nothing);
        rest.runs.push_back(std::move(run));
        moved.push_back(std::move(scene).value());
    }
    const SimulatedDesign simulated(design_, rest);
    std::vector<description::Measurement> measured;
    for (const int i : indices) measured.push_back(design_.constraints[i].quantity->value(simulated.in(0)));
    for (size_t k = 0; k < indices.size(); ++k) rows.values[k] = measured[k].value;
    for (int s = 0; s < scenario_count(); ++s) {
        const Run& run = rest.runs[s];
        std::vector<adjoint::Seeds> seeds;
        std::vector<Eigen::Index> targets;
        for (size_t k = 0; k < indices.size(); ++k) {
            const description::Quantity& quantity = *design_.constraints[indices[k]].quantity;
            if (!quantity.is_about(s)) continue;
            targets.push_back(static_cast<Eigen::Index>(k));
            seeds.push_back(adjoint::zero_seeds(*run.model, 0));
            quantity.add_seeds(simulated.in(s), measured[k], 1, seeds.back());
        }
        const std::vector<VectorX> bars = parameters_bars(seeds);
        const Result<std::vector<adjoint::ModelGradient>> gradients =
            adjoint::stepper::seeded_sweep(*run.model, run.simulation.trajectory, std::move(seeds));
        if (!gradients) return std::nullopt;
        const MatrixX own = rows_of(moved[s], *run.model, *gradients, bars, parameter_count());
        for (size_t k = 0; k < targets.size(); ++k) rows.jacobian.row(targets[k]) += own.row(static_cast<Eigen::Index>(k));
    }
    if (!rows.values.allFinite() || !rows.jacobian.allFinite()) return std::nullopt;
    return rows;
}

Result<DesignProblem> DesignProblem::with_contact_width(double dhat, Surfaces surfaces) const {
    Design design = design_;
    description::change_scenes(design, [&](core::scene::Scene& scene) {
        scene.dhat = dhat;
        if (surfaces == Surfaces::facets) scene.round_contact = false;
    });
    return create(std::move(design));
}

// @return why it did not end well; empty: it did.
std::string DesignProblem::simulate(int scenario, const EvaluateOptions& options, Run& run) const {
    core::stepper::SimulationOptions simulation;
    simulation.steps = settings_[scenario].design.steps;
    if (scenario == 0) simulation.on_step = options.on_step;
    simulation.should_stop = options.should_stop;
    simulation.outputs = simulation.last_outputs_only = options.balance;
    simulation.for_gradient = true;  // forces of contact are made of what its steps keep, with derivatives and without
    run.simulation = core::stepper::simulate(*run.model, simulation);
    const core::stepper::SimulationReport& report = run.simulation.report;
    if (report.status == core::stepper::SimulationStatus::ok) return {};
    return report.message.empty() ? core::stepper::to_string(report.status) : report.message;
}

// Sets the reason where a value is not a finite number. (A bound of it may be infinite: nothing is known on that side.)
void DesignProblem::measure(DesignEvaluation& evaluation) const {
    const SimulatedDesign all(design_, evaluation);
    const Simulated& simulated = all.in(0);
    const auto look_at = [&](const auto& of, const description::Measurement& measured) {
        if (std::isfinite(measured.value) && !std::isnan(measured.lower) && !std::isnan(measured.upper)) return;
        if (!evaluation.reason.empty()) return;
        const std::string why = measured.fault.empty() ? of.quantity->explanation(measured) : measured.fault;
        evaluation.reason = name_of(of) + ": its value is not a finite number" + (why.empty() ? "" : " (" + why + ")");
    };
    evaluation.objective = evaluation.violation = 0;
    for (const description::ObjectiveTerm& term : design_.objective) {
        evaluation.terms.push_back(term.quantity->value(simulated));
        evaluation.objective += term.weight * evaluation.terms.back().value / term.unit;
        look_at(term, evaluation.terms.back());
    }
    for (const auto& constraint : design_.constraints) {
        const description::Measurement measured = constraint.quantity->value(simulated);
        look_at(constraint, measured);
        evaluation.violation = std::max(evaluation.violation, description::violation(constraint.bounds, measured));
        if (const auto row = constraint.quantity->continuation(simulated, measured, constraint.bounds))
            evaluation.continued.push_back({count_of(evaluation.constraints), row->value, row->reason, {}});
        evaluation.constraints.push_back(measured);
    }
    for (size_t i = 0; i < design_.relations.size(); ++i) {
        const double value = evaluation.relations.values[i];
        evaluation.violation = std::max(evaluation.violation, description::violation(design_.relations[i], value));
    }
}

/// Targets: 0 the objective, then the constraints, then the objective's deviations, then the constraints that are continued.
struct DesignProblem::Share {
    MatrixX rows;
    std::vector<Eigen::Index> targets;  // of the rows
    std::vector<QuantityBranches> branches;
    MatrixX branch_rows;
};

namespace {

/// A deviation of a term, times the root of its weight.
struct Deviation {
    size_t term = 0;
    int index = 0;
    double root = 0;
    double value = 0;
};

// To those of the same quantity in other scenarios; the branch that the value is comes first.
void join(QuantityBranches&& more, double value, std::vector<QuantityBranches>& all) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const QuantityBranches& other) {
        return other.of_objective == more.of_objective && other.index == more.index;
    });
    if (same == all.end()) return all.push_back(std::move(more));
    MatrixX both(same->jacobian.rows() + more.jacobian.rows(), more.jacobian.cols());
    both << same->jacobian, more.jacobian;
    same->jacobian = std::move(both);
    for (description::Branch& branch : more.branches) same->branches.push_back(std::move(branch));
    size_t k = 0;
    while (k + 1 < same->branches.size() && same->branches[k].value != value) ++k;
    std::swap(same->branches[0], same->branches[k]);
    same->jacobian.row(0).swap(same->jacobian.row(static_cast<Eigen::Index>(k)));
}

std::vector<Deviation> deviations_of(const Design& design, const Simulated& simulated) {
    std::vector<Deviation> all;
    for (size_t k = 0; k < design.objective.size(); ++k) {
        const description::ObjectiveTerm& term = design.objective[k];
        const double root = std::sqrt(std::max(0.0, term.weight / term.unit));
        const VectorX deviations = root > 0 ? term.quantity->deviations(simulated) : VectorX();
        for (int i = 0; i < deviations.size(); ++i) all.push_back({k, i, root, root * deviations[i]});
    }
    return all;
}

}  // namespace

Result<DesignProblem::Share> DesignProblem::share_of(int s, const MovedScene& moved, const SimulatedDesign& all, BranchReach reach,
                                                     const DesignEvaluation& evaluation) const {
    const Simulated& simulated = all.in(s);
    Share share;
    std::vector<adjoint::Seeds> seeds;
    const auto row = [&](Eigen::Index target) -> adjoint::Seeds& {
        share.targets.push_back(target);
        seeds.push_back(adjoint::zero_seeds(simulated.model, count_of(simulated.trajectory.steps)));
        return seeds.back();
    };
    const auto refused = [&](const std::string& what) { return Error{ErrorCode::not_finite, "", what + no_number}; };
    const bool is_first = s == 0;
    const auto is_about_objective = [&] {
        return std::any_of(design_.objective.begin(), design_.objective.end(),
                           [&](const auto& term) { return term.quantity->is_about(s); });
    };
    if (is_first || is_about_objective()) {
        adjoint::Seeds& objective = row(0);
        for (size_t k = 0; k < design_.objective.size(); ++k) {
            const description::ObjectiveTerm& term = design_.objective[k];
            if (!term.quantity->is_about(s)) continue;
            term.quantity->add_seeds(simulated, evaluation.terms[k], term.weight / term.unit, objective);
            if (!is_finite(objective)) return refused(name_of(term));
        }
    }
    for (size_t i = 0; i < design_.constraints.size(); ++i) {
        const description::Constraint& constraint = design_.constraints[i];
        if (!constraint.quantity->is_about(s)) continue;
        adjoint::Seeds& own = row(static_cast<Eigen::Index>(i) + 1);
        constraint.quantity->add_seeds(simulated, evaluation.constraints[i], 1, own);
        if (!is_finite(own)) return refused(name_of(constraint));
    }
    Eigen::Index target = count_of(design_.constraints) + 1;
    for (const Deviation& deviation : deviations_of(design_, simulated)) {
        const description::Quantity& quantity = *design_.objective[deviation.term].quantity;
        if (quantity.is_about(s)) quantity.add_deviation_seeds(simulated, deviation.index, deviation.root, row(target));
        ++target;
    }
    for (const ContinuedRow& continued : evaluation.continued) {
        const description::Constraint& constraint = design_.constraints[continued.constraint];
        const auto continuation =
            constraint.quantity->is_about(s)
                ? constraint.quantity->continuation(simulated, evaluation.constraints[continued.constraint], constraint.bounds)
                : std::nullopt;
        if (continuation) continuation->add_seeds(1, row(target));
        ++target;
    }
    const auto first_branch = static_cast<Eigen::Index>(seeds.size());
    share.branches = branches_of(design_, simulated, {evaluation.terms, evaluation.constraints}, reach);
    for (const QuantityBranches& quantity : share.branches) add_seeds(quantity, simulated, seeds);
    const std::vector<VectorX> bars = parameters_bars(seeds);
    const Result<std::vector<adjoint::ModelGradient>> gradients =
        adjoint::stepper::seeded_sweep(simulated.model, simulated.trajectory, std::move(seeds));
    if (!gradients) return gradients.errors();
    const MatrixX rows = rows_of(moved, simulated.model, *gradients, bars, parameter_count());
    share.rows = rows.topRows(first_branch);
    share.branch_rows = rows.bottomRows(rows.rows() - first_branch);
    return share;
}

void DesignProblem::differentiate(const std::vector<MovedScene>& moved, BranchReach reach, DesignEvaluation& evaluation) const {
    const SimulatedDesign simulated(design_, evaluation);
    const auto refuse = [&](const std::string& reason) {
        evaluation.usable = false;
        evaluation.reason = reason;
    };
    std::vector<std::optional<Result<Share>>> found(moved.size());
    core::base::parallel_for(count_of(moved), 1, [&](int s) { found[s].emplace(share_of(s, moved[s], simulated, reach, evaluation)); });
    for (int s = 0; s < count_of(found); ++s)
        if (!*found[s]) return refuse(scenario_prefix(design_, s) + first_reason(found[s]->errors()));
    const std::vector<Deviation> deviations = deviations_of(design_, simulated.in(0));
    const Eigen::Index constraints = count_of(design_.constraints), residuals = count_of(deviations);
    const Eigen::Index continued = count_of(evaluation.continued);
    MatrixX rows = MatrixX::Zero(1 + constraints + residuals + continued, parameter_count());
    for (const auto& share : found)
        for (size_t k = 0; k < (*share)->targets.size(); ++k)
            rows.row((*share)->targets[k]) += (*share)->rows.row(static_cast<Eigen::Index>(k));
    for (int k = 0; k < parameter_count(); ++k) {
        const std::string by = ": its derivative by `" + design_.parameters[k].name + "` is not a finite number";
        if (!std::isfinite(rows(0, k))) return refuse("objective" + by);
        for (Eigen::Index i = 0; i < constraints; ++i)
            if (!std::isfinite(rows(i + 1, k))) return refuse(name_of(design_.constraints[i]) + by);
    }
    evaluation.gradient = rows.row(0).transpose();
    evaluation.jacobian = rows.middleRows(1, constraints);
    evaluation.residuals.resize(residuals);
    for (Eigen::Index i = 0; i < residuals; ++i) evaluation.residuals[i] = deviations[i].value;
    evaluation.residual_jacobian = rows.middleRows(1 + constraints, residuals);
    for (Eigen::Index i = 0; i < continued; ++i)
        evaluation.continued[static_cast<size_t>(i)].gradient = rows.row(1 + constraints + residuals + i).transpose();
    std::vector<QuantityBranches> branches;
    for (auto& share : found) {
        take_jacobians((*share)->branch_rows, evaluation.jacobian, (*share)->branches);
        for (QuantityBranches& quantity : (*share)->branches) {
            const double value = (quantity.of_objective ? evaluation.terms : evaluation.constraints)[quantity.index].value;
            join(std::move(quantity), value, branches);
        }
    }
    if (reach == BranchReach::tied) {
        evaluation.ties = ties_of(design_, branches);
    } else {
        evaluation.constraint_branches = constraint_rows(design_, branches);
        evaluation.objective_branches = objective_rows(design_, branches);
    }
}

}  // namespace fettle::design::problem
