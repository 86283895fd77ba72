// SPDX-License-Identifier: MIT
#include "core/energy/contact_terms.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::energy {

namespace {

double barrier_value(const ValueAt& at) { return contact::barrier_potential(at.contacts, at.problem.barrier); }

void add_barrier_derivatives(const DerivativesAt& at, CouplingDerivatives& d) {
    contact::add_barrier_derivatives(at.contacts, at.poses, at.problem.barrier, at.kind, d.gradient, d.hessian);
}

// Adds one pair of primitives. @param begin, end  its vertices on body f.a.
void add_pair(const StepProblem& problem, const contact::ContactPair& pair, int begin, int end, ContactForce& f) {
    const auto gradient = pair_forces(pair, problem.barrier);
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    for (int i = begin; i < end; ++i) {
        force -= gradient[i] / problem.weight;
        torque -= pair.x[i].cross(gradient[i]) / problem.weight;
    }
    f.force += force;
    f.torque += torque;
    f.normal += normal_force(pair, problem.barrier) / problem.weight;
    const double distance = gap_of(pair);
    f.distance = f.contacts == 0 ? distance : std::min(f.distance, distance);
    ++f.contacts;
}

void add_barrier_report(const SolvedStep& step, TermReport& report) {
    const StepProblem& problem = step.problem;
    for (const contact::BodyPairContacts& list : step.contacts.pairs) {
        ContactForce& f = force_between(report, list.first, list.second);
        for (const contact::ContactPair& pair : list.contacts) {
            report.contact_energy += pair_potential(pair, problem.barrier) / problem.weight;
            // On body a: the vertices of the first primitive, or those of the second if the pair is listed the other way round.
            const int n = first_count(pair.type);
            const bool first = list.first == f.a;
            add_pair(problem, pair, first ? 0 : n, first ? n : 4, f);
        }
    }
}

}  // namespace

const CouplingTerm barrier_term{"barrier", barrier_value, add_barrier_derivatives, add_barrier_report};

namespace {

double contact_damping_value(const ValueAt& at) {
    if (!(at.problem.contact_damping.factor > 0)) return 0;
    return contact::contact_damping_potential({*at.problem.model, at.contacts, at.problem.contact_damping});
}

void add_contact_damping_derivatives_here(const DerivativesAt& at, CouplingDerivatives& d) {
    if (!(at.problem.contact_damping.factor > 0)) return;
    contact::add_contact_damping_derivatives({*at.problem.model, at.contacts, at.problem.contact_damping}, at.poses, at.kind, d.gradient,
                                             d.hessian);
}

void add_contact_damping_report(const SolvedStep& step, TermReport& report) {
    const contact::ContactDamping& damping = step.problem.contact_damping;
    if (!(damping.factor > 0)) return;
    for (const contact::BodyPairContacts& list : step.contacts.pairs) {
        ContactForce& f = force_between(report, list.first, list.second);
        for (const contact::ContactPair& contact : list.contacts) {
            const contact::DampedPair pair = damped_pair(*step.problem.model, damping, list, contact);
            const double scale = pair.slope() / step.problem.weight;
            const auto gradient = pair_forces(pair.end, damping.closeness);
            // On body a: the vertices of the first primitive, or those of the second if the pair is listed the other way round.
            const int n = first_count(contact.type);
            const bool first = list.first == f.a;
            for (int i = 0; i < 4; ++i) {
                const int body = i < n ? list.first : list.second;
                report.dissipated_power +=
                    scale * gradient[i].dot(point_velocity(step.poses[body], step.end.velocities[body], contact.x[i]));
            }
            for (int i = first ? 0 : n; i < (first ? n : 4); ++i) {
                f.force -= scale * gradient[i];
                f.torque -= contact.x[i].cross(scale * gradient[i]);
            }
            f.normal += scale * normal_force(pair.end, damping.closeness);
        }
    }
}

}  // namespace

const CouplingTerm contact_damping_term{"contact damping", contact_damping_value, add_contact_damping_derivatives_here,
                                        add_contact_damping_report};

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
