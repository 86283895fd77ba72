// SPDX-License-Identifier: MIT
// Records of joints: pairs that do not collide, tables, what a continued run must share.
#include <algorithm>
#include <filesystem>

#include "core/records/continuation.hpp"
#include "core/records/scene_parts.hpp"
#include "core/records/step_tables.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/records/trajectory_reader.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::records::joint_records_test {

using namespace fettle::tests::mechanisms;
using core::scene::JointKind;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

scene::Scene geared_pair() {
    scene::Scene scene = scene_of({bar("first", 0.1), bar("second", 0.1, Vector3(0.3, 0, 0)), bar("third", 0.1, Vector3(0.4, 0, 0))}, 0.01);
    for (scene::Body& body : scene.bodies) body.group = -1;
    scene.mechanism.joints = {
        joint("one", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"first", Vector3::Zero(), z_axis}),
        joint("two", JointKind::revolute, {"", Vector3(0.3, 0, 0), z_axis}, {"second", Vector3::Zero(), z_axis}),
        joint("arm", JointKind::revolute, {"second", Vector3(0.1, 0, 0), z_axis}, {"third", Vector3::Zero(), z_axis})};
    scene::Joint gear = joint("gear", JointKind::gear, {}, {});
    gear.of = {"one", "two"};
    gear.ratio = -0.37;
    scene.mechanism.joints.push_back(gear);
    scene.mechanism.motors = {motor("drive", "one", at_rate(30))};
    return scene;
}

}  // namespace

TEST_CASE("a stored run with joints knows who may not collide, and goes on with the same bits", "[records][joints]") {
    const model::Model model = built(geared_pair());
    const stepper::Simulation whole = run(model, 80), part = run(model, 50);
    tests::support::TemporaryFolder folder;
    const std::string file = (folder.path / "trajectory.json").string();
    REQUIRE(write_trajectory(file, part.trajectory, model, "a.scene.json", &part.checkpoint).empty());
    const auto stored = read_trajectory(file);
    REQUIRE(stored);
    CHECK(stored->model.mechanism.not_colliding == std::vector<std::pair<int, int>>{{1, 2}});
    CHECK(!may_collide(stored->model, 2, 1));
    CHECK(may_collide(stored->model, 0, 1));
    const auto resumed = resumable(*stored, model);
    REQUIRE(resumed);
    stepper::SimulationOptions options;
    options.steps = 80;
    options.resume = &*resumed;
    const stepper::Simulation joined = simulate(model, options);
    REQUIRE(joined.trajectory.poses.size() == 81);
    for (std::size_t i = 0; i < 3; ++i) CHECK(pose_matrix(joined.trajectory.poses[80][i]) == pose_matrix(whole.trajectory.poses[80][i]));
    scene::Scene other = geared_pair();
    other.mechanism.motors[0].curve.rate = 29;
    CHECK(!resumable(*stored, built(other)));
}

TEST_CASE("the table of joints has a row for each joint, gear and motor of each step", "[records][joints]") {
    const model::Model model = built(geared_pair());
    const stepper::Simulation out = run(model, 4);
    const std::string text = joints_csv(out, model.mechanism);
    CHECK(std::count(text.begin(), text.end(), '\n') == 1 + 4 * 5);
    CHECK(text.rfind("time,name,fx,fy,fz,tx,ty,tz,effort,spring,damping,friction,stop\n0.01,one,", 0) == 0);
    CHECK(text.find("\n0.04,drive,") != std::string::npos);
}

}  // namespace fettle::core::records::joint_records_test
