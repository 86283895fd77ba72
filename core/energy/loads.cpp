// SPDX-License-Identifier: MIT
#include "fettle/core/energy/loads.hpp"

#include <algorithm>

namespace fettle::core::energy {
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

}  // namespace fettle::core::energy
