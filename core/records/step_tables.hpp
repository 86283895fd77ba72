// SPDX-License-Identifier: MIT
/// Per-step outputs as CSV tables with a header row, SI units, every number as the shortest decimal that reads back to the same double.
/// They come from a simulation with SimulationOptions::outputs; one that was resumed lists the steps since its checkpoint, see
/// joined_table.
#pragma once

#include <string>
#include <vector>

#include "core/stepper/simulation.hpp"

namespace fettle::core::records {

/// time, kinetic_energy, potential_energy (of gravity and constant forces), contact_energy, spring_energy (of springs and stops) [J], whose
/// sum is all there is; supplied_power (motors, prescribed coordinates, torques, loads at points), dissipated_power [W]; linear momentum px
/// py pz [kg m/s], angular momentum about the world's origin lx ly lz [kg m^2/s], kappa, newton_iterations, friction_rounds, contacts,
/// minimum_distance [m; empty: nothing in contact], residual.
std::string steps_csv(const stepper::Simulation& simulation);

/// One row per step and pair of bodies in contact: time, a, b, force on a fx fy fz [N], its torque about the world's origin tx ty tz [N m],
/// normal [N], friction on a sx sy sz [N], distance [m], contacts.
std::string contacts_csv(const stepper::Simulation& simulation, const std::vector<std::string>& names);

/// One row per step and body with prescribed coordinates: time, body, force fx fy fz [N] and torque tx ty tz [N m] on it, about its
/// reference point.
std::string drives_csv(const stepper::Simulation& simulation, const std::vector<std::string>& names);

/// One row per step and joint, gear or motor: time, name, force on body b fx fy fz [N] and torque on it about the joint's point tx ty tz
/// [N m], effort of a motor, a gear or a rack [N], [N m] (0 of others); of a joint, along its coordinate [N], [N m], what its spring,
/// damping, friction and stops push with: beside force and torque, which keep it together. A motor's force and torque are its own, beside
/// those of its joint.
std::string joints_csv(const stepper::Simulation& simulation, const model::Mechanism& mechanism);

/// `later` after those rows of `earlier`, a table of the run that was taken up again, whose time is at most `until` [s]: the table of a run
/// that was never cut. An earlier table with another header is left out.
std::string joined_table(const std::string& earlier, const std::string& later, double until);

}  // namespace fettle::core::records
