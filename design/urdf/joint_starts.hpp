// SPDX-License-Identifier: MIT
/// Where the joints of a robot stand when its scene begins: each within its limits, as near to coordinate 0 as may be, and a joint that
/// mimics another one where that has it: coordinate = multiplier * that of the other + offset.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "design/urdf/robot.hpp"

namespace fettle::design::urdf {

struct JointStart {
    double coordinate = 0;  ///< [rad] or [m]
    bool is_held = false;   ///< it mimics with a multiplier of 0, directly or by the joint between: it does not move
};

struct JointStarts {
    std::unordered_map<std::string, JointStart> of;  ///< joints with a coordinate, by name
    std::vector<std::string> warnings;               ///< where no position lets all be within their limits
};

/// Errors (inconsistent): what mimics a joint that is not there, itself by way of others, or one without one coordinate; or has none
/// itself.
Result<JointStarts> joint_starts(const Robot& robot);

}  // namespace fettle::design::urdf
