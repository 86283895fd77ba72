// SPDX-License-Identifier: MIT
#include "adjoint/model/build_model_adjoint.hpp"

#include <algorithm>

#include "adjoint/model/build_friction_adjoint.hpp"
#include "adjoint/model/build_mechanism_adjoint.hpp"
#include "adjoint/scene/scene_gradient.hpp"

namespace fettle::adjoint::model {
namespace {

using core::model::Model;

// The gradient in the pose as written, entry by entry; without joints nothing stands between it and the start.
Matrix34 written_pose_bar(const Model& model, const WrittenStartGradient& start, const BodyGradient& bar, std::size_t i) {
    const core::model::Body& body = model.bodies[i];
    Matrix34 out;
    if (!model.mechanism.empty()) {
        const auto& written = model.mechanism.written.poses;
        const Matrix3& rotation = written.empty() ? body.pose_start.rotation : written[i].rotation;
        out << 0.5 * cross_matrix(start.pose_bar[i].tail<3>()) * rotation, start.pose_bar[i].head<3>();
        return out;
    }
    const Matrix3 omega = body.velocity_start.leftCols<3>() * body.pose_start.rotation.transpose();
    out = bar.pose_start_bar;
    out.leftCols<3>() += omega.transpose() * bar.velocity_start_bar.leftCols<3>();
    return out;
}

// d(increment over step t)/d(rate): the time during which the motor runs.
double running_time(const core::scene::MotionCurve& curve, double start, double end) {
    const double stop = curve.stop_time.value_or(end);
    return std::min(end, stop) - std::min(start, stop);
}

double rate_bar(const core::scene::MotionCurve& curve, const Model& model, const BodyGradient& bar, Eigen::Index dof) {
    double sum = 0;
    for (std::size_t t = 0; t < bar.increment_bar.size(); ++t) {
        const double start = static_cast<double>(t) * model.timestep;
        sum += bar.increment_bar[t][dof] * running_time(curve, start, start + model.timestep);
    }
    return sum;
}

}  // namespace

core::scene::Scene build_model_adjoint(const core::scene::Scene& scene, const Model& model, const MechanismStartAdjoint& start_adjoint,
                                       ModelGradient gradient) {
    WrittenStartGradient start = start_adjoint.reverse(gradient);
    core::scene::Scene out = scene::zero_scene_gradient(scene);
    build_mechanism_adjoint(scene, model, gradient.mechanism, start, out.mechanism);
    build_friction_adjoint(scene, gradient.friction_bar, out);
    out.gravity = gradient.gravity_bar;
    out.dmin = gradient.dmin_bar;
    for (std::size_t i = 0; i < out.bodies.size(); ++i) {
        const BodyGradient& from = gradient.bodies[i];
        core::scene::Body& bar = out.bodies[i];
        const Matrix34 pose = written_pose_bar(model, start, from, i);
        bar.mesh.vertices = from.vertices_bar;
        bar.pose = {pose.leftCols<3>() + pose.col(3) * model.bodies[i].reference_point.transpose(), pose.col(3)};
        bar.density = from.density_bar;
        bar.linear_velocity = start.velocity_bar[i].head<3>();
        bar.angular_velocity = start.velocity_bar[i].tail<3>();
        bar.force = from.force_bar;
        bar.torque = from.torque_bar;
        for (std::size_t dof = 0; dof < 6; ++dof) {
            const auto k = static_cast<Eigen::Index>(dof);
            if (const auto& curve = scene.bodies[i].prescribed[dof])
                bar.prescribed[dof]->rate = rate_bar(*curve, model, from, k) + start.rate_bar[i][k];
        }
    }
    return out;
}

}  // namespace fettle::adjoint::model
