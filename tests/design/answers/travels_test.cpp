// SPDX-License-Identifier: MIT
// How far bodies go: whole turns about an axis are counted, trembling is not added up, and what stands still is said to.
#include "design/answers/travels.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace fettle::design::answers::travels_test {

TEST_CASE("travels: turns about an axis, ways there and back, and what stands still") {
    core::model::Model model;
    model.length_unit = 1e-3;
    for (const char* name : {"crank", "slide", "block", "loose"}) {
        model.bodies.emplace_back();
        model.bodies.back().name = name;
    }
    core::stepper::Trajectory trajectory;
    constexpr int steps = 40;
    for (int t = 0; t <= steps; ++t) {
        std::vector<core::kinematics::Pose> poses(4);
        const double share = static_cast<double>(t) / steps, turn = 5 * std::numbers::pi * share;  // two turns and a half
        const Matrix3 axes = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
        poses[0].rotation = Eigen::AngleAxisd(turn, Vector3(1, 1, 0).normalized()).toRotationMatrix() * axes;
        poses[1].position = Vector3(0.03 * std::sin(std::numbers::pi * share), 0, 0.5);  // out by 30 mm, and back
        poses[3].rotation = Eigen::AngleAxisd(t % 2 == 0 ? 0 : 0.01, Vector3::UnitZ()).toRotationMatrix();
        trajectory.poses.push_back(poses);
    }
    const std::vector<Travel> found = travels(model, trajectory);
    CHECK(found[0].turn == Approx(5 * std::numbers::pi));
    CHECK(found[0].distance == 0);
    CHECK(found[1].distance == Approx(0.03));
    CHECK_FALSE(found[2].is_motion());
    CHECK(found[3].turn == Approx(0.01));
    CHECK(travels_text(model, found) == "moved: crank (turned 900 deg), slide (30 mm), loose (turned 0.573 deg); not moved: block");
    CHECK(travels_text(model, std::vector<Travel>(4)) == "nothing moved");
}

}  // namespace fettle::design::answers::travels_test
