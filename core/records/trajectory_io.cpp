// SPDX-License-Identifier: MIT
#include "core/records/trajectory_io.hpp"

#include <utility>

#include "core/base/contract.hpp"
#include "core/files/json_keys.hpp"
#include "core/records/trajectory_format.hpp"
#include "core/records/trajectory_lines.hpp"
#include "core/records/trajectory_reader.hpp"

namespace fettle::core::records {

base::Errors add_trajectory(files::FilesTogether& files, const std::filesystem::path& path, const stepper::Trajectory& trajectory,
                            const model::Model& model, const std::string& scene_path, const stepper::Checkpoint* checkpoint) {
    FETTLE_ASSERT(trajectory.poses.size() == trajectory.steps.size() + 1, "one step between each two poses");
    TrajectoryLines lines(trajectory, model);
    files::NewFile file(path);
    std::string text = lines.header(scene_path);
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        if (text.size() >= files::write_size) {
            file.write(text);
            text.clear();
        }
        text += lines.next_step();
    }
    if (checkpoint) text += lines.checkpoint(*checkpoint);
    file.write(text);
    return files.add(std::move(file));
}

base::Errors write_trajectory(const std::filesystem::path& path, const stepper::Trajectory& trajectory, const model::Model& model,
                              const std::string& scene_path, const stepper::Checkpoint* checkpoint) {
    files::FilesTogether file;
    base::Errors errors = add_trajectory(file, path, trajectory, model, scene_path, checkpoint);
    return errors.empty() ? file.take_names() : errors;
}

bool is_trajectory_file(const std::filesystem::path& path) { return files::has_top_level_key(path, format_key); }

base::Result<StoredTrajectory> read_trajectory(const std::filesystem::path& path) {
    const auto text = files::read_file(path);
    if (!text) return text.errors();
    return parse_trajectory(path.string(), *text);
}

}  // namespace fettle::core::records
