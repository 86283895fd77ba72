// SPDX-License-Identifier: MIT
#include "adjoint/energy/body_terms_adjoint.hpp"

#include "core/energy/body_terms.hpp"

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

namespace {

bool is_damping(const StepEnd& at, std::size_t i) {
    const core::model::Body& body = at.problem.model->bodies[i];
    return at.problem.damping_weight > 0 && core::energy::is_damped(body) && core::energy::has_free_dof(body);
}

Errors check_damping(const core::model::Model&) { return {}; }

void subtract_reverse_of_damping(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                 std::vector<ModelGradient>&) {
    const double k = at.problem.damping_weight;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        if (!is_damping(at, i)) continue;
        const core::model::Body& body = at.problem.model->bodies[i];
        const Matrix4 moments = core::energy::damping_moments(body);
        const Matrix34 moved = pose_matrix(at.poses[i]) - at.problem.slip_reference[i];
        for (std::size_t s = 0; s < motion.size(); ++s) {
            Matrix34 v;
            v << cross_matrix(motion[s][i].tail<3>()) * at.poses[i].rotation, motion[s][i].head<3>();
            step_bar.slip_reference_bar[s][i] -= k * inertia_pose_hat_adjoint(v, moments);
            step_bar.moments_bar[s][i] -= k * damping_moments_adjoint(body, inertia_moments_adjoint(v, moved));
        }
    }
}

void add_tangent_of_damping(const StepEnd& at, const StepTangent& step, const ModelTangent&, contact::PoseGradientTangent& out) {
    const double k = at.problem.damping_weight;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        if (!is_damping(at, i)) continue;
        const core::model::Body& body = at.problem.model->bodies[i];
        const Matrix4 moments = core::energy::damping_moments(body), moments_dot = damping_moments_tangent(body, step.moments_dot[i]);
        const Matrix34 moved = pose_matrix(at.poses[i]) - at.problem.slip_reference[i];
        out.value[i] += k * moved * moments;
        out.dot[i] += k * inertia_gradient_tangent(moved, moments, step.poses_dot[i] - step.slip_reference_dot[i], moments_dot);
    }
}

}  // namespace

Matrix4 damping_moments_tangent(const core::model::Body& body, const Matrix4& moments_dot) {
    const core::scene::Damping& c = body.damping;
    const Eigen::Vector4d first = body.moments.col(3), first_dot = moments_dot.col(3);
    const Matrix4 product = first_dot * first.transpose();
    const double mass = first[3];
    return c.angular * moments_dot +
           (c.linear - c.angular) / mass * (product + product.transpose() - first_dot[3] / mass * first * first.transpose());
}

Matrix4 damping_moments_adjoint(const core::model::Body& body, const Matrix4& damping_bar) {
    const core::scene::Damping& c = body.damping;
    const Eigen::Vector4d first = body.moments.col(3);
    const double mass = first[3];
    Eigen::Vector4d first_bar = 2 / mass * damping_bar * first;
    first_bar[3] -= first.dot(damping_bar * first) / (mass * mass);
    Matrix4 gathered = Matrix4::Zero();
    gathered.col(3) += 0.5 * first_bar;
    gathered.row(3) += 0.5 * first_bar.transpose();
    return c.angular * damping_bar + (c.linear - c.angular) * gathered;
}

const TermAdjoint damping_term_adjoint{"damping", check_damping, subtract_reverse_of_damping, add_tangent_of_damping};

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
