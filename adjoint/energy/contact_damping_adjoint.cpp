// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/contact_damping_adjoint.hpp"

#include "fettle/adjoint/contact/contact_damping_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

contact::DampedContacts damped_contacts_at(const StepEnd& at) {
    return {*at.problem.model, at.contacts, at.poses, at.problem.contact_damping};
}

Errors check_contact_damping(const core::model::Model&) { return {}; }

// Implicit Euler's P_slip is the start, where the rates are measured from.
void subtract_reverse_of_contact_damping(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                         std::vector<ModelGradient>& model_bar) {
    if (!(at.problem.contact_damping.factor > 0)) return;
    contact::subtract_contact_damping_adjoint(damped_contacts_at(at), motion, step_bar.slip_reference_bar, model_bar);
}

void add_tangent_of_contact_damping(const StepEnd& at, const StepTangent& step, const ModelTangent& direction,
                                    contact::PoseGradientTangent& out) {
    if (!(at.problem.contact_damping.factor > 0)) return;
    contact::add_contact_damping_tangent(damped_contacts_at(at), step.poses_dot, step.slip_reference_dot, direction, out);
}

}  // namespace

const TermAdjoint contact_damping_term_adjoint{"contact damping", check_contact_damping, subtract_reverse_of_contact_damping,
                                               add_tangent_of_contact_damping};

}  // namespace fettle::adjoint::energy
