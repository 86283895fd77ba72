// SPDX-License-Identifier: MIT
/// The notes of robot_notes.hpp as a scene's file has them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/base/result.hpp"
#include "design/urdf/robot_notes.hpp"

namespace fettle::design::urdf {

/// Those of a scene's file. Errors: of the file; what is there and cannot be meant, by its place.
Result<RobotNotes> read_robot_notes(const std::string& scene_path);

/// Lengths in millimetres.
nlohmann::ordered_json notes_json(const BodyNotes& notes);
nlohmann::ordered_json notes_json(const JointNotes& notes, bool turns);

}  // namespace fettle::design::urdf
