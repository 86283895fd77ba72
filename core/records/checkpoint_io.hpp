// SPDX-License-Identifier: MIT
/// The `checkpoint` of a trajectory file (trajectory_io.hpp): what a simulation of the scene needs to go on from poses[step] with the same
/// bits. One JSON object { step, kappa, velocities, poses_before, velocities_before, accelerations }; the last four are lists of 12 numbers
/// per body (3 x 4, column by column; energy::History), empty where the integrator has no use for them. The state's time and poses are the
/// trajectory's.
#pragma once

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/files/json_writer.hpp"
#include "fettle/core/stepper/simulation.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::records {

void write_checkpoint(files::JsonWriter& out, const stepper::Checkpoint& checkpoint);

/// Of this trajectory. Faults (keys, lengths of lists, a step that the trajectory does not have) are added to the document's errors.
stepper::Checkpoint read_checkpoint(const files::JsonNode& node, const stepper::Trajectory& trajectory);

}  // namespace fettle::core::records
