// SPDX-License-Identifier: MIT
/// A scene as a robot description (URDF): links with meshes and inertia, joints with limits, damping and friction.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/model/model.hpp"
#include "core/scene/scene.hpp"
#include "design/urdf/robot_notes.hpp"

namespace fettle::design::urdf {

struct ExportedRobot {
    std::vector<std::pair<std::string, std::string>> files;  ///< STEM.urdf, then STEM.meshes/BODY.stl
    std::vector<std::string> warnings;                       ///< things that URDF cannot say, by name; what was not known
};

/// A tree from the root link "world". Its frames: a link's has the axes of the body's file and stands at the point of the joint that it
/// hangs from; bodies that no joint carries hang from the world, fixed if they do not move, floating else. revolute with limits, continuous
/// without; prismatic, fixed, planar; gear and rack as `mimic`. Meshes are STL in millimetres, scaled by 0.001.
/// @param model  of the scene: mass and inertia.
/// @param notes  what an import kept (robot_notes.hpp): colours, frames, effort and velocity, and where each coordinate is 0.
/// Errors: unsupported, by name: a joint that URDF has not (ball, cylindrical, screw), joints that close a loop, couplings that do so.
Result<ExportedRobot> robot_of_scene(const core::scene::Scene& scene, const core::model::Model& model, const RobotNotes& notes,
                                     const std::string& stem);

}  // namespace fettle::design::urdf
