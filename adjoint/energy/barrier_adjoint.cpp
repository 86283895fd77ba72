// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/barrier_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

Errors check_barrier(const core::model::Model& model) {
    if (!model.area_weighted) return {};
    Errors errors{refusal("contact/area_weighted", "the area-weighted barrier")};
    errors.back().message += "; switch `area_weighted` off";
    return errors;
}

contact::ContactsAtPose contacts_at(const StepEnd& at) { return {*at.problem.model, at.contacts, at.poses, at.problem.barrier}; }

void subtract_reverse_of_barrier(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient&,
                                 std::vector<ModelGradient>& model_bar) {
    contact::subtract_contact_vertices_adjoint(contacts_at(at), motion, model_bar);
}

void add_tangent_of_barrier(const StepEnd& at, const StepTangent& step, const ModelTangent& direction, contact::PoseGradientTangent& out) {
    contact::add_contact_gradient_tangent(contacts_at(at), step.poses_dot, direction, out);
}

}  // namespace

const TermAdjoint barrier_term_adjoint{"barrier", check_barrier, subtract_reverse_of_barrier, add_tangent_of_barrier};

}  // namespace fettle::adjoint::energy
