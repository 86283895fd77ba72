// SPDX-License-Identifier: MIT
#include "fettle/adjoint/stepper/step_linearisation.hpp"

#include <cmath>
#include <numbers>

#include "fettle/adjoint/energy/incremental_potential_adjoint.hpp"
#include "fettle/core/base/contract.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::kinematics::pose_matrix;

// Implicit Euler's; a quasi-static step does not look at them.
std::vector<Matrix34> velocities_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    std::vector<Matrix34> velocities(model.bodies.size());
    for (std::size_t i = 0; i < velocities.size(); ++i)
        velocities[i] = t == 0 ? model.bodies[i].velocity_start
                               : Matrix34((pose_matrix(trajectory.poses[t][i]) - pose_matrix(trajectory.poses[t - 1][i])) / model.timestep);
    return velocities;
}

Errors check_integrator(const core::model::Model& model) {
    using core::scene::Integrator;
    if (model.integrator == Integrator::implicit_euler || model.integrator == Integrator::quasi_static) return {};
    const std::string name = model.integrator == Integrator::bdf2 ? "bdf2" : "newmark";
    Errors errors{energy::refusal("integrator", "a simulation by `" + name + "`")};
    errors.back().message += "; `implicit_euler` and `quasi_static` can";
    return errors;
}

Errors check_scripts(const core::model::Model& model) {
    Errors errors;
    for (const core::model::Body& body : model.bodies) {
        if (body.script.empty()) continue;
        errors.push_back(energy::refusal(body.name, "'" + body.name + "' follows a script of poses, which"));
        errors.back().message += "; prescribed coordinates can";
    }
    return errors;
}

}  // namespace

bool rotates_freely(const core::model::Body& body) { return is_free(body, 3) && is_free(body, 4) && is_free(body, 5); }

LinearisedStep linearise_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    LinearisedStep step;
    step.problem = core::energy::step_problem(model, {trajectory.poses[t], velocities_at(model, trajectory, t), {}, {}, {}}, model.kappa);
    step.poses = trajectory.poses[t + 1];
    step.points = trajectory.steps[t].nodes.back();
    const core::contact::Candidates candidates = core::contact::find_candidates(model, step.poses, 0);
    step.contacts = core::contact::find_contacts(model, candidates, step.poses);
    step.derivatives =
        core::energy::chart_derivatives(step.problem, step.points, step.poses, step.contacts, core::contact::HessianKind::exact);
    return step;
}

Errors factorise(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step, core::solver::LinearSolver& solver) {
    if (solver.factorise_indefinite(step.derivatives.hessian)) return {};
    const double time = trajectory.time_start + t * trajectory.timestep;
    return {
        {core::base::ErrorCode::inconsistent, "step " + std::to_string(t),
         "the step at t = " + std::to_string(time) +
             " s has no derivative: its equations' matrix is singular. Is a body left without mass, or was the trajectory simulated from "
             "another model?"}};
}

MatrixX refined_solve(const core::solver::LinearSolver& solver, const core::solver::FreeDofs& dofs,
                      const core::kinematics::BlockHessian& hessian, const MatrixX& rhs) {
    MatrixX x = solver.solve(rhs);
    MatrixX residual(rhs.rows(), rhs.cols());
    std::vector<Vector6> column(dofs.index.size(), Vector6::Zero());
    for (Eigen::Index k = 0; k < rhs.cols(); ++k) {
        core::solver::scatter(dofs, x.col(k), column);
        residual.col(k) = rhs.col(k) - core::solver::gather(dofs, core::solver::multiply(hessian, column));
    }
    return x + solver.solve(residual);
}

Errors check_differentiable(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(trajectory.poses.size() == trajectory.steps.size() + 1, "a trajectory has a pose before and after each step");
    FETTLE_ASSERT(trajectory.poses[0].size() == model.bodies.size(), "the trajectory is of another model");
    FETTLE_ASSERT(trajectory.timestep == model.timestep, "the trajectory was simulated with another time step");
    Errors errors = check_integrator(model);
    for (const Errors& more : {energy::check_terms(model), check_scripts(model)}) errors.insert(errors.end(), more.begin(), more.end());
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t)
        for (std::size_t i = 0; i < model.bodies.size(); ++i) {
            const double angle = trajectory.steps[t].nodes.back()[i].rotation_vector.norm();
            if (angle < 1.99 * std::numbers::pi) continue;
            errors.push_back(
                {core::base::ErrorCode::out_of_range, "step " + std::to_string(t),
                 "'" + model.bodies[i].name + "' turns by " + std::to_string(angle) +
                     " rad in one time step, which cannot be differentiated: use a smaller time step (less than a revolution each)"});
        }
    return errors;
}

}  // namespace fettle::adjoint::stepper
