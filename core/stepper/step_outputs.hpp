// SPDX-License-Identifier: MIT
/// What a step did, beyond where the bodies are: energies, momenta, forces between bodies, and what it took to drive prescribed ones.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/energy/incremental_potential.hpp"
#include "fettle/core/solver/newton.hpp"
#include "fettle/core/stepper/step_state.hpp"

namespace fettle::core::stepper {

/// Between two bodies, at the end of a step.
struct ContactForce {
    int a = 0, b = 0;                    ///< a < b
    Vector3 force = Vector3::Zero();     ///< on a, friction included, world [N]
    Vector3 torque = Vector3::Zero();    ///< on a, about the world's origin [N m]
    double normal = 0;                   ///< sum of the contacts' normal forces [N]
    Vector3 friction = Vector3::Zero();  ///< on a [N]
    double distance = 0;                 ///< least of the contacts' [m]
    int contacts = 0;
};

/// What holds or drives a body's prescribed coordinates: force and torque on the body, world, about its reference point; 0 where it is
/// free. A body without mass (kinematic) needs what its contacts ask for; one with mass, its inertia and loads too.
struct DriveForce {
    int body = 0;
    Vector3 force = Vector3::Zero();   ///< [N]
    Vector3 torque = Vector3::Zero();  ///< [N m]
};

struct StepOutputs {
    double time = 0;                             ///< at the end of the step [s]
    double kinetic_energy = 0;                   ///< of the bodies with mass [J]
    double potential_energy = 0;                 ///< of gravity and constant forces, zero at the world's origin [J]
    double contact_energy = 0;                   ///< of the barrier [J]
    Vector3 linear_momentum = Vector3::Zero();   ///< [kg m/s]
    Vector3 angular_momentum = Vector3::Zero();  ///< about the world's origin [kg m^2/s]
    double kappa = 0;
    std::vector<ContactForce> contacts;  ///< by (a, b)
    std::vector<DriveForce> drives;      ///< of the bodies with prescribed coordinates that need any
};

/// @param problem  as it was handed to the solver; `solved` holds the friction of the last round.
StepOutputs step_outputs(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved,
                         const StepState& end);

}  // namespace fettle::core::stepper
