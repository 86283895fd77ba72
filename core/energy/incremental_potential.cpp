// SPDX-License-Identifier: MIT
#include "fettle/core/energy/incremental_potential.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/energy/inertia.hpp"

namespace fettle::core::energy {
namespace {

using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int bodies_a_piece = 16;  // that a thread takes at a time

bool has_free_dof(const model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (model::is_free(body, k)) return true;
    return false;
}

Matrix6 positive_part(const Matrix6& h) {
    const Eigen::LLT<Matrix6> cholesky(h);
    if (cholesky.info() == Eigen::Success) return h;
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(h);
    const Vector6 positive = eigen.eigenvalues().cwiseMax(0.0);
    return eigen.eigenvectors() * positive.asDiagonal() * eigen.eigenvectors().transpose();
}

// (dq, dtheta) -> (dq, phi).
Matrix6 chart_to_tangent(const Vector3& theta) {
    Matrix6 t = Matrix6::Identity();
    t.bottomRightCorner<3, 3>() = kinematics::left_jacobian(theta);
    return t;
}

}  // namespace

StepProblem step_problem(const model::Model& model, const History& history, double kappa) {
    StepProblem problem{integration_step(model, history), &model, history.poses, 0, {}, {}};
    set_kappa(problem, kappa);
    return problem;
}

void set_kappa(StepProblem& problem, double kappa) {
    problem.kappa = kappa;
    problem.barrier = contact::barrier_parameters(problem.model->dhat, problem.model->dmin, kappa, problem.weight);
}

StepProblem implicit_euler_problem(const model::Model& model, std::vector<Pose> poses_t0, const std::vector<Matrix34>& velocities_t0) {
    FETTLE_ASSERT(model.integrator == scene::Integrator::implicit_euler, "another integrator is asked for");
    return step_problem(model, {std::move(poses_t0), velocities_t0, {}, {}, {}}, model.kappa);
}

std::vector<Pose> poses_of(const StepProblem& problem, const std::vector<ChartPoint>& points) {
    std::vector<Pose> poses(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        poses[i] = {kinematics::rotation(points[i].rotation_vector) * problem.poses_t0[i].rotation, points[i].position};
    return poses;
}

double incremental_potential(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                             const contact::Candidates& candidates) {
    double sum = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const model::Body& body = problem.model->bodies[i];
        if (!has_free_dof(body)) continue;
        sum += inertia_potential(pose_matrix(poses[i]), problem.pose_hat[i], body.moments) -
               problem.weight *
                   (body.force.dot(poses[i].position - problem.poses_t0[i].position) + problem.torque[i].dot(points[i].rotation_vector));
    }
    return sum + contact::barrier_potential(*problem.model, candidates, poses, problem.barrier) +
           contact::friction_potential(problem.friction, poses);
}

PoseDerivatives pose_derivatives(const StepProblem& problem, const std::vector<Pose>& poses, const contact::ContactSet& contacts,
                                 contact::HessianKind kind) {
    const std::size_t n = poses.size();
    PoseDerivatives d;
    d.gradients.resize(n);
    d.contact_hessian.diagonal.assign(n, Matrix6::Zero());
    contact::add_barrier_derivatives(contacts, poses, problem.barrier, kind, d.gradients, d.contact_hessian);
    contact::add_friction_derivatives(problem.friction, poses, kind, d.gradients, d.contact_hessian);
    d.force_magnitude.assign(n, 0);
    base::parallel_for(static_cast<int>(n), bodies_a_piece, [&](int i) {
        const model::Body& body = problem.model->bodies[i];
        d.force_magnitude[i] = d.gradients[i].force.norm();
        if (!has_free_dof(body)) return;
        kinematics::PoseGradient inertia;
        add_inertia_gradient(poses[i], problem.pose_hat[i], body.moments, inertia);
        d.gradients[i].force += inertia.force - problem.weight * body.force;
        d.gradients[i].arm += inertia.arm;
        const double lever = std::max(body.radius, problem.model->dhat);
        d.force_magnitude[i] +=
            inertia.force.norm() + inertia.arm.norm() / lever + problem.weight * (body.force.norm() + body.torque.norm() / lever);
    });
    return d;
}

ChartDerivatives chart_derivatives(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                                   const contact::ContactSet& contacts, contact::HessianKind kind) {
    PoseDerivatives d = pose_derivatives(problem, poses, contacts, kind);
    ChartDerivatives out;
    const std::size_t n = poses.size();
    out.gradient.resize(n);
    out.hessian.diagonal.resize(n);
    std::vector<Matrix6> to_tangent(n);
    base::parallel_for(static_cast<int>(n), bodies_a_piece, [&](int i) {
        const model::Body& body = problem.model->bodies[i];
        const Vector3& theta = points[i].rotation_vector;
        to_tangent[i] = chart_to_tangent(theta);
        out.gradient[i] = to_tangent[i].transpose() * tangent_gradient(d.gradients[i]);
        out.gradient[i].tail<3>() -= problem.weight * problem.torque[i];
        Matrix6 own = Matrix6::Zero();
        if (has_free_dof(body)) own = to_tangent[i].transpose() * inertia_hessian(poses[i].rotation, body.moments) * to_tangent[i];
        own.bottomRightCorner<3, 3>() += chart_curvature(d.gradients[i].arm, kinematics::rotation_derivatives(theta));
        if (kind == contact::HessianKind::projected) own = positive_part(own);
        out.hessian.diagonal[i] = own + to_tangent[i].transpose() * d.contact_hessian.diagonal[i] * to_tangent[i];
    });
    out.hessian.off_diagonal = std::move(d.contact_hessian.off_diagonal);
    base::parallel_for(static_cast<int>(out.hessian.off_diagonal.size()), bodies_a_piece, [&](int k) {
        kinematics::OffDiagonalBlock& b = out.hessian.off_diagonal[k];
        b.block = to_tangent[b.a].transpose() * b.block * to_tangent[b.b];
    });
    out.force_magnitude = std::move(d.force_magnitude);
    return out;
}

}  // namespace fettle::core::energy
