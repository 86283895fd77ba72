// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/loads_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

Errors check_loads(const core::model::Model&) { return {}; }

// Where the inertia's pose_hat leaves gravity out: r = -weight a . (v M e4).
void subtract_reverse_of_gravity(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                 std::vector<ModelGradient>& model_bar) {
    for (std::size_t s = 0; s < motion.size(); ++s)
        for (std::size_t i = 0; i < at.poses.size(); ++i) {
            Matrix34 v;
            v << cross_matrix(motion[s][i].tail<3>()) * at.poses[i].rotation, motion[s][i].head<3>();
            model_bar[s].gravity_bar += at.problem.weight * (v * at.problem.model->bodies[i].moments.col(3));
            const Eigen::Vector4d along = 0.5 * at.problem.weight * (v.transpose() * at.problem.gravity);
            step_bar.moments_bar[s][i].col(3) += along;
            step_bar.moments_bar[s][i].row(3) += along.transpose();
        }
}

void subtract_reverse_of_loads(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                               std::vector<ModelGradient>& model_bar) {
    for (std::size_t s = 0; s < motion.size(); ++s)
        for (std::size_t i = 0; i < at.poses.size(); ++i) model_bar[s].bodies[i].force_bar += at.problem.weight * motion[s][i].head<3>();
    if (at.problem.model->integrator == core::scene::Integrator::quasi_static) subtract_reverse_of_gravity(at, motion, step_bar, model_bar);
}

void add_tangent_of_loads(const StepEnd& at, const StepTangent& step, const ModelTangent& direction, contact::PoseGradientTangent& out) {
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        out.value[i].col(3) -= at.problem.weight * at.problem.model->bodies[i].force;
        out.dot[i].col(3) -= at.problem.weight * direction.bodies[i].force_dot;
    }
    if (at.problem.model->integrator != core::scene::Integrator::quasi_static) return;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        const Matrix4& moments = at.problem.model->bodies[i].moments;
        out.value[i] -= at.problem.weight * at.problem.gravity * moments.row(3);
        out.dot[i] -= at.problem.weight * (direction.gravity_dot * moments.row(3) + at.problem.gravity * step.moments_dot[i].row(3));
    }
}

}  // namespace

const TermAdjoint loads_term_adjoint{"loads", check_loads, subtract_reverse_of_loads, add_tangent_of_loads};

}  // namespace fettle::adjoint::energy
