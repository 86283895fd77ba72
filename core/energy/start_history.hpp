// SPDX-License-Identifier: MIT
/// What the first step starts from. Newmark's first step wants accelerations: those of each body under all that acts at the start without
/// contact, namely gravity, constant loads, damping (time_integration.hpp) and the mechanism's springs, dampers, stops, loads and friction
/// (measure_law.hpp), with the rates of the start's velocities. Contact is left out, and joints: Newmark has none.
#pragma once

#include <vector>

#include "core/energy/step_problem.hpp"

namespace fettle::core::energy {

/// At the start of a simulation.
History start_history(const model::Model& model);

/// What the mechanism's terms are evaluated with at the start, at Model::bodies' start poses P0: weight 1, so that gradients are forces,
/// and P_slip = P0 - slip_time V0, so that (m - m_slip)/slip_time are the measures' rates. Nothing of it is about other terms.
StepProblem start_problem(const model::Model& model);

/// Per body (force, torque about its reference point), world, of constant loads and the mechanism's terms [N], [N m].
std::vector<Vector6> start_loads(const model::Model& model);

}  // namespace fettle::core::energy
