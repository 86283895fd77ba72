// SPDX-License-Identifier: MIT
// Bodies that joints hold and motors drive, followed without dynamics: closed forms, turns, what is refused.
#include "core/stepper/jointed_motion.hpp"

#include "tests/support/mechanisms.hpp"

namespace fettle::core::stepper::jointed_motion_test {

using namespace fettle::tests::mechanisms;
using core::scene::JointKind;
using fettle::tests::support::contains;

namespace {

const Vector3 z_axis = Vector3::UnitZ();
constexpr double crank = 0.1, rod = 0.3;

// The piston slides along x; the motor turns the crank once and a half in a second.
scene::Scene slider_crank() {
    scene::Scene scene =
        scene_of({bar("crank", crank), bar("rod", rod, Vector3(crank, 0, 0)), bar("piston", 0.05, Vector3(crank + rod, 0, 0))}, 0.02);
    scene.mechanism.joints = {
        joint("main", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("big", JointKind::revolute, {"crank", Vector3(crank, 0, 0), z_axis}, {"rod", Vector3::Zero(), z_axis}),
        joint("small", JointKind::revolute, {"rod", Vector3(rod, 0, 0), z_axis}, {"piston", Vector3::Zero(), z_axis}),
        joint("guide", JointKind::prismatic, {"", Vector3::Zero(), Vector3::UnitX()}, {"piston", Vector3::Zero(), Vector3::UnitX()})};
    scene.mechanism.motors = {motor("drive", "main", at_rate(3 * M_PI))};
    return scene;
}

double piston_at(double angle) {
    return crank * std::cos(angle) + std::sqrt(rod * rod - crank * crank * std::sin(angle) * std::sin(angle));
}

}  // namespace

TEST_CASE("jointed motion: a slider-crank over a turn and a half, by trigonometry", "[mechanism]") {
    const model::Model model = built(slider_crank());
    const auto motion = follow_joints(model, 50, 1e-6);
    REQUIRE(motion);
    CHECK(motion->held.empty());
    CHECK(motion->joint_gap <= 1e-6);
    CHECK(motion->parts > 1);
    const Trajectory& t = motion->trajectory;
    REQUIRE(t.poses.size() == static_cast<std::size_t>(50 * motion->parts + 1));
    for (std::size_t i = 0; i < t.poses.size(); ++i) {
        const double angle = 3 * M_PI * t.timestep * static_cast<double>(i);
        const Vector3 end = kinematics::world_position(t.poses[i][2], -model.bodies[2].reference_point);
        CHECK((end - Vector3(piston_at(angle), 0, 0)).norm() < 1e-9);
    }
}

TEST_CASE("jointed motion: what joints may part by goes with the mechanism's size, whatever stands beside it", "[mechanism]") {
    scene::Scene scene = slider_crank();
    const double gap = default_joint_gap(built(scene));
    CHECK(gap > 1e-6 * rod);
    CHECK(gap < 1e-4 * rod);
    for (scene::Body& body : scene.bodies) {
        body.mesh.vertices *= 1e-3;
        body.pose.position *= 1e-3;
    }
    for (scene::Joint& joint : scene.mechanism.joints)
        for (Vector3* point : {&joint.a.point, &joint.b.point}) *point *= 1e-3;
    CHECK(default_joint_gap(built(scene)) == Approx(1e-3 * gap));
    scene::Body floor;
    floor.name = "floor";
    floor.mesh = tests::support::box_mesh(Vector3(-50, -50, -2), Vector3(50, 50, -1));
    floor.type = scene::BodyType::static_body;
    scene.bodies.push_back(floor);
    CHECK(default_joint_gap(built(scene)) == Approx(1e-3 * gap));
}

TEST_CASE("jointed motion: a small mechanism far from the origin is followed to the rounding of its places") {
    scene::Scene scene = slider_crank();
    const Vector3 away(5.4, -9.6, -4.6);
    for (scene::Body& body : scene.bodies) {
        body.mesh.vertices *= 1e-3;
        body.pose.position = 1e-3 * body.pose.position + away;
    }
    for (scene::Joint& joint : scene.mechanism.joints) {
        for (scene::Attachment* end : {&joint.a, &joint.b}) {
            end->point *= 1e-3;
            if (end->body.empty()) end->point += away;
        }
    }
    const auto motion = follow_joints(built(scene), 50, 1e-8);
    CAPTURE(motion ? std::string() : motion.errors()[0].message);
    CHECK(motion);
}

TEST_CASE("jointed motion: joints part between nodes by less than is told, and a finer path is asked for by a smaller gap", "[mechanism]") {
    const model::Model model = built(slider_crank());
    const auto coarse = follow_joints(model, 50, 1), fine = follow_joints(model, 50, 1e-5);
    REQUIRE(coarse);
    REQUIRE(fine);
    CHECK(coarse->parts == 1);
    CHECK(fine->parts > 4);
    double worst = 0;
    for (int t = 0; t < 50; ++t)
        for (double s = 0; s <= 1; s += 0.125) {
            const kinematics::Pose a = pose_at(coarse->trajectory, t, 0, s, 0), b = pose_at(coarse->trajectory, t, 0, s, 1);
            const Vector3 on_crank = world_position(a, Vector3(crank, 0, 0) - model.bodies[0].reference_point);
            worst = std::max(worst, (on_crank - world_position(b, -model.bodies[1].reference_point)).norm());
        }
    CHECK(worst <= coarse->joint_gap);
    CHECK(worst > 0.2 * coarse->joint_gap);
}

TEST_CASE("jointed motion: a motor that tells nothing at a dead centre is not left out", "[mechanism]") {
    scene::Scene scene = slider_crank();  // it begins at one
    const auto travel = motor("pull", "guide", at_rate(-0.1));
    scene.mechanism.motors = {travel};
    const auto alone = follow_joints(built(scene), 50, 1e-6);
    REQUIRE(!alone);
    for (const char* body : {"crank", "rod", "piston"}) CHECK(contains(alone.errors()[0].message, body));
    scene.mechanism.motors = {motor("drive", "main", at_rate(3 * M_PI)), travel};
    const auto both = follow_joints(built(scene), 50, 1e-6);
    REQUIRE(!both);
    CHECK(contains(both.errors()[0].message, "the joints cannot be met: "));
    CHECK(contains(both.errors()[0].message, "`pull`"));
}

TEST_CASE("jointed motion: what nothing drives is held, what is not determined is refused by name", "[mechanism]") {
    scene::Scene still = slider_crank();
    still.mechanism.motors.clear();
    const auto held = follow_joints(built(still), 5, 1e-6);
    REQUIRE(!held.has_value() == false);
    CHECK(held->held == std::vector<std::string>{"crank", "piston", "rod"});
    scene::Scene open = slider_crank();
    open.mechanism.joints.pop_back();  // nothing guides the piston
    const auto refused = follow_joints(built(open), 5, 1e-6);
    REQUIRE(!refused);
    CHECK(contains(refused.errors()[0].message, "crank, piston, rod"));
    // A crank longer than the rod cannot turn wholly: it stops where it is at right angles to the rod.
    scene::Scene blocked = slider_crank();
    blocked.bodies[1] = bar("rod", 0.08, Vector3(crank, 0, 0));
    blocked.bodies[2].pose.position.x() = crank + 0.08;
    blocked.mechanism.joints[2].a.point = Vector3(0.08, 0, 0);
    const auto stuck = follow_joints(built(blocked), 50, 1e-6);
    REQUIRE(!stuck);
    CHECK(contains(stuck.errors()[0].message, "the joints cannot be met"));
}

}  // namespace fettle::core::stepper::jointed_motion_test
