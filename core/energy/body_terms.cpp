// SPDX-License-Identifier: MIT
#include "core/energy/body_terms.hpp"

#include <algorithm>

#include "core/kinematics/mass_matrix.hpp"
#include "core/model/choose_proximal_weight.hpp"

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
    if (at.kind != contact::HessianKind::none) d.hessian += kinematics::mass_matrix(at.poses[i].rotation, body.moments);
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

namespace {

bool takes_part(const StepProblem& problem, const model::Body& body) {
    return problem.damping_weight > 0 && is_damped(body) && has_free_dof(body);
}

void add_damping_value(const ValueAt& at, std::size_t i, double& value) {
    const model::Body& body = at.problem.model->bodies[i];
    if (!takes_part(at.problem, body)) return;
    value += at.problem.damping_weight * inertia_potential(pose_matrix(at.poses[i]), at.problem.slip_reference[i], damping_moments(body));
}

void add_damping_derivatives(const DerivativesAt& at, std::size_t i, BodyDerivatives& d) {
    const model::Body& body = at.problem.model->bodies[i];
    if (!takes_part(at.problem, body)) return;
    const Matrix4 moments = at.problem.damping_weight * damping_moments(body);
    kinematics::PoseGradient gradient;
    add_inertia_gradient(at.poses[i], at.problem.slip_reference[i], moments, gradient);
    d.gradient.force += gradient.force;
    d.gradient.arm += gradient.arm;
    if (at.kind != contact::HessianKind::none) d.hessian += kinematics::mass_matrix(at.poses[i].rotation, moments);
    d.magnitude += gradient.force.norm() + gradient.arm.norm() / std::max(body.radius, at.problem.model->dhat);
}

void add_damping_report(const SolvedStep& step, TermReport& report) {
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
        const model::Body& body = step.problem.model->bodies[i];
        if (!takes_part(step.problem, body)) continue;
        const Matrix34& velocity = step.end.velocities[i];
        report.dissipated_power += (velocity * damping_moments(body)).cwiseProduct(velocity).sum();
    }
}

}  // namespace

const BodyTerm damping_term{"damping", add_damping_value, add_damping_derivatives, add_damping_report};

namespace {

// What gravity does along the step, where the inertia leaves it out; from the poses' difference, so that nothing large cancels.
double gravity_work(const StepProblem& problem, std::size_t i, const kinematics::Pose& pose) {
    const Matrix34 moved = pose_matrix(pose) - pose_matrix(problem.poses_t0[i]);
    return problem.gravity.dot(moved * problem.model->bodies[i].moments.col(3));
}

void add_loads_value(const ValueAt& at, std::size_t i, double& value) {
    const StepProblem& problem = at.problem;
    const model::Body& body = problem.model->bodies[i];
    if (!has_free_dof(body)) return;
    value -= problem.weight *
             (body.force.dot(at.poses[i].position - problem.poses_t0[i].position) + problem.torque[i].dot(at.points[i].rotation_vector));
    if (!problem.gravity.isZero(0)) value -= problem.weight * gravity_work(problem, i, at.poses[i]);
}

// A held body's torque counts, so that what drives it is told; its force is left to that report (stepper/step_outputs.hpp).
void add_loads_derivatives(const DerivativesAt& at, std::size_t i, BodyDerivatives& d) {
    const StepProblem& problem = at.problem;
    const model::Body& body = problem.model->bodies[i];
    d.chart_gradient -= problem.weight * problem.torque[i];
    if (!has_free_dof(body)) return;
    const double arm = std::max(body.radius, problem.model->dhat);
    d.gradient.force -= problem.weight * body.force;
    d.magnitude += problem.weight * (body.force.norm() + body.torque.norm() / arm);
    if (problem.gravity.isZero(0)) return;
    kinematics::PoseGradient gradient;
    add_gravity_gradient(problem, i, at.poses[i], gradient);
    d.gradient.force += gradient.force;
    d.gradient.arm += gradient.arm;
    d.magnitude += gradient.force.norm() + gradient.arm.norm() / arm;
}

void add_loads_report(const SolvedStep& step, TermReport& report) {
    const model::Model& model = *step.problem.model;
    for (std::size_t i = 0; i < step.poses.size(); ++i)
        report.supplied_power +=
            model.bodies[i].torque.dot(kinematics::angular_velocity(step.end.poses[i].rotation, step.end.velocities[i]));
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
        const model::Body& body = model.bodies[i];
        if (!(body.moments(3, 3) > 0)) continue;
        const kinematics::Pose& pose = step.end.poses[i];
        report.potential_energy -= model.gravity.dot(pose_matrix(pose) * body.moments.col(3)) + body.force.dot(pose.position);
    }
}

}  // namespace

void add_gravity_gradient(const StepProblem& problem, std::size_t body, const kinematics::Pose& pose, kinematics::PoseGradient& gradient) {
    const Matrix4& moments = problem.model->bodies[body].moments;
    const Vector3 first = pose.rotation * moments.topRightCorner<3, 1>();
    gradient.force -= problem.weight * moments(3, 3) * problem.gravity;
    gradient.arm -= problem.weight * problem.gravity * first.transpose();
}

const BodyTerm loads_term{"loads", add_loads_value, add_loads_derivatives, add_loads_report};

std::vector<double> proximal_shares(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                    const std::vector<kinematics::Pose>& poses) {
    const model::Model& model = *problem.model;
    const std::vector<double> loads = model::reference_loads(model);
    std::vector<double> shares(poses.size(), 0);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (!(loads[i] > 0)) continue;
        const model::Body& body = model.bodies[i];
        kinematics::PoseGradient gradient;
        add_inertia_gradient(poses[i], problem.pose_hat[i], body.moments, gradient);
        Vector6 carried = tangent_gradient(gradient) / problem.weight;
        carried.tail<3>() = kinematics::left_jacobian(points[i].rotation_vector).transpose() * carried.tail<3>();
        for (int k = 0; k < 6; ++k)
            if (!is_free(body, k)) carried[k] = 0;
        shares[i] = (carried.head<3>().norm() + carried.tail<3>().norm() / std::max(body.radius, model.dhat)) / loads[i];
    }
    return shares;
}

}  // namespace fettle::core::energy
