// SPDX-License-Identifier: MIT
/// Constant forces and torques as a term of the incremental potential:  - weight (f . (q - q_t0) + tau . theta). docs/method/energy.md.
/// tau is the constant gradient in the chart's theta that acts as the body's torque (time_integration.hpp). Gravity is in the inertia's
/// P_hat, but its energy is reported here, with that of the forces. In a quasi-static step it is a load, and its potential stands here:
///   - weight a . ((P - P_t0) M e4).
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

/// Adds dE/dP of gravity as a load; nothing where the inertia has it.
void add_gravity_gradient(const StepProblem& problem, std::size_t body, const kinematics::Pose& pose, kinematics::PoseGradient& gradient);

extern const BodyTerm loads_term;

}  // namespace fettle::core::energy
