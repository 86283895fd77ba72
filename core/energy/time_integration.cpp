// SPDX-License-Identifier: MIT
#include "fettle/core/energy/time_integration.hpp"

#include <Eigen/LU>

#include "fettle/core/energy/inertia.hpp"

namespace fettle::core::energy {
namespace {

using kinematics::pose_matrix;
using scene::Integrator;

bool is_prescribed(const model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (is_free(body, k)) return false;
    return true;
}

// Pddot of one body under gravity and its loads: the minimum of |Pddot - a|_M over what its free coordinates allow, plus [omega]^2 R.
Matrix34 free_acceleration(const model::Model& model, const model::Body& body) {
    const Matrix3& R = body.pose_start.rotation;
    const Matrix3 spin = body.velocity_start.leftCols<3>() * R.transpose();
    Matrix34 bias = Matrix34::Zero();
    bias.leftCols<3>() = spin * spin * R;
    Matrix34 gravity = Matrix34::Zero();
    gravity.col(3) = model.gravity;
    const Matrix34 force = (gravity - bias) * body.moments;
    kinematics::PoseGradient pull{force.col(3) + body.force, force.leftCols<3>() * R.transpose()};
    Vector6 rhs = tangent_gradient(pull);
    rhs.tail<3>() += body.torque;
    Matrix6 h = inertia_hessian(R, body.moments);
    for (int k = 0; k < 6; ++k) {
        if (is_free(body, k)) continue;
        h.row(k).setZero();
        h.col(k).setZero();
        h(k, k) = 1;
        rhs[k] = 0;
    }
    const Vector6 a = h.ldlt().solve(rhs);
    Matrix34 out = bias;
    out.leftCols<3>() += cross_matrix(a.tail<3>()) * R;
    out.col(3) += a.head<3>();
    return out;
}

// What a rotation's first and second derivative must be: [omega] R and ([alpha] + [omega]^2) R. The rest of V and A is the trapezoidal
// rule's own, does no work on the motion, and grows without bound where contact kicks it.
void make_rigid(const Matrix3& R, Matrix34& velocity, Matrix34& acceleration) {
    const auto skew_part = [&R](const Matrix34& m) {
        const Matrix3 w = m.leftCols<3>() * R.transpose();
        return Matrix3(0.5 * (w - w.transpose()));
    };
    const Matrix3 omega = skew_part(velocity), alpha = skew_part(acceleration);
    velocity.leftCols<3>() = omega * R;
    acceleration.leftCols<3>() = (alpha + omega * omega) * R;
}

}  // namespace

History start_history(const model::Model& model) {
    History history;
    for (const model::Body& body : model.bodies) {
        history.poses.push_back(body.pose_start);
        history.velocities.push_back(body.velocity_start);
        if (model.integrator == Integrator::newmark)
            history.accelerations.push_back(is_prescribed(body) ? Matrix34(Matrix34::Zero()) : free_acceleration(model, body));
    }
    return history;
}

IntegrationStep integration_step(const model::Model& model, const History& history) {
    const double h = model.timestep;
    const std::size_t n = model.bodies.size();
    IntegrationStep step;
    const bool bdf2 = model.integrator == Integrator::bdf2 && !history.poses_before.empty();
    const bool newmark = model.integrator == Integrator::newmark;
    step.slip_time = bdf2 ? 2 * h / 3 : newmark ? h / 2 : h;
    step.weight = step.slip_time * step.slip_time;
    step.pose_hat.resize(n);
    step.slip_reference.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix34 pose = pose_matrix(history.poses[i]);
        const Matrix34& velocity = history.velocities[i];
        Matrix34 &hat = step.pose_hat[i], &slip = step.slip_reference[i];
        if (bdf2) {
            slip = (4 * pose - history.poses_before[i]) / 3;
            hat = slip + step.slip_time * (4 * velocity - history.velocities_before[i]) / 3;
            hat.col(3) += step.weight * model.gravity;
        } else if (newmark) {
            slip = pose + 0.5 * h * velocity;
            hat = pose + h * velocity + step.weight * history.accelerations[i];
            hat.col(3) += step.weight * model.gravity;
        } else {
            slip = pose;
            hat = implicit_euler_pose_hat(pose, velocity, model.gravity, h);
        }
    }
    return step;
}

History advanced(const model::Model& model, const History& history, const IntegrationStep& step, std::vector<kinematics::Pose> poses) {
    const double h = model.timestep;
    History next;
    const std::size_t n = poses.size();
    next.velocities.resize(n);
    if (model.integrator == Integrator::newmark) next.accelerations.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix34 pose = pose_matrix(poses[i]), before = pose_matrix(history.poses[i]);
        next.velocities[i] =
            is_prescribed(model.bodies[i]) ? Matrix34((pose - before) / h) : Matrix34((pose - step.slip_reference[i]) / step.slip_time);
        if (model.integrator == Integrator::newmark) {
            next.accelerations[i] = (pose - before - h * history.velocities[i]) / (0.25 * h * h) - history.accelerations[i];
            make_rigid(poses[i].rotation, next.velocities[i], next.accelerations[i]);
        }
        if (model.integrator == Integrator::bdf2) next.poses_before.push_back(before);
    }
    if (model.integrator == Integrator::bdf2) next.velocities_before = history.velocities;
    next.poses = std::move(poses);
    return next;
}

}  // namespace fettle::core::energy
