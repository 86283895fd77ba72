// SPDX-License-Identifier: MIT
#include "fettle/core/energy/loads.hpp"

#include <algorithm>

namespace fettle::core::energy {
namespace {

void add_loads_value(const ValueAt& at, TermValues& values) {
    const StepProblem& problem = at.problem;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        const model::Body& body = problem.model->bodies[i];
        if (!has_free_dof(body)) continue;
        values.bodies[i] -= problem.weight * (body.force.dot(at.poses[i].position - problem.poses_t0[i].position) +
                                              problem.torque[i].dot(at.points[i].rotation_vector));
    }
}

// A held body's torque counts, so that what drives it is told; its force is left to that report (stepper/step_outputs.hpp).
void add_loads_derivatives(const DerivativesAt& at, TermDerivatives& d) {
    const StepProblem& problem = at.problem;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        const model::Body& body = problem.model->bodies[i];
        d.chart_gradient[i] -= problem.weight * problem.torque[i];
        if (!has_free_dof(body)) continue;
        d.own[i].force -= problem.weight * body.force;
        d.own_magnitude[i] += problem.weight * (body.force.norm() + body.torque.norm() / std::max(body.radius, problem.model->dhat));
    }
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

const Term loads_term{"loads", add_loads_value, add_loads_derivatives, add_loads_report};

}  // namespace fettle::core::energy
