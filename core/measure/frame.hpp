// SPDX-License-Identifier: MIT
/// Frames fixed in bodies or in the world: what measures (measure.hpp) are taken between. docs/method/joints.md#measures.
#pragma once

#include <vector>

#include "core/kinematics/path.hpp"

namespace fettle::core::measure {

inline constexpr int world = -1;  ///< in place of a body's index

struct Frame {
    int body = world;
    Vector3 point = Vector3::Zero();     ///< in the body's frame, from its reference point [m]; of the world, in the world's
    Matrix3 axes = Matrix3::Identity();  ///< columns x, y, z, orthonormal, in the same frame
};

/// Where a frame is, as derivatives want it.
struct PlacedFrame {
    Vector3 arm = Vector3::Zero();       ///< R X, from the body's reference point; 0 of the world [m]
    Vector3 point = Vector3::Zero();     ///< q + R X [m]
    Matrix3 axes = Matrix3::Identity();  ///< R A
};

inline PlacedFrame placed(const Frame& frame, const std::vector<kinematics::Pose>& poses) {
    if (frame.body == world) return {Vector3::Zero(), frame.point, frame.axes};
    const kinematics::Pose& pose = poses[frame.body];
    const Vector3 arm = pose.rotation * frame.point;
    return {arm, pose.position + arm, pose.rotation * frame.axes};
}

inline std::vector<PlacedFrame> placed(const std::vector<Frame>& frames, const std::vector<kinematics::Pose>& poses) {
    std::vector<PlacedFrame> out(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) out[i] = placed(frames[i], poses);
    return out;
}

}  // namespace fettle::core::measure
