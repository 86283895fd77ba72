// SPDX-License-Identifier: MIT
/// Velocities at the steps' ends, as the integrator has them (core/energy/time_integration.hpp): differences of poses but for Newmark's.
///   implicit Euler, BDF2's first step, bodies that are driven altogether   V[t+1] = (P[t+1] - P[t])/h
///   BDF2                                                                   V[t+1] = (P[t+1] - (4 P[t] - P[t-1])/3)/(2h/3)
///   Newmark                                                                of its own, from all steps before
#pragma once

#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// [step][body]: Pdot at the step's end, what energies and momenta are reported of; 0 in quasi-statics.
std::vector<std::vector<Matrix34>> end_velocities(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// Adds dJ/d(configurations) of dJ/dV = bar, V of a body at the end of step t. Contract: not quasi-static.
void add_velocity_seed(const core::model::Model& model, int t, int body, const Matrix34& bar, TrajectoryGradient& seeds);

/// The same of P_slip of step t, from which contacts slide.
void add_slip_seed(const core::model::Model& model, int t, int body, const Matrix34& bar, Seeds& seeds);

}  // namespace fettle::adjoint::stepper
