// SPDX-License-Identifier: MIT
#include "adjoint/stepper/step_linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "adjoint/energy/contact_terms_adjoint.hpp"
#include "adjoint/energy/incremental_potential_adjoint.hpp"
#include "core/energy/measure_terms.hpp"
#include "core/energy/start_history.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/model/row_choice.hpp"
#include "core/solver/row_system.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::kinematics::pose_matrix;

// Implicit Euler's, and BDF2's of its first step and of bodies that are driven altogether; a quasi-static step does not look at them.
std::vector<Matrix34> velocities_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    std::vector<Matrix34> velocities(model.bodies.size());
    for (std::size_t i = 0; i < velocities.size(); ++i)
        velocities[i] = t == 0 ? model.bodies[i].velocity_start
                               : Matrix34((pose_matrix(trajectory.poses[t][i]) - pose_matrix(trajectory.poses[t - 1][i])) / model.timestep);
    return velocities;
}

// BDF2's: (P - P_slip)/(2h/3).
std::vector<Matrix34> bdf2_velocities_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    std::vector<Matrix34> velocities = velocities_at(model, trajectory, t);
    for (std::size_t i = 0; t > 1 && i < velocities.size(); ++i) {
        if (!core::energy::has_free_dof(model.bodies[i])) continue;
        const Matrix34 slip = (4 * pose_matrix(trajectory.poses[t - 1][i]) - pose_matrix(trajectory.poses[t - 2][i])) / 3;
        velocities[i] = (pose_matrix(trajectory.poses[t][i]) - slip) / (2 * model.timestep / 3);
    }
    return velocities;
}

core::energy::History history_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                                 const SweepHistory& sweep) {
    const std::vector<double>& angles = sweep.angles[t];
    if (model.integrator == core::scene::Integrator::newmark)
        return {trajectory.poses[t], sweep.newmark.velocities[t], {}, {}, sweep.newmark.accelerations[t], angles};
    core::energy::History out{trajectory.poses[t], velocities_at(model, trajectory, t), {}, {}, {}, angles};
    if (model.integrator != core::scene::Integrator::bdf2 || t == 0) return out;
    out.velocities = bdf2_velocities_at(model, trajectory, t);
    out.velocities_before = bdf2_velocities_at(model, trajectory, t - 1);
    for (const core::kinematics::Pose& pose : trajectory.poses[t - 1]) out.poses_before.push_back(pose_matrix(pose));
    return out;
}

// The rows' part of the Lagrangian.
void add_rows(StepSolver& solver, LinearisedStep& step) {
    const core::model::Mechanism& mechanism = step.problem.model->mechanism;
    const std::vector<core::measure::PlacedFrame> frames = placed(mechanism.set.frames, step.poses);
    step.rows = row_jacobian(mechanism.set, mechanism.rows, frames);
    std::vector<Vector3> rotation_vectors;
    std::vector<Matrix3> left_jacobians;
    for (const core::kinematics::ChartPoint& p : step.points) {
        rotation_vectors.push_back(p.rotation_vector);
        left_jacobians.push_back(core::kinematics::left_jacobian(p.rotation_vector));
    }
    core::constraint::to_chart(left_jacobians, step.rows);
    const auto add_curvature = [&](const VectorX& multipliers) {
        add_row_curvature(mechanism.set, mechanism.rows, multipliers, frames, rotation_vectors, step.derivatives.hessian);
    };
    add_curvature(VectorX::Zero(step.rows.count()));  // the pattern
    step.multipliers = solver.multipliers(step);
    add_curvature(step.multipliers);
    add_transposed(step.rows, step.multipliers, step.derivatives.gradient);
}

// Per body: the sizes of the forces of every contact, each by itself. Their sum is next to nothing for a ball between two walls. Damping
// counts with the contacts that it acts at.
std::vector<double> contact_magnitudes(const LinearisedStep& step) {
    const core::energy::StepProblem& problem = step.problem;
    const core::model::Model& model = *problem.model;
    std::vector<double> out(model.bodies.size(), 0.0);
    for (const core::contact::BodyPairContacts& list : step.contacts.pairs)
        for (const core::contact::ContactPair& pair : list.contacts) {
            const double force = normal_force(pair, problem.barrier);
            out[list.first] += force;
            out[list.second] += force;
        }
    for (const core::contact::BodyPairFriction& list : problem.friction.pairs)
        for (const core::contact::FrictionContact& contact : list.contacts) {
            const double force = friction_force(problem.friction, list, contact, step.poses).norm();
            out[list.first] += force;
            out[list.second] += force;
        }
    return out;
}

}  // namespace

bool rotates_freely(const core::model::Body& body) { return is_free(body, 3) && is_free(body, 4) && is_free(body, 5); }

StepSolver::StepSolver(const core::model::Model& model) : system_(free_dofs(model)) {}

Errors StepSolver::check_balance(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step) const {
    const core::model::Model& model = *step.problem.model;
    std::vector<double> magnitude = step.derivatives.force_magnitude, contacts;
    for (int row = 0; row < step.rows.count(); ++row)
        for (int k = step.rows.first[row]; k < step.rows.first[row + 1]; ++k) {
            const core::linear::RowGradient& e = step.rows.entries[k];
            const double arm = std::max(model.bodies[e.body].radius, model.dhat);
            magnitude[e.body] += std::abs(step.multipliers[row]) * (e.gradient.head<3>().norm() + e.gradient.tail<3>().norm() / arm);
        }
    for (std::size_t i = 0; i < magnitude.size(); ++i) {
        const core::model::Body& body = model.bodies[i];
        Vector6 g = step.derivatives.gradient[i];
        g.tail<3>() /= std::max(body.radius, model.dhat);
        for (int k = 0; k < 6; ++k)
            if (dofs().index[i][k] < 0) g[k] = 0;
        const double mass = body.moments(3, 3), places = mass * rounding_of_places * model.diagonal;
        double size = magnitude[i] + mass * model.velocity_tolerance * model.timestep;
        if (g.norm() <= balanced * size + places) continue;
        // `force_magnitude` has the sum of the contacts' forces, in which forces against one another cancel.
        if (contacts.empty()) contacts = contact_magnitudes(step);
        size += contacts[i];
        if (g.norm() <= balanced * size + places) continue;
        std::ostringstream message;
        message << "the step at t = " << trajectory.time_start + t * trajectory.timestep << " s has no derivative: '" << body.name
                << "' is out of balance by " << g.norm() / size
                << " of the forces on it, too much to be differentiated. A lower `velocity_tolerance` may help, or `implicit_euler` in "
                   "place of "
                   "`quasi_static` (a trajectory from elsewhere: simulate it for gradients, from this model)";
        return {{core::base::ErrorCode::inconsistent, "step " + std::to_string(t), message.str()}};
    }
    return {};
}

Errors StepSolver::check_rows(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step) {
    constexpr double met = 1e-10;  // of the scene's size; simulations for gradients meet them to 1e-12
    const double gap = step.rows.count() > 0 ? core::solver::largest_gap(step.problem, step.poses) : 0;
    if (gap <= met * step.problem.model->diagonal) return {};
    std::ostringstream message;
    message << "the step at t = " << trajectory.time_start + t * trajectory.timestep << " s has no derivative: joints or motors are " << gap
            << " m from being met, too much to be differentiated (a trajectory from elsewhere: simulate it for gradients, from this model)";
    return {{core::base::ErrorCode::inconsistent, "step " + std::to_string(t), message.str()}};
}

// Checks the areas of an area-weighted barrier.
Errors StepSolver::check_areas(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step) {
    const core::model::Model& model = *step.problem.model;
    core::contact::ContactAreas areas = contact::areas_of_contacts(model, step.poses);
    if (areas.equal.empty() && step.lag) areas = step.lag->areas;
    if (areas.equal.empty()) return {};
    const core::contact::EqualAreas& e = areas.equal.front();
    Errors errors{energy::refusal("step " + std::to_string(t),
                                  "the step at t = " + std::to_string(trajectory.time_start + t * trajectory.timestep) + " s: edge " +
                                      std::to_string(e.edge_a) + " of '" + model.bodies[e.body_a].name + "' and edge " +
                                      std::to_string(e.edge_b) + " of '" + model.bodies[e.body_b].name +
                                      "' have the same area, of which the area-weighted barrier takes the lesser; that")};
    errors.back().message += "; switch `area_weighted` off";
    return errors;
}

Errors StepSolver::unsolved(const core::stepper::Trajectory& trajectory, int t) {
    const double time = trajectory.time_start + t * trajectory.timestep;
    return {
        {core::base::ErrorCode::inconsistent, "step " + std::to_string(t),
         "the step at t = " + std::to_string(time) +
             " s has no derivative: its equations' matrix is singular. Is a body left without mass, is a linkage at a dead centre, or was "
             "the trajectory simulated from another model?"}};
}

Errors StepSolver::unsettled(const core::stepper::Trajectory& trajectory, int t) {
    const double time = trajectory.time_start + t * trajectory.timestep;
    return {{core::base::ErrorCode::inconsistent, "step " + std::to_string(t),
             "the step at t = " + std::to_string(time) +
                 " s has no derivative: friction jams, its normal forces depend on themselves and do not settle"}};
}

Errors StepSolver::factorise(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step) {
    if (!step.multipliers.allFinite()) return unsolved(trajectory, t);
    if (Errors errors = check_rows(trajectory, t, step); !errors.empty()) return errors;
    if (Errors errors = check_balance(trajectory, t, step); !errors.empty()) return errors;
    if (Errors errors = check_areas(trajectory, t, step); !errors.empty()) return errors;
    ++counts_.factorisations;
    if (system_.factorise_any(step.derivatives.hessian, step.rows)) return {};
    return unsolved(trajectory, t);
}

// Rounding leaves a part that grows with the stiffness of contact; a singular matrix leaves all of the right-hand side, or no number.
StepSolver::Solution StepSolver::solve(const LinearisedStep& step, const MatrixX& rhs, const MatrixX& of_rows) const {
    constexpr double solved = 1e-2;
    ++counts_.solves;
    const core::kinematics::BlockHessian& hessian = step.derivatives.hessian;
    const core::linear::LinearSystem::Solution x = system_.solve_refined(hessian, step.rows, rhs, of_rows),
                                               left = system_.residual(hessian, step.rows, rhs, of_rows, x);
    Solution out{x.y, x.multipliers};
    for (Eigen::Index k = 0; k < rhs.cols(); ++k) {
        const bool has_rows = step.rows.count() > 0;
        const double rest = left.y.col(k).norm() + (has_rows ? left.multipliers.col(k).norm() : 0),
                     all = rhs.col(k).norm() + (has_rows ? of_rows.col(k).norm() : 0);
        out.is_one = out.is_one && rest <= solved * all;
    }
    return out;
}

VectorX StepSolver::multipliers(const LinearisedStep& step) {
    core::kinematics::BlockHessian weight = step.derivatives.hessian;  // the same pattern: one analysis serves both
    for (std::size_t i = 0; i < weight.diagonal.size(); ++i) {
        Matrix6 to_tangent = Matrix6::Identity();
        to_tangent.bottomRightCorner<3, 3>() = core::kinematics::left_jacobian(step.points[i].rotation_vector);
        const Matrix6 mass = core::kinematics::mass_matrix(step.poses[i].rotation, step.problem.model->bodies[i].moments);
        weight.diagonal[i] = to_tangent.transpose() * mass * to_tangent;
    }
    for (core::kinematics::OffDiagonalBlock& b : weight.off_diagonal) b.block.setZero();
    ++counts_.factorisations;
    ++counts_.solves;
    system_.factorise(weight, step.rows);
    const VectorX force = -gather(dofs(), step.derivatives.gradient);
    return system_.solve_refined(weight, step.rows, force, VectorX::Zero(step.rows.count())).multipliers;
}

std::vector<std::vector<double>> angles_along(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    std::vector<std::vector<double>> out{model.mechanism.angles_start};
    for (std::size_t t = 1; t < trajectory.poses.size(); ++t)
        out.push_back(core::constraint::angles_at(model.mechanism.set, trajectory.poses[t], out.back()));
    return out;
}

namespace {

std::vector<std::shared_ptr<const core::model::Model>> models_along(const core::model::Model& model,
                                                                    const core::stepper::Trajectory& trajectory) {
    std::vector<std::shared_ptr<const core::model::Model>> out(trajectory.steps.size());
    std::map<std::vector<int>, std::shared_ptr<const core::model::Model>> known;  // by the rows that are left out
    for (std::size_t t = 0; t < out.size() && !model.mechanism.dependent.empty(); ++t) {
        const auto left_out = rows_to_leave_out(model, trajectory.poses[t + 1]);
        if (!left_out) continue;
        std::shared_ptr<const core::model::Model>& of_these = known[*left_out];
        if (!of_these) of_these = std::make_shared<const core::model::Model>(without_rows(model, *left_out));
        out[t] = of_these;
    }
    return out;
}

}  // namespace

VectorX by_number(const LinearisedStep& step, const VectorX& values) {
    const core::model::Mechanism& mechanism = step.problem.model->mechanism;
    VectorX out = VectorX::Zero(mechanism.rows.size() + mechanism.dependent.size());
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) out[mechanism.rows[i].number] = values[i];
    return out;
}

VectorX of_rows(const LinearisedStep& step, const VectorX& by_number) {
    const std::vector<core::constraint::Row>& rows = step.problem.model->mechanism.rows;
    VectorX out(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) out[i] = by_number[rows[i].number];
    return out;
}

SweepHistory sweep_history(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    SweepHistory out{angles_along(model, trajectory), {}, models_along(model, trajectory)};
    if (model.integrator != core::scene::Integrator::newmark) return out;
    core::energy::History now = core::energy::start_history(model);
    now.poses = trajectory.poses[0];
    for (std::size_t t = 0; t + 1 < trajectory.poses.size(); ++t) {
        out.newmark.velocities.push_back(now.velocities);
        out.newmark.accelerations.push_back(now.accelerations);
        now = advanced(model, now, integration_step(model, now), trajectory.poses[t + 1]);
    }
    return out;
}

core::energy::StepProblem problem_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                                     const SweepHistory& history) {
    const core::model::Model& solved = history.models[t] ? *history.models[t] : model;
    core::energy::StepProblem problem = core::energy::step_problem(solved, history_at(model, trajectory, t, history), model.kappa);
    set_end_time(problem, t * model.timestep + model.timestep);
    return problem;
}

StepRounds::StepRounds(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t, const SweepHistory& history,
                       std::shared_ptr<const contact::LaggedContacts> known)
    : problem_(problem_at(model, trajectory, t, history)), known_(std::move(known)) {
    const core::stepper::TrajectoryStep& step = trajectory.steps[t];
    const bool frictional = energy::has_friction(model);
    is_fixed_point_ = frictional && model.integrator == core::scene::Integrator::quasi_static;
    const auto kept = [](const core::stepper::TrajectoryStep& of, std::size_t round) {
        return round < of.contacts.size() ? of.contacts[round].get() : nullptr;
    };
    const auto last_kept = [](const core::stepper::TrajectoryStep& of) { return of.contacts.empty() ? nullptr : of.contacts.back().get(); };
    if (frictional && !is_fixed_point_) {
        add_end({}, trajectory.poses[t], t > 0 ? last_kept(trajectory.steps[static_cast<std::size_t>(t) - 1]) : nullptr);
        for (std::size_t r = 0; r + 1 < step.friction_rounds.size(); ++r)
            add_end(step.friction_rounds[r], poses_of(problem_, step.friction_rounds[r]), kept(step, r));
    } else {
        ends_.emplace_back();
    }
    add_end(step.nodes.back(), trajectory.poses[t + 1], last_kept(step));
    if (is_fixed_point_) ends_.front() = ends_.back();
}

void StepRounds::add_end(std::vector<core::kinematics::ChartPoint> points, std::vector<core::kinematics::Pose> poses,
                         const core::stepper::KeptContacts* kept) {
    const core::model::Model& model = *problem_.model;
    const auto same = [](const core::kinematics::Pose& a, const core::kinematics::Pose& b) {
        return a.position == b.position && a.rotation == b.rotation;
    };
    if (known_ && std::equal(poses.begin(), poses.end(), known_->poses.begin(), known_->poses.end(), same)) {
        ends_.push_back({std::move(points), known_});
        return;
    }
    if (kept != nullptr && !model.area_weighted && are_of(*kept, model, poses)) {
        ends_.push_back({std::move(points),
                         std::make_shared<const contact::LaggedContacts>(contact::LaggedContacts{std::move(poses), kept->contacts, {}})});
        return;
    }
    const core::ccd::Candidates candidates = core::ccd::find_candidates(model, poses, 0);
    contact::LaggedContacts at{std::move(poses), {}, {}};
    at.contacts = core::contact::find_contacts(model, candidates, at.poses);
    if (model.area_weighted) at.areas = core::contact::contact_areas(model, candidates, at.poses);
    ends_.push_back({std::move(points), std::make_shared<const contact::LaggedContacts>(std::move(at))});
}

LinearisedStep StepRounds::linearise(int round, StepSolver& solver) const {
    const core::model::Model& model = *problem_.model;
    const End& end = ends_[round];
    LinearisedStep step;
    step.problem = problem_;
    step.poses = end.at->poses;
    step.points = end.points;
    step.contacts = end.at->contacts;
    step.lag = ends_[static_cast<std::size_t>(round) - 1].at;
    if (step.lag)
        step.problem.friction = core::contact::lag_friction(model, step.lag->contacts, step.lag->poses, problem_.barrier,
                                                            problem_.slip_reference, problem_.slip_time);
    solver.count_assembly();
    step.derivatives =
        core::energy::chart_derivatives(step.problem, step.points, step.poses, step.contacts, core::contact::HessianKind::exact);
    if (!model.mechanism.rows.empty()) add_rows(solver, step);
    return step;
}

LinearisedStep linearise_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                              const SweepHistory& history, StepSolver& solver) {
    const StepRounds rounds(model, trajectory, t, history);
    return rounds.linearise(rounds.count(), solver);
}

}  // namespace fettle::adjoint::stepper
