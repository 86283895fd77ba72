// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/friction_adjoint.hpp"

namespace fettle::adjoint::energy {
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
