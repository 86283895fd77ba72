// SPDX-License-Identifier: MIT
/// A trajectory file that grows with its simulation, so that a run that is killed leaves what it did: the lines of
/// records/trajectory_io.hpp, each on its way to the disk before the next step begins, a checkpoint whenever one has been passed.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.hpp"
#include "core/records/trajectory_lines.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::design::answers {

/// In the folder of a run that is not whole.
inline constexpr const char* running_file = "trajectory.running.json";

/// For a folder the running file where there is one, else trajectory.json; any other path as it is.
std::string run_to_continue(const std::string& path);

class GrowingTrajectory {
public:
    /// @param scene_path  for the file's first line.
    /// @param continued   the run that this one goes on with: if that is the folder's running file it is replaced, whose steps are in the
    /// new one too. Any other running file, of a run that was killed, is kept under another name (output_folder.hpp).
    GrowingTrajectory(const std::filesystem::path& folder, const core::model::Model& model, std::string scene_path,
                      const std::filesystem::path& continued);
    ~GrowingTrajectory();
    GrowingTrajectory(const GrowingTrajectory&) = delete;
    GrowingTrajectory& operator=(const GrowingTrajectory&) = delete;

    /// Writes what the simulation has and the file has not. Contract: always of the same simulation, which stays where it is.
    /// @return why it cannot be written, reported once: nothing is written from then on; empty: it is
    std::string write(const core::stepper::Simulation& so_far);

    /// Once the whole run is in a file of its own: takes the running file away.
    void remove();

private:
    Errors begin(const std::string& text);

    std::filesystem::path file_;
    bool replaces_ = false;
    const core::model::Model& model_;
    std::string scene_path_;
    std::unique_ptr<core::records::TrajectoryLines> lines_;
    std::size_t steps_ = 0;
    int checkpoint_ = -1;
    int handle_ = -1;
    bool failed_ = false;
};

}  // namespace fettle::design::answers
