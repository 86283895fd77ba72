// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/barrier_adjoint.hpp"

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

}  // namespace fettle::adjoint::energy
