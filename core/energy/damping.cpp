// SPDX-License-Identifier: MIT
#include "fettle/core/energy/damping.hpp"

#include <algorithm>

#include "fettle/core/energy/inertia.hpp"
#include "fettle/core/energy/mass_matrix.hpp"

namespace fettle::core::energy {
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
    if (at.kind != contact::HessianKind::none) d.hessian += mass_matrix(at.poses[i].rotation, moments);
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

}  // namespace fettle::core::energy
