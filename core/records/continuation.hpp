// SPDX-License-Identifier: MIT
/// Going on with a stored simulation.
#pragma once

#include "core/base/result.hpp"
#include "core/records/stored_trajectory.hpp"

namespace fettle::core::records {

/// What SimulationOptions::resume takes, from a stored trajectory of `model`. Reports and outputs of its steps are not stored.
/// Errors (inconsistent): no checkpoint, other meshes, or a scene that is another in what decides how the motion goes on: every such part
/// by its name (scene_parts.hpp).
base::Result<stepper::Simulation> resumable(const StoredTrajectory& stored, const model::Model& model);

}  // namespace fettle::core::records
