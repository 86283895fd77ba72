// SPDX-License-Identifier: MIT
/// Time integration as choices of P_hat and of the potentials' weight. docs/method/energy.md#integrators.
/// A step minimises 1/2 tr((P - P_hat) M (P - P_hat)^T) + weight (potentials); contact slides at V = (P - P_slip) / slip_time, which is the
/// end velocity too but for Newmark's.
///   implicit Euler  P_hat = P0 + h V0 + h^2 a                weight h^2        P_slip = P0                slip_time = h
///   BDF2            P_hat = P_slip + 2h/3 (4 V0 - V_-1)/3    weight (2h/3)^2   P_slip = (4 P0 - P_-1)/3   slip_time = 2h/3
///                           + (2h/3)^2 a;  the first step is one of implicit Euler
///   Newmark 1/4,1/2 P_hat = P0 + h V0 + h^2/4 (A0 + a)       weight h^2/4      P_slip = P0 + h/2 V0       slip_time = h/2
///                   then A by Euler's equation from the force that the step has balanced, V = V0 + h/2 (A0 + A), for v and omega
///   quasi-static    P_hat = P0                               weight W          P_slip = P0                slip_time = h
///                   gravity is a load of its own; W = h^2/eps, Model::proximal_weight: then the first term over W is the proximal one,
///                   1/2 (eps/h^2) |P - P0|^2_M, and what is minimised is W times the equilibrium's energy
/// with a the acceleration of gravity. A quasi-static step has no velocities: they stay 0, and damping has no effect. Bodies that are
/// prescribed altogether have V = (P - P0) / h. Orders of accuracy: 1, 2, 2. The first two damp what they cannot resolve; Newmark keeps
/// energy, and rings in stiff contact. A free spin omega about a principal axis: implicit Euler brakes it by a share h omega^2 per unit of
/// time (after a turn of phi = h omega comes one of phi - phi^3), so that omega(t) = omega_0 / sqrt(1 + 2 h omega_0^2 t); with BDF2 and
/// Newmark the loss is O(h^2).
#pragma once

#include <vector>

#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::core::energy {

/// What a step needs of those before it.
struct History {
    std::vector<kinematics::Pose> poses;      ///< P0
    std::vector<Matrix34> velocities;         ///< V0 = Pdot
    std::vector<Matrix34> poses_before;       ///< P_-1 (BDF2; empty before the first step)
    std::vector<Matrix34> velocities_before;  ///< V_-1 (BDF2)
    std::vector<Matrix34> accelerations;      ///< A0 (Newmark)
    std::vector<double> angles{};             ///< of the mechanism's measures at P0, with their turns; empty: by half a turn
};

/// Newmark's A0 of a body (start_history.hpp) under gravity, its own damping, and a force and torque about its reference point (world);
/// prescribed coordinates have none, a body that is prescribed altogether has 0.
Matrix34 start_acceleration(const model::Body& body, const Vector3& gravity, const Vector6& loads);

struct IntegrationStep {
    std::vector<Matrix34> pose_hat;     ///< of dynamic steps gravity included, other loads not
    Vector3 gravity = Vector3::Zero();  ///< acts as a load of its own: where pose_hat leaves it out (quasi-static) [m/s^2]
    double weight = 0;                  ///< [s^2]
    std::vector<Matrix34> slip_reference;
    std::vector<Vector3> torque;  ///< per body: the constant gradient in theta (the chart's) that acts as the body's torque [N m]
    double slip_time = 0;         ///< [s]
    double damping_weight = 0;    ///< weight / slip_time [s]; 0: no damping
};
IntegrationStep integration_step(const model::Model& model, const History& history);

/// The history after the step, whose end is `poses`.
History advanced(const model::Model& model, const History& history, const IntegrationStep& step, std::vector<kinematics::Pose> poses);

}  // namespace fettle::core::energy
