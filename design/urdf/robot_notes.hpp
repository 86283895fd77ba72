// SPDX-License-Identifier: MIT
/// The data of a robot description that a scene does not use: kept from import to export, under the key `urdf` of a scene's bodies and
/// joints.
///     {"name": "hand", ..., "urdf": {"colour": [0.5, 0.5, 0.5, 1], "frames": [{"name": "tool", "joint": "mount", "position": [0, 0,
///     40]}]}}
///     {"name": "slide", ..., "urdf": {"start": 12.5, "effort": 30, "velocity": 0.2}}
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "design/urdf/robot.hpp"

namespace fettle::design::urdf {

/// A link without geometry that is fixed to a body: of a tool, of a camera.
struct FrameNote {
    std::string name, joint;      ///< the joint that fixes it
    core::kinematics::Pose pose;  ///< in the frame of the body's mesh
};

struct BodyNotes {
    std::optional<Rgba> colour;
    std::vector<FrameNote> frames;
    bool empty() const { return !colour && frames.empty(); }
};

struct JointNotes {
    double start = 0;                        ///< what the coordinate is called where the scene begins [rad] or [m]
    std::optional<double> effort, velocity;  ///< as Joint's
    bool empty() const { return start == 0 && !effort && !velocity; }
};

struct RobotNotes {
    std::map<std::string, BodyNotes> bodies;  ///< by name
    std::map<std::string, JointNotes> joints;
};

}  // namespace fettle::design::urdf
