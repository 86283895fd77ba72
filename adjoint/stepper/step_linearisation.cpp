// SPDX-License-Identifier: MIT
#include "fettle/adjoint/stepper/step_linearisation.hpp"

#include <cmath>
#include <numbers>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/geometry/mass_moments.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::kinematics::pose_matrix;

std::vector<Matrix34> velocities_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    std::vector<Matrix34> velocities(model.bodies.size());
    for (std::size_t i = 0; i < velocities.size(); ++i)
        velocities[i] = t == 0 ? model.bodies[i].velocity_start
                               : Matrix34((pose_matrix(trajectory.poses[t][i]) - pose_matrix(trajectory.poses[t - 1][i])) / model.timestep);
    return velocities;
}

bool has_free_dof(const core::model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (is_free(body, k)) return true;
    return false;
}

core::base::Error refusal(const std::string& where, const std::string& what) {
    return {core::base::ErrorCode::unsupported, where, what + " cannot be differentiated"};
}

/// Settings of the whole model that the sweeps know no derivative of.
Errors check_settings(const core::model::Model& model) {
    using core::scene::Integrator;
    Errors errors;
    if (model.integrator != Integrator::implicit_euler) {
        const std::string name = model.integrator == Integrator::bdf2 ? "bdf2" : "newmark";
        errors.push_back(refusal("integrator", "a simulation by `" + name + "`"));
        errors.back().message += "; `implicit_euler` can";
    }
    if (model.area_weighted) {
        errors.push_back(refusal("contact/area_weighted", "the area-weighted barrier"));
        errors.back().message += "; switch `area_weighted` off";
    }
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (!may_collide(model, a, b) || friction_coefficient(model, a, b) == 0) continue;
            errors.push_back(refusal("friction", "friction between '" + model.bodies[a].name + "' and '" + model.bodies[b].name + "'"));
            errors.back().message += " yet; a gradient needs coefficients of 0";
            return errors;  // one pair says enough
        }
    }
    return errors;
}

Errors check_body(const core::model::Body& body) {
    Errors errors;
    if (!body.script.empty()) {
        errors.push_back(refusal(body.name, "'" + body.name + "' follows a script of poses, which"));
        errors.back().message += "; prescribed coordinates can";
    }
    if (!has_free_dof(body)) return errors;
    if (body.torque != Vector3::Zero()) errors.push_back(refusal(body.name, "the torque on '" + body.name + "'"));
    const Matrix4 solid = body.density * core::geometry::solid_moments(body.mesh.vertices, body.mesh.triangles);
    if (!((body.moments - solid).norm() <= 1e-9 * solid.norm())) {
        errors.push_back(refusal(body.name, "'" + body.name + "'"));
        errors.back().message += ": its mass is not that of a solid of its density";
    }
    return errors;
}

}  // namespace

bool rotates_freely(const core::model::Body& body) { return is_free(body, 3) && is_free(body, 4) && is_free(body, 5); }

LinearisedStep linearise_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t) {
    LinearisedStep step;
    step.problem = core::energy::implicit_euler_problem(model, trajectory.poses[t], velocities_at(model, trajectory, t));
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
    Errors errors = check_settings(model);
    for (const core::model::Body& body : model.bodies) {
        for (const auto& error : check_body(body)) errors.push_back(error);
    }
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
