// SPDX-License-Identifier: MIT
#include "fettle/core/energy/contact_damping.hpp"

namespace fettle::core::energy {
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

}  // namespace fettle::core::energy
