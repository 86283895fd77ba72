// SPDX-License-Identifier: MIT
/// Linkages of ordinary hinges, which determine more than is needed to keep them in their plane: for the tests of dependent rows.
#pragma once

#include <string>
#include <vector>

#include "tests/support/mechanisms.hpp"

namespace fettle::tests::mechanisms {

/// A scene in the plane x, y, turned and shifted as a whole by a rotation of the world.
inline core::scene::Scene turned_as_a_whole(core::scene::Scene scene, const Matrix3& turn) {
    for (core::scene::Body& body : scene.bodies) {
        body.pose.position = turn * body.pose.position;
        body.pose.rotation = turn * body.pose.rotation;
    }
    for (core::scene::Joint& joint : scene.mechanism.joints)
        for (core::scene::Attachment* end : {&joint.a, &joint.b}) {
            if (!end->body.empty()) continue;
            end->point = turn * end->point;
            end->axis = turn * end->axis;
        }
    return scene;
}

/// A scissor lift with arms of 0.2 m, hinged at their ends and middles, its foot at the origin, that a motor "drive" on the slide "slide"
/// of its block raises from one angle of the arms to another within 0.5 s. Bodies: the block, then arms A0, B0, A1, B1 ...
inline core::scene::Scene scissor_lift(int stages, double from, double to) {
    using core::scene::JointKind;
    constexpr double length = 0.2;
    const Vector3 x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ(), middle(length / 2, 0, 0), end(length, 0, 0);
    const double width = length * std::cos(from), rise = length * std::sin(from);
    std::vector<core::scene::Body> bodies{bar("block", 0.02, Vector3(width, 0, 0))};
    std::vector<core::scene::Joint> joints{
        joint("slide", JointKind::prismatic, {"", Vector3(width, 0, 0), x_axis}, {"block", Vector3::Zero(), x_axis})};
    for (int k = 0; k < stages; ++k) {
        const std::string n = std::to_string(k), before = std::to_string(k - 1), a = "A" + n, b = "B" + n;
        bodies.push_back(bar(a, length, Vector3(0, k * rise, 0), Vector3(0, 0, from)));
        bodies.push_back(bar(b, length, Vector3(width, k * rise, 0), Vector3(0, 0, M_PI - from)));
        const core::scene::Attachment left = k == 0 ? core::scene::Attachment{"", Vector3::Zero(), z_axis}
                                                    : core::scene::Attachment{"B" + before, end, z_axis},
                                      right = k == 0 ? core::scene::Attachment{"block", Vector3::Zero(), z_axis}
                                                     : core::scene::Attachment{"A" + before, end, z_axis};
        joints.push_back(joint("left" + n, JointKind::revolute, left, {a, Vector3::Zero(), z_axis}));
        joints.push_back(joint("right" + n, JointKind::revolute, right, {b, Vector3::Zero(), z_axis}));
        joints.push_back(joint("middle" + n, JointKind::revolute, {a, middle, z_axis}, {b, middle, z_axis}));
    }
    core::scene::Scene scene = scene_of(std::move(bodies), 0.05);
    scene.end_time = 0.5;
    scene.mechanism.joints = std::move(joints);
    core::scene::Curve curve;
    curve.times = {0, 0.5};
    curve.values = {0, length * std::cos(to) - width};
    scene.mechanism.motors = {motor("drive", "slide", curve)};
    return scene;
}

/// Three equal cranks under one rod, at this angle; a motor turns the first by `turn` in 1 s.
inline core::scene::Scene three_cranks(double angle, double turn) {
    using core::scene::JointKind;
    const Vector3 z_axis = Vector3::UnitZ(), tip(0.05, 0, 0);
    const Matrix3 at = core::kinematics::rotation(Vector3(0, 0, angle));
    std::vector<core::scene::Body> bodies;
    for (const double x : {0.0, 0.1, 0.2})
        bodies.push_back(bar("crank" + std::to_string(bodies.size()), 0.05, Vector3(x, 0, 0), Vector3(0, 0, angle)));
    bodies.push_back(bar("rod", 0.2, at * tip));
    core::scene::Scene scene = scene_of(std::move(bodies), 0.01);
    scene.end_time = 1;
    for (int k = 0; k < 3; ++k) {
        const std::string n = std::to_string(k), crank = "crank" + n;
        scene.mechanism.joints.push_back(
            joint("O" + n, JointKind::revolute, {"", Vector3(0.1 * k, 0, 0), z_axis}, {crank, Vector3::Zero(), z_axis}));
        scene.mechanism.joints.push_back(
            joint("A" + n, JointKind::revolute, {crank, tip, z_axis}, {"rod", Vector3(0.1 * k, 0, 0), z_axis}));
    }
    core::scene::Curve curve;
    curve.times = {0, 1};
    curve.values = {0, turn};
    scene.mechanism.motors = {motor("drive", "O0", curve)};
    return scene;
}

}  // namespace fettle::tests::mechanisms
