// SPDX-License-Identifier: MIT
/// How a body of our own format moves: start pose, velocities, loads, prescribed coordinates, scripts. The rest of a body: scene_body.hpp.
/// Faults go to the document; values read after a fault are never used.
#pragma once

#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::scene_files {

/// A pose, and its rotation as it was written.
struct WrittenPose {
    kinematics::Pose pose;
    scene::Orientation orientation;
};

/// `position`, `rotation` or `rotation_vector`, where absent those of `otherwise`. @param unit  of lengths [m].
WrittenPose read_pose(const files::JsonNode& node, double unit, const kinematics::Pose& otherwise);

/// Velocities, loads, `fixed`, `prescribed` and `script` of a body whose type and pose are known.
void read_motion(const files::JsonNode& node, double unit, scene::Body& body);

}  // namespace fettle::core::scene_files
