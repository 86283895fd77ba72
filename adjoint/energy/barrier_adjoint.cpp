// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/barrier_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

Errors check_barrier(const core::model::Model& model) {
    if (!model.area_weighted) return {};
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b) {
            if (!may_collide(model, a, b) || friction_coefficient(model, a, b) == 0) continue;
            Errors errors{refusal("contact/area_weighted", "friction with the area-weighted barrier")};
            errors.back().message += "; switch `area_weighted` off";
            return errors;
        }
    return {};
}

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
