// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/contact_damping_adjoint.hpp"

#include "fettle/adjoint/contact/contact_damping_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

contact::DampedContacts damped_contacts_at(const StepEnd& at, const core::contact::ContactAreas& areas) {
    return {*at.problem.model, at.contacts, at.poses, at.problem.contact_damping, at.problem.model->area_weighted ? &areas : nullptr};
}

Errors check_contact_damping(const core::model::Model&) { return {}; }

// Rates are measured from the start with every integrator.
void subtract_reverse_of_contact_damping(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                         std::vector<ModelGradient>& model_bar) {
    if (!(at.problem.contact_damping.factor > 0)) return;
    const core::contact::ContactAreas areas = contact::areas_of_contacts(*at.problem.model, at.poses);
    contact::subtract_contact_damping_adjoint(damped_contacts_at(at, areas), motion, {step_bar.start_bar, step_bar.areas_bar, model_bar});
}

void add_tangent_of_contact_damping(const StepEnd& at, const StepTangent& step, const ModelTangent& direction,
                                    contact::PoseGradientTangent& out) {
    if (!(at.problem.contact_damping.factor > 0)) return;
    const core::contact::ContactAreas areas = contact::areas_of_contacts(*at.problem.model, at.poses);
    contact::add_contact_damping_tangent(damped_contacts_at(at, areas), {step.poses_dot, step.start_dot, step.areas_dot}, direction, out);
}

}  // namespace

const TermAdjoint contact_damping_term_adjoint{"contact damping", check_contact_damping, subtract_reverse_of_contact_damping,
                                               add_tangent_of_contact_damping};

}  // namespace fettle::adjoint::energy
