// SPDX-License-Identifier: MIT
#include "fettle/core/energy/friction.hpp"

namespace fettle::core::energy {
namespace {

double friction_value(const ValueAt& at) { return contact::friction_potential(at.problem.friction, at.poses); }

void add_friction_derivatives(const DerivativesAt& at, CouplingDerivatives& d) {
    contact::add_friction_derivatives(at.problem.friction, at.poses, at.kind, d.gradient, d.hessian);
}

void add_friction_report(const SolvedStep& step, TermReport& report) {
    const contact::FrictionSet& set = step.problem.friction;
    for (const contact::BodyPairFriction& pair : set.pairs)
        for (const contact::FrictionContact& c : pair.contacts) {
            ContactForce& f = force_between(report, pair.first, pair.second);
            const bool first = pair.first == f.a;
            const Vector3 on_first = friction_force(set, pair, c, step.poses) / step.problem.weight;
            const Vector3 force = first ? on_first : Vector3(-on_first);
            const Vector3 at = world_position(step.poses[f.a], first ? c.point_first : c.point_second);
            const auto velocity = [&](int body, const Vector3& X) -> Vector3 {
                return step.end.velocities[body].leftCols<3>() * X + step.end.velocities[body].col(3);
            };
            report.dissipated_power -= on_first.dot(velocity(pair.first, c.point_first) - velocity(pair.second, c.point_second));
            f.force += force;
            f.friction += force;
            f.torque += at.cross(force);
        }
}

}  // namespace

const CouplingTerm friction_term{"friction", friction_value, add_friction_derivatives, add_friction_report};

}  // namespace fettle::core::energy
