// SPDX-License-Identifier: MIT
/// A trajectory as the lines of its file (trajectory_io.hpp documents them), one after the other: what is written at once, or appended to
/// while the motion grows.
#pragma once

#include <string>

#include "core/model/model.hpp"
#include "core/records/path_hash.hpp"
#include "core/stepper/simulation.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

class TrajectoryLines {
public:
    /// Keeps references to both. The trajectory must have its start; steps may follow.
    TrajectoryLines(const stepper::Trajectory& trajectory, const model::Model& model);

    /// The first line. Each ends with its line feed.
    std::string header(const std::string& scene_path) const;
    /// The line of the next step. Contract: it is there.
    std::string next_step();
    /// After the line of its step, or any later one.
    std::string checkpoint(const stepper::Checkpoint& checkpoint) const;

private:
    const stepper::Trajectory& trajectory_;
    const model::Model& model_;
    PathHash hash_;
    int steps_ = 0;  // written
};

}  // namespace fettle::core::records
