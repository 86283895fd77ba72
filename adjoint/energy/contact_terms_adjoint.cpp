// SPDX-License-Identifier: MIT
#include "adjoint/energy/contact_terms_adjoint.hpp"

#include "adjoint/contact/contact_damping_adjoint.hpp"

namespace fettle::adjoint::energy {

namespace {

Errors check_barrier(const core::model::Model&) { return {}; }

contact::ContactsAtPose contacts_at(const StepEnd& at, const core::contact::ContactAreas& areas) {
    return {*at.problem.model, at.contacts, at.poses, at.problem.barrier, at.problem.model->area_weighted ? &areas : nullptr};
}

void subtract_reverse_of_barrier(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                 std::vector<ModelGradient>& model_bar) {
    const core::contact::ContactAreas areas = contact::areas_of_contacts(*at.problem.model, at.poses);
    contact::subtract_contact_vertices_adjoint(contacts_at(at, areas), motion, model_bar, step_bar.areas_bar);
}

void add_tangent_of_barrier(const StepEnd& at, const StepTangent& step, const ModelTangent& direction, contact::PoseGradientTangent& out) {
    const core::contact::ContactAreas areas = contact::areas_of_contacts(*at.problem.model, at.poses);
    contact::add_contact_gradient_tangent(contacts_at(at, areas), step.poses_dot, direction, step.areas_dot, out);
}

}  // namespace

const TermAdjoint barrier_term_adjoint{"barrier", check_barrier, subtract_reverse_of_barrier, add_tangent_of_barrier};

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

namespace {

contact::FrictionAtPose friction_at(const StepEnd& at) {
    const core::energy::StepProblem& problem = at.problem;
    return {*problem.model, *at.lag, at.poses, problem.slip_reference, problem.barrier, problem.friction.slip_bound};
}

Errors check_friction(const core::model::Model&) { return {}; }

void subtract_reverse_of_friction(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                  std::vector<ModelGradient>& model_bar) {
    if (at.lag == nullptr) return;
    contact::subtract_friction_adjoint(friction_at(at), motion,
                                       {step_bar.slip_reference_bar, step_bar.lag_poses_bar, step_bar.areas_bar, model_bar});
}

void add_tangent_of_friction(const StepEnd& at, const StepTangent& step, const ModelTangent& direction, contact::PoseGradientTangent& out) {
    if (at.lag == nullptr) return;
    contact::add_friction_tangent(friction_at(at), {step.poses_dot, step.slip_reference_dot, step.lag_poses_dot, step.areas_dot}, direction,
                                  out);
}

}  // namespace

bool has_friction(const core::model::Model& model) {
    if (model.friction.rounds == 0 || !(model.friction.mu.maxCoeff() > 0)) return false;
    const int count = count_of(model.bodies);
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            if (may_collide(model, a, b) && friction_coefficient(model, a, b) > 0) return true;
    return false;
}

const TermAdjoint friction_term_adjoint{"friction", check_friction, subtract_reverse_of_friction, add_tangent_of_friction};

}  // namespace fettle::adjoint::energy
