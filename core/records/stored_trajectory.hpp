// SPDX-License-Identifier: MIT
/// What a trajectory file holds, read. Readers and writers: trajectory_io.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/records/scene_parts.hpp"
#include "core/stepper/simulation.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

struct StoredTrajectory {
    stepper::Trajectory trajectory;
    model::Model model;  ///< geometry, names, groups and contact distances; no density, moments, velocities, prescribed motion or loads
    std::string scene_path;
    std::string path;  ///< of the trajectory file
    std::optional<stepper::Checkpoint> checkpoint;
    std::vector<ScenePart> checkpoint_scene;  ///< what the scene of the checkpoint was
    std::vector<std::string> warnings;        ///< of a file that ends in the middle of a line
};

}  // namespace fettle::core::records
