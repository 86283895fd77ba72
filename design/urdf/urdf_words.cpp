// SPDX-License-Identifier: MIT
#include "design/urdf/urdf_words.hpp"

#include <algorithm>

namespace fettle::design::urdf {

namespace {

constexpr std::string_view no_names = "bodies have one shape, without parts that have names";
constexpr std::string_view no_pictures = "surfaces have no pictures";
constexpr std::string_view not_seen = "it is of what is not seen";
constexpr std::string_view no_controllers = "a scene has no controllers";
constexpr std::string_view no_rates = "a scene has no limits of acceleration";

/// What stands within <visual> and within <collision>, but for materials.
void add_shapes(std::vector<UrdfElement>& elements, bool is_visual) {
    const auto path = [&](std::string_view visual, std::string_view collision) { return is_visual ? visual : collision; };
    elements.insert(elements.end(),
                    {{path("robot/link/visual", "robot/link/collision"), {{"name", no_names}}},
                     {path("robot/link/visual/origin", "robot/link/collision/origin"), {{"xyz"}, {"rpy"}}},
                     {path("robot/link/visual/geometry", "robot/link/collision/geometry")},
                     {path("robot/link/visual/geometry/box", "robot/link/collision/geometry/box"), {{"size"}}},
                     {path("robot/link/visual/geometry/cylinder", "robot/link/collision/geometry/cylinder"), {{"radius"}, {"length"}}},
                     {path("robot/link/visual/geometry/sphere", "robot/link/collision/geometry/sphere"), {{"radius"}}},
                     {path("robot/link/visual/geometry/mesh", "robot/link/collision/geometry/mesh"), {{"filename"}, {"scale"}}}});
}

std::vector<UrdfElement> make_elements() {
    std::vector<UrdfElement> elements{
        {"robot", {{"name"}, {"version", "nothing depends on it"}}},
        {"robot/material", {{"name"}}},
        {"robot/material/color", {{"rgba"}}},
        {"robot/material/texture", {}, no_pictures},
        {"robot/transmission", {}, "a scene has no transmissions of actuators"},
        {"robot/gazebo", {}, "it is for Gazebo alone"},
        {"robot/sensor", {}, "a scene has no sensors"},
        {"robot/link", {{"name"}, {"type", "nothing depends on it"}}},
        {"robot/link/inertial"},
        {"robot/link/inertial/origin", {{"xyz"}, {"rpy"}}},
        {"robot/link/inertial/mass", {{"value"}}},
        {"robot/link/inertial/inertia", {{"ixx"}, {"ixy"}, {"ixz"}, {"iyy"}, {"iyz"}, {"izz"}}},
        {"robot/link/visual/material", {{"name"}}},
        {"robot/link/visual/material/color", {{"rgba"}}},
        {"robot/link/visual/material/texture", {}, no_pictures},
        {"robot/link/collision/material", {}, not_seen},
        {"robot/link/collision/verbose", {}, "nothing depends on it"},
        {"robot/joint", {{"name"}, {"type"}}},
        {"robot/joint/origin", {{"xyz"}, {"rpy"}}},
        {"robot/joint/parent", {{"link"}}},
        {"robot/joint/child", {{"link"}}},
        {"robot/joint/axis", {{"xyz"}}},
        {"robot/joint/calibration", {}, no_controllers},
        {"robot/joint/dynamics", {{"damping"}, {"friction"}}},
        {"robot/joint/limit",
         {{"lower"}, {"upper"}, {"effort"}, {"velocity"}, {"acceleration", no_rates}, {"deceleration", no_rates}, {"jerk", no_rates}}},
        {"robot/joint/mimic", {{"joint"}, {"multiplier"}, {"offset"}}},
        {"robot/joint/safety_controller", {}, no_controllers}};
    add_shapes(elements, true);
    add_shapes(elements, false);
    return elements;
}

}  // namespace

const std::vector<UrdfElement>& urdf_elements() {
    static const std::vector<UrdfElement> elements = make_elements();
    return elements;
}

const UrdfElement* find_urdf_element(std::string_view path) {
    const auto& elements = urdf_elements();
    const auto found = std::find_if(elements.begin(), elements.end(), [&](const UrdfElement& each) { return each.path == path; });
    return found == elements.end() ? nullptr : &*found;
}

}  // namespace fettle::design::urdf
