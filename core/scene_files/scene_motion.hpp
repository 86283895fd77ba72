// SPDX-License-Identifier: MIT
/// How a body of our own format moves: start pose, velocities, loads, prescribed coordinates, scripts. The rest of a body: scene_body.hpp.
/// Faults go to the document; values read after a fault are never used.
#pragma once

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/scene.hpp"

namespace fettle::core::scene_files {

/// `position`, `rotation` or `rotation_vector`, where absent those of `otherwise`. @param unit  of lengths [m].
kinematics::Pose read_pose(const files::JsonNode& node, double unit, const kinematics::Pose& otherwise);
/// The rotation alone, as written; none: absent, or wrong.
std::optional<scene::Orientation> read_orientation(const files::JsonNode& node);

/// Velocities, loads, `fixed`, `prescribed` and `script` of a body whose type and pose are known.
void read_motion(const files::JsonNode& node, double unit, scene::Body& body);

}  // namespace fettle::core::scene_files
