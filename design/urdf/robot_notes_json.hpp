// SPDX-License-Identifier: MIT
/// The notes of robot_notes.hpp as a scene's file has them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fettle/design/urdf/robot_notes.hpp"

namespace fettle::design::urdf {

/// Lengths in millimetres.
nlohmann::ordered_json notes_json(const BodyNotes& notes);
nlohmann::ordered_json notes_json(const JointNotes& notes, bool turns);

}  // namespace fettle::design::urdf
