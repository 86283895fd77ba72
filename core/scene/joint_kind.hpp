// SPDX-License-Identifier: MIT
/// The kinds of joint, by the `type` that a scene file calls them: the reader takes them, and lists show them.
#pragma once

#include <string_view>
#include <vector>

#include "core/scene/mechanism.hpp"

namespace fettle::core::scene {

struct JointKindInfo {
    JointKind kind = JointKind::ball;
    std::string_view name;
    int freedoms = 0;             ///< that it leaves between its two bodies; of couplings: how many they take away
    std::string_view coordinate;  ///< "angle", "slide", what springs, motors and limits act on; empty: none
    std::string_view meaning;
    std::vector<std::string_view> keys;  ///< besides `name` and `type`; forces (`stiffness`, `limits`, ...) where there is a coordinate
};

/// In the order of JointKind.
inline const std::vector<JointKindInfo>& joint_kinds() {
    static const std::vector<std::string_view> pair{"a", "b", "point", "point_a", "point_b", "collide"};
    static const auto with_axis = [](std::vector<std::string_view> more = {}) {
        std::vector<std::string_view> keys = pair;
        keys.insert(keys.end(), {"axis", "axis_a", "axis_b"});
        keys.insert(keys.end(), more.begin(), more.end());
        return keys;
    };
    static const std::vector<JointKindInfo> kinds{
        {JointKind::ball, "ball", 3, "", "a point of one body stays on a point of the other", with_axis({"swing"})},
        {JointKind::revolute, "revolute", 1, "angle", "hinge: turns about an axis", with_axis({"assemble"})},
        {JointKind::prismatic, "prismatic", 1, "slide", "slides along an axis, without turning", with_axis({"assemble"})},
        {JointKind::cylindrical, "cylindrical", 2, "slide", "slides along an axis and turns about it", with_axis()},
        {JointKind::planar, "planar", 3, "", "a point stays in the plane across an axis, free to turn about it", with_axis()},
        {JointKind::fixed, "fixed", 0, "", "the two bodies are one", pair},
        {JointKind::screw, "screw", 1, "angle", "turns about an axis and slides `pitch` along it with each turn", with_axis({"pitch"})},
        {JointKind::gear, "gear", 1, "", "the angles of two joints in a fixed `ratio` (or of `teeth`)", {"of", "ratio", "teeth"}},
        {JointKind::rack, "rack", 1, "", "the slide of one joint follows the angle of another, at a `radius`", {"of", "radius"}}};
    return kinds;
}

}  // namespace fettle::core::scene
