// SPDX-License-Identifier: MIT
#include "core/energy/time_integration.hpp"

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"
#include "core/energy/damping_moments.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/kinematics/path.hpp"
#include "core/kinematics/tangent_system.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::core::energy {
namespace {

using kinematics::angular_velocity;
using kinematics::pose_matrix;
using scene::Integrator;

constexpr int bodies_at_once = 64;  // that a thread takes

bool is_prescribed(const model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (is_free(body, k)) return false;
    return true;
}

// Generalised force (force, torque about q) that the accelerations Pddot of a body's points take.
Vector6 force_of(const Matrix34& pddot, const Matrix4& moments, const Matrix3& R) {
    const Matrix34 g = pddot * moments;
    return kinematics::tangent_gradient({g.col(3), g.leftCols<3>() * R.transpose()});
}

// (a, alpha) under a generalised force at the angular velocity omega; prescribed coordinates have those of `held`.
Vector6 rigid_acceleration(const model::Body& body, const Matrix3& R, const Vector3& omega, const Vector6& force, const Vector6& held) {
    Matrix34 bias = Matrix34::Zero();
    bias.leftCols<3>() = cross_matrix(omega) * cross_matrix(omega) * R;
    Matrix6 h = kinematics::mass_matrix(R, body.moments);
    Vector6 rhs = force - force_of(bias, body.moments, R);
    for (int k = 0; k < 6; ++k)
        if (!is_free(body, k)) rhs -= held[k] * h.col(k);
    for (int k = 0; k < 6; ++k) {
        if (is_free(body, k)) continue;
        h.row(k).setZero();
        h.col(k).setZero();
        h(k, k) = 1;
        rhs[k] = held[k];
    }
    return linear::SymmetricFactor(h).solve(rhs);
}

Matrix34 pose_acceleration(const Matrix3& R, const Vector3& omega, const Vector6& a) {
    Matrix34 out;
    out << (cross_matrix(a.tail<3>()) + cross_matrix(omega) * cross_matrix(omega)) * R, a.head<3>();
    return out;
}

// Newmark's V and A at the end of a step. The trapezoidal rule for the nine entries of R would leave V and A with parts that no rotation
// has, first order in h and growing wherever contact kicks them. The force that the step has balanced is exact, though: so A' follows from
// it by Euler's equation, and V' = V + h/2 (A + A') for v and omega.
struct RigidRates {
    Matrix34 velocity, acceleration;
};
RigidRates newmark_rates(const model::Body& body, double h, const Matrix34& before, const Matrix34& V, const Matrix34& A,
                         const kinematics::Pose& end) {
    const Matrix34 numeric = (pose_matrix(end) - before - h * V) / (0.25 * h * h) - A;
    const Vector6 force = force_of(numeric, body.moments, end.rotation);
    const Matrix3 R0 = before.leftCols<3>();
    const Vector3 omega0 = angular_velocity(R0, V);
    Vector6 a0, held;
    a0 << A.col(3), angular_velocity(R0, A);
    held << numeric.col(3), angular_velocity(end.rotation, numeric);
    Vector6 a = a0;
    Vector3 omega = omega0 + h * a0.tail<3>();
    constexpr int sweeps = 4;  // each gains a factor of h |omega|
    for (int k = 0; k < sweeps; ++k) {
        a = rigid_acceleration(body, end.rotation, omega, force, held);
        omega = omega0 + 0.5 * h * (a0 + a).tail<3>();
    }
    RigidRates out;
    out.velocity << cross_matrix(omega) * end.rotation, Vector3(V.col(3) + 0.5 * h * (a0 + a).head<3>());
    out.acceleration = pose_acceleration(end.rotation, omega, a);
    return out;
}

// The chart's torque is J_l(theta)^-T of what is handed over, which turns it by half of the step's rotation: an error of first order. A
// second-order integrator gets the torque turned back by the predicted rotation.
Vector3 chart_torque(const model::Body& body, const Matrix3& R, const Matrix34& pose_hat) {
    return kinematics::left_jacobian(angular_velocity(R, pose_hat)).transpose() * body.torque;
}

}  // namespace

Matrix34 start_acceleration(const model::Body& body, const Vector3& gravity, const Vector6& loads) {
    if (is_prescribed(body)) return Matrix34::Zero();
    const Matrix3& R = body.pose_start.rotation;
    Matrix34 weight = Matrix34::Zero();
    weight.col(3) = gravity;
    Vector6 force = force_of(weight, body.moments, R) + loads;
    if (is_damped(body)) force -= force_of(body.velocity_start, damping_moments(body), R);
    const Vector3 omega = angular_velocity(R, body.velocity_start);
    return pose_acceleration(R, omega, rigid_acceleration(body, R, omega, force, Vector6::Zero()));
}

IntegrationStep integration_step(const model::Model& model, const History& history) {
    const double h = model.timestep;
    const std::size_t n = model.bodies.size();
    IntegrationStep step;
    const bool bdf2 = model.integrator == Integrator::bdf2 && !history.poses_before.empty();
    const bool newmark = model.integrator == Integrator::newmark;
    const bool quasi_static = model.integrator == Integrator::quasi_static;
    step.slip_time = bdf2 ? 2 * h / 3 : newmark ? h / 2 : h;
    step.weight = step.slip_time * step.slip_time;
    step.damping_weight = step.slip_time;
    if (quasi_static) {
        FETTLE_ASSERT(model.proximal_weight > 0, "a quasi-static model has a proximal weight");
        step.weight = model.proximal_weight;
        step.damping_weight = 0;
        step.gravity = model.gravity;
    }
    step.pose_hat.resize(n);
    step.slip_reference.resize(n);
    step.torque.resize(n);
    base::parallel_for(static_cast<int>(n), bodies_at_once, [&](int i) {
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
        } else if (quasi_static) {
            slip = hat = pose;
        } else {
            slip = pose;
            hat = pose + h * velocity;
            hat.col(3) += h * h * model.gravity;
        }
        const model::Body& body = model.bodies[i];
        const bool second_order = model.integrator != Integrator::implicit_euler && !quasi_static && !body.torque.isZero(0);
        step.torque[i] = second_order ? chart_torque(body, history.poses[i].rotation, hat) : body.torque;
    });
    return step;
}

History advanced(const model::Model& model, const History& history, const IntegrationStep& step, std::vector<kinematics::Pose> poses) {
    const double h = model.timestep;
    History next;
    const std::size_t n = poses.size();
    next.velocities.resize(n);
    const bool newmark = model.integrator == Integrator::newmark;
    if (newmark) next.accelerations.resize(n);
    const bool bdf2 = model.integrator == Integrator::bdf2;
    if (bdf2) next.poses_before.resize(n);
    base::parallel_for(static_cast<int>(n), bodies_at_once, [&](int i) {
        const Matrix34 pose = pose_matrix(poses[i]), before = pose_matrix(history.poses[i]);
        if (model.integrator == Integrator::quasi_static) {
            next.velocities[i].setZero();
        } else if (is_prescribed(model.bodies[i])) {
            next.velocities[i] = (pose - before) / h;
            if (newmark) next.accelerations[i].setZero();
        } else if (newmark) {
            const RigidRates rates = newmark_rates(model.bodies[i], h, before, history.velocities[i], history.accelerations[i], poses[i]);
            next.velocities[i] = rates.velocity;
            next.accelerations[i] = rates.acceleration;
        } else {
            next.velocities[i] = (pose - step.slip_reference[i]) / step.slip_time;
        }
        if (bdf2) next.poses_before[i] = before;
    });
    if (bdf2) next.velocities_before = history.velocities;
    next.angles = constraint::angles_at(model.mechanism.set, poses, history.angles);
    next.poses = std::move(poses);
    return next;
}

}  // namespace fettle::core::energy
