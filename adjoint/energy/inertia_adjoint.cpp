// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/inertia_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

Errors check_inertia(const core::model::Model&) { return {}; }

void subtract_reverse_of_inertia(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                 std::vector<ModelGradient>&) {
    for (std::size_t s = 0; s < motion.size(); ++s)
        for (std::size_t i = 0; i < at.poses.size(); ++i) {
            Matrix34 v;
            v << cross_matrix(motion[s][i].tail<3>()) * at.poses[i].rotation, motion[s][i].head<3>();
            step_bar.pose_hat_bar[s][i] -= inertia_pose_hat_adjoint(v, at.problem.model->bodies[i].moments);
            step_bar.moments_bar[s][i] -= inertia_moments_adjoint(v, pose_matrix(at.poses[i]) - at.problem.pose_hat[i]);
        }
}

void add_tangent_of_inertia(const StepEnd& at, const StepTangent& step, const ModelTangent&, contact::PoseGradientTangent& out) {
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        const Matrix34 minus_hat = pose_matrix(at.poses[i]) - at.problem.pose_hat[i];
        const Matrix4& moments = at.problem.model->bodies[i].moments;
        out.value[i] += minus_hat * moments;
        out.dot[i] += inertia_gradient_tangent(minus_hat, moments, step.poses_dot[i] - step.pose_hat_dot[i], step.moments_dot[i]);
    }
}

}  // namespace

const TermAdjoint inertia_term_adjoint{"inertia", check_inertia, subtract_reverse_of_inertia, add_tangent_of_inertia};

}  // namespace fettle::adjoint::energy
