// SPDX-License-Identifier: MIT
/// The outcome of a step, beyond where the bodies are: energies, momenta, forces between bodies, and what it took to drive prescribed ones.
#pragma once

#include <string>
#include <vector>

#include "core/energy/incremental_potential.hpp"
#include "core/solver/newton.hpp"
#include "core/stepper/joint_outputs.hpp"
#include "core/stepper/step_state.hpp"

namespace fettle::core::stepper {

using energy::ContactForce;

/// What holds or drives a body's prescribed coordinates: force and torque on the body, world, about its reference point; 0 where it is
/// free. A body without mass (kinematic) needs what its contacts and joints ask for; one with mass, its inertia and loads too.
struct DriveForce {
    int body = 0;
    Vector3 force = Vector3::Zero();   ///< [N]
    Vector3 torque = Vector3::Zero();  ///< [N m]
};

/// What the terms of the potential report, and the rest.
struct StepOutputs : energy::TermReport {
    double time = 0;                   ///< at the end of the step [s]
    double kappa = 0;                  ///< of the barrier [N/m], or [N/m^3] if area-weighted
    std::vector<DriveForce> drives;    ///< of the bodies with prescribed coordinates that need any
    std::vector<JointForce> joints{};  ///< of every joint, gear and motor
    /// Does a motor or a prescribed coordinate start, stop or change its rate by more than half of it in this step? What it then supplies
    /// is a blow, whose work no sum of powers at steps' ends tells.
    bool drive_jumps = false;
    /// What the momenta of bodies that are solved for changed by in the step, beyond the impulses of all forces on them: the error of the
    /// solver and, of turning bodies, of the time integration. Forces are those at the step's end, so that a sum over steps is right to
    /// half a step's impulse.
    Vector3 momentum_defect = Vector3::Zero();          ///< [kg m/s]
    Vector3 angular_momentum_defect = Vector3::Zero();  ///< about the world's origin [kg m^2/s]
    /// The sizes that this defect is measured against, of the same bodies, about the world's origin [kg m^2/s]: the sum of their |angular
    /// momentum|, where it is larger, at the step's start or end; of their forces (all but gravity together, and each contact's) times the
    /// farthest that the body reaches and the step; and the defect that rounding of poses makes.
    double angular_momentum_size = 0, angular_impulse = 0, angular_momentum_rounding = 0;
};

/// Energies and momenta of a state, before any step.
energy::TermReport start_report(const model::Model& model, const StepState& state);

/// @param start    what the step started from.
/// @param problem  as it was handed to the solver; `solved` holds the friction of the last round.
StepOutputs step_outputs(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved,
                         const StepState& start, const StepState& end);

}  // namespace fettle::core::stepper
