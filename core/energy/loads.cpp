// SPDX-License-Identifier: MIT
#include "fettle/core/energy/loads.hpp"

#include <algorithm>

#include "fettle/core/base/parallel.hpp"

namespace fettle::core::energy {
namespace {

constexpr int loads_a_call = 128;  // that a thread takes at a time

// What gravity does along the step, where the inertia leaves it out; from the poses' difference, so that nothing large cancels.
double gravity_work(const StepProblem& problem, std::size_t i, const kinematics::Pose& pose) {
    const Matrix34 moved = pose_matrix(pose) - pose_matrix(problem.poses_t0[i]);
    return problem.gravity.dot(moved * problem.model->bodies[i].moments.col(3));
}

void add_loads_value(const ValueAt& at, TermValues& values) {
    const StepProblem& problem = at.problem;
    base::parallel_for(static_cast<int>(at.poses.size()), loads_a_call, [&](int i) {
        const model::Body& body = problem.model->bodies[i];
        if (!has_free_dof(body)) return;
        values.bodies[i] -= problem.weight * (body.force.dot(at.poses[i].position - problem.poses_t0[i].position) +
                                              problem.torque[i].dot(at.points[i].rotation_vector));
        if (!problem.gravity.isZero(0)) values.bodies[i] -= problem.weight * gravity_work(problem, i, at.poses[i]);
    });
}

// A held body's torque counts, so that what drives it is told; its force is left to that report (stepper/step_outputs.hpp).
void add_loads_derivatives(const DerivativesAt& at, TermDerivatives& d) {
    const StepProblem& problem = at.problem;
    base::parallel_for(static_cast<int>(at.poses.size()), loads_a_call, [&](int i) {
        const model::Body& body = problem.model->bodies[i];
        d.chart_gradient[i] -= problem.weight * problem.torque[i];
        if (!has_free_dof(body)) return;
        const double arm = std::max(body.radius, problem.model->dhat);
        d.own[i].force -= problem.weight * body.force;
        d.own_magnitude[i] += problem.weight * (body.force.norm() + body.torque.norm() / arm);
        if (problem.gravity.isZero(0)) return;
        kinematics::PoseGradient gradient;
        add_gravity_gradient(problem, i, at.poses[i], gradient);
        d.own[i].force += gradient.force;
        d.own[i].arm += gradient.arm;
        d.own_magnitude[i] += gradient.force.norm() + gradient.arm.norm() / arm;
    });
}

void add_loads_report(const SolvedStep& step, TermReport& report) {
    const model::Model& model = *step.problem.model;
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

const Term loads_term{"loads", add_loads_value, add_loads_derivatives, add_loads_report};

}  // namespace fettle::core::energy
