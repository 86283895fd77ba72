// SPDX-License-Identifier: MIT
/// The `checkpoint` of a trajectory file (trajectory_io.hpp): what a simulation of the scene needs to go on from poses[step] with the same
/// bits. One JSON object { step, kappa, velocities, poses_before, velocities_before, accelerations, scene, hash }: four lists of 12 numbers
/// per body (3 x 4, column by column; energy::History), empty where the integrator has no use for them; `scene`, of which scene it is, a
/// hash for each part (scene_parts.hpp); `hash`, FNV-1a over all of this and poses[step]. The state's time and poses are the trajectory's.
#pragma once

#include <vector>

#include "core/files/json_document.hpp"
#include "core/files/json_writer.hpp"
#include "core/records/scene_parts.hpp"
#include "core/stepper/simulation.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

struct StoredCheckpoint {
    stepper::Checkpoint checkpoint;
    std::vector<ScenePart> scene;
};

void write_checkpoint(files::JsonWriter& out, const stepper::Checkpoint& checkpoint, const std::vector<ScenePart>& scene);

/// The checkpoint of this trajectory. Faults (keys, lengths of lists, a step that the trajectory does not have, the hash) are added to the
/// document's errors.
StoredCheckpoint read_checkpoint(const files::JsonNode& node, const stepper::Trajectory& trajectory);

}  // namespace fettle::core::records
