// SPDX-License-Identifier: MIT
#include "fettle/core/energy/inertia.hpp"

#include <algorithm>

#include "fettle/core/energy/mass_matrix.hpp"

namespace fettle::core::energy {
namespace {

void add_inertia_value(const ValueAt& at, std::size_t i, double& value) {
    const model::Body& body = at.problem.model->bodies[i];
    if (has_free_dof(body)) value += inertia_potential(pose_matrix(at.poses[i]), at.problem.pose_hat[i], body.moments);
}

void add_inertia_derivatives(const DerivativesAt& at, std::size_t i, BodyDerivatives& d) {
    const model::Body& body = at.problem.model->bodies[i];
    if (!has_free_dof(body)) return;
    kinematics::PoseGradient gradient;
    add_inertia_gradient(at.poses[i], at.problem.pose_hat[i], body.moments, gradient);
    d.gradient.force += gradient.force;
    d.gradient.arm += gradient.arm;
    if (at.kind != contact::HessianKind::none) d.hessian += mass_matrix(at.poses[i].rotation, body.moments);
    d.magnitude += gradient.force.norm() + gradient.arm.norm() / std::max(body.radius, at.problem.model->dhat);
}

void add_inertia_report(const SolvedStep& step, TermReport& report) {
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
        const Matrix4& moments = step.problem.model->bodies[i].moments;
        if (!(moments(3, 3) > 0)) continue;
        const Matrix34& velocity = step.end.velocities[i];
        report.kinetic_energy += 0.5 * (velocity * moments).cwiseProduct(velocity).sum();
        const Vector6 momentum = momenta(step.end.poses[i], velocity, moments);
        report.linear_momentum += momentum.head<3>();
        report.angular_momentum += momentum.tail<3>();
    }
}

}  // namespace

// With M = integral rho [X;1][X;1]^T, integral rho x v^T = P M V^T.
Vector6 momenta(const kinematics::Pose& pose, const Matrix34& velocity, const Matrix4& moments) {
    const Matrix34 momentum = velocity * moments;
    const Matrix3 l = pose_matrix(pose) * momentum.transpose();
    Vector6 out;
    out << momentum.col(3), l(1, 2) - l(2, 1), l(2, 0) - l(0, 2), l(0, 1) - l(1, 0);
    return out;
}

double inertia_potential(const Matrix34& pose, const Matrix34& pose_hat, const Matrix4& moments) {
    const Matrix34 d = pose - pose_hat;
    return 0.5 * (d * moments).cwiseProduct(d).sum();
}

void add_inertia_gradient(const kinematics::Pose& pose, const Matrix34& pose_hat, const Matrix4& moments,
                          kinematics::PoseGradient& gradient) {
    const Matrix34 g = (pose_matrix(pose) - pose_hat) * moments;
    gradient.force += g.col(3);
    gradient.arm += g.leftCols<3>() * pose.rotation.transpose();
}

const BodyTerm inertia_term{"inertia", add_inertia_value, add_inertia_derivatives, add_inertia_report};

}  // namespace fettle::core::energy
