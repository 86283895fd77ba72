// SPDX-License-Identifier: MIT
/// Motion without dynamics: prescribed coordinates follow their scripts, everything else stays where it starts. No masses, no contact:
/// bodies may pass through each other, and a clearance over this motion says so. With contact: simulate.hpp.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

/// The path is what a simulation's would be if nothing were in the way: per step straight in the step's chart, through every entry of a
/// script or table inside the step (prescribed_path.hpp).
/// @param steps  negative: the model's end_time, or 1000 steps if it has none.
Trajectory follow_scripts(const model::Model& model, int steps = -1);

/// Has every degree of freedom a script (static and kinematic bodies always have)? Then dynamics has nothing to decide.
bool is_scripted(const model::Body& body);

/// Names of the bodies that follow_scripts holds in at least one degree of freedom that dynamics would move.
std::vector<std::string> held_bodies(const model::Model& model);

}  // namespace fettle::core::stepper
