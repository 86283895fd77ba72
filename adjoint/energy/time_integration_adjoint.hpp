// SPDX-License-Identifier: MIT
/// What Newmark's steps and the second-order integrators' torques depend on (core/energy/time_integration.hpp), reverse and forward. All
/// are smooth functions of the entries of 3 x 4 matrices; derivatives are entry by entry.
///
/// Newmark's end rates: with N = 4 (P' - P - h V)/h^2 - A, R, R' the rotations of P, P', the axial vectors of V R^T and A R^T giving
/// omega_0 and alpha_0, the accelerations a = (a_q, alpha) solve for the free coordinates, four times,
///   <(N - Q) M, [[e_phi] R', e_q]> = 0,   Q = [([alpha] + [omega]^2) R', a_q],   omega = omega_0 + h/2 (alpha_0 + alpha of the time
///   before)
/// (the first time h alpha_0), prescribed ones being N's own, and V' = [[omega] R', V e4 + h/2 (A e4 + a_q)] with the last omega, A' = Q.
/// Backwards each solve takes one with the same matrix: mu = H^-1 a_bar, and r = <(N - Q) M, v>, v = [[mu_phi] R', mu_q], has the
/// derivatives v M in N, - v M in Q, sym(v^T (N - Q)) in M, and through v in R'.
/// The start's A is the same of N M = [0 | g] M - V C, C the damping's moments, and the loads f . mu_q + tau . mu_phi, whatever they follow
/// from (start_history_adjoint.hpp).
#pragma once

#include <vector>

#include "core/energy/time_integration.hpp"

namespace fettle::adjoint::energy {

/// A body's step of Newmark's: what its end rates follow from.
struct NewmarkStep {
    const core::model::Body& body;
    double timestep = 0;
    Matrix34 before, velocity, acceleration;  ///< P, V, A
    core::kinematics::Pose end;               ///< P'
};

struct NewmarkRates {
    Matrix34 velocity, acceleration;  ///< V', A'
};
/// As core's, which keeps them to itself.
NewmarkRates newmark_rates(const NewmarkStep& step);

/// Changes of a step's inputs, or gradients in them; entry by entry.
struct NewmarkStepChange {
    Matrix34 before = Matrix34::Zero(), velocity = Matrix34::Zero(), acceleration = Matrix34::Zero(), end = Matrix34::Zero();
    Matrix4 moments = Matrix4::Zero();
};
NewmarkRates newmark_rates_tangent(const NewmarkStep& step, const NewmarkStepChange& dot);
NewmarkStepChange newmark_rates_adjoint(const NewmarkStep& step, const NewmarkRates& bar);

/// What a body's acceleration at the start follows from, as changes or as gradients.
struct StartChange {
    Matrix34 velocity = Matrix34::Zero();  ///< Body::velocity_start
    Matrix3 rotation = Matrix3::Zero();    ///< of Body::pose_start
    Vector3 gravity = Vector3::Zero();
    Vector6 loads = Vector6::Zero();  ///< force and torque
    Matrix4 moments = Matrix4::Zero();
};
/// What a body's acceleration at the start is taken at.
struct StartOf {
    const core::model::Body& body;
    Vector3 gravity;
    Vector6 loads;
};
Matrix34 start_acceleration_tangent(const StartOf& at, const StartChange& dot);
StartChange start_acceleration_adjoint(const StartOf& at, const Matrix34& bar);

/// The chart's torque J_l(psi)^T tau, psi the axial vector of P_hat R^T (J_l^T: the left Jacobian's transpose).
struct ChartTorqueChange {
    Vector3 torque = Vector3::Zero();
    Matrix3 rotation = Matrix3::Zero();  ///< R
    Matrix3 hat = Matrix3::Zero();       ///< first three columns of P_hat
};
Vector3 chart_torque_tangent(const Vector3& torque, const Matrix3& rotation, const Matrix34& pose_hat, const ChartTorqueChange& dot);
ChartTorqueChange chart_torque_adjoint(const Vector3& torque, const Matrix3& rotation, const Matrix34& pose_hat, const Vector3& bar);

/// Does the integrator hand over the chart's torque, or the torque as it is?
inline bool has_chart_torque(const core::model::Model& model) {
    return model.integrator == core::scene::Integrator::bdf2 || model.integrator == core::scene::Integrator::newmark;
}

}  // namespace fettle::adjoint::energy
