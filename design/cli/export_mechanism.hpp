// SPDX-License-Identifier: MIT
/// Exports of whole mechanisms, with their joints: a robot description of a scene or a design, a scene of a design.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "design/cli/command.hpp"

namespace fettle::design::cli {

/// Writes all of `contents` at once, and answers with their list. @return the exit code.
int leave_files(const std::vector<std::pair<std::filesystem::path, std::string>>& contents, const std::string& format,
                const std::vector<std::string>& warnings, const CommonOptions& common, Console& console);

/// URDF (design/urdf/urdf_writer.hpp) of a scene, or of a design at its parameters' values. Trajectories have no joints.
int export_robot(const std::string& path, const std::string& to, const CommonOptions& common, Console& console);

/// The scene of a design at its parameters' values (design/reading/scene_text.hpp).
int export_scene(const std::string& path, const std::string& to, const CommonOptions& common, Console& console);

}  // namespace fettle::design::cli
