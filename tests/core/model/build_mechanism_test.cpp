// SPDX-License-Identifier: MIT
// What becomes of joints at the start: assembly, dependent and contradictory joints, velocities.
#include "core/model/build_mechanism.hpp"

#include <numbers>

#include "tests/support/mechanisms.hpp"

namespace fettle::core::model::build_mechanism_test {

using core::setup::build_model;
using namespace fettle::tests::mechanisms;
using core::scene::JointKind;
using fettle::tests::support::contains;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

scene::Scene hinged_bar() {
    scene::Scene scene = scene_of({bar("bar", 0.5)}, 0.01);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"bar", Vector3::Zero(), z_axis})};
    return scene;
}

std::string errors_of(const scene::Scene& scene) {
    const auto model = build_model(scene);
    REQUIRE(!model);
    std::string out;
    for (const auto& error : model.errors()) out += error.message + "\n";
    return out;
}

std::string warnings_of(const Model& model) {
    std::string out;
    for (const std::string& warning : model.warnings) out += warning + "\n";
    return out;
}

}  // namespace

TEST_CASE("errors of a mechanism made in memory have the part's name as their place", "[mechanism]") {
    const auto place = [](const scene::Scene& scene) {
        const auto model = build_model(scene);
        REQUIRE(model.errors().size() == 1);
        return model.errors()[0].where;
    };
    scene::Scene scene = hinged_bar();
    scene.mechanism.joints[0].where.clear();
    scene::Scene nobody = scene;
    nobody.mechanism.joints[0].b.body = "rod";
    CHECK(place(nobody) == "joint `hinge`");
    scene.mechanism.motors.resize(1);
    scene.mechanism.motors[0].name = "drive";
    scene.mechanism.motors[0].joint = "hing";
    CHECK(place(scene) == "motor `drive`");
    scene.mechanism.motors[0].where = "a.scene.json#/motors/0";
    CHECK(place(scene) == "a.scene.json#/motors/0");
}

TEST_CASE("bodies that fit their joints are not moved", "[mechanism]") {
    const Model model = built(hinged_bar());
    CHECK(model.mechanism.rows.size() == 5);
    const Model free = built(scene_of({bar("bar", 0.5)}, 0.01));
    CHECK(model.bodies[0].pose_start.position == free.bodies[0].pose_start.position);
    CHECK(model.bodies[0].pose_start.rotation == free.bodies[0].pose_start.rotation);
    CHECK(model.bodies[0].velocity_start == free.bodies[0].velocity_start);
    CHECK(!contains(warnings_of(model), "moved"));
}

TEST_CASE("a bar off its ball joint is moved least", "[mechanism]") {
    // A ball joint takes the bar's end from (0, 0, -d) to the origin. The nearest by mass of all poses with the end there is a stationary
    // one: moving it further along the joint changes the measure of the way at second order only.
    scene::Scene scene = scene_of({bar("bar", 0.5, Vector3(0.02, 0.01, -0.05))}, 0.01);
    scene.mechanism.joints = {joint("ball", JointKind::ball, {"", Vector3::Zero(), z_axis}, {"bar", Vector3::Zero(), z_axis})};
    const Model model = built(scene);
    CHECK(contains(warnings_of(model), "body `bar` was moved by"));
    const Body& body = model.bodies[0];
    const Vector3 end = kinematics::world_position(body.pose_start, -body.reference_point);
    CHECK(end.norm() < 1e-12);
    const kinematics::Pose written{Matrix3::Identity(), Vector3(0.27, 0.01, -0.05)};
    const auto way = [&](const Vector3& phi) {
        kinematics::Pose pose;
        pose.rotation = kinematics::rotation(phi) * body.pose_start.rotation;
        pose.position = pose.rotation * body.reference_point;
        const Matrix34 d = pose_matrix(pose) - pose_matrix(written);
        return 0.5 * (d * body.moments).cwiseProduct(d).sum();
    };
    for (int k = 0; k < 3; ++k) {
        const double h = 1e-4, plus = way(h * Vector3::Unit(k)), minus = way(-h * Vector3::Unit(k));
        CHECK(std::abs(plus - minus) / (2 * h) < 1e-9 * body.moments(3, 3));
        CHECK(plus + minus > 2 * way(Vector3::Zero()));
    }
}

TEST_CASE("a second hinge on the same axis follows from the first, and is told", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    scene.mechanism.joints.push_back(
        joint("second", JointKind::revolute, {"", Vector3(0, 0, 0.3), z_axis}, {"bar", Vector3(0, 0, 0.3), z_axis}));
    const Model model = built(scene);
    CHECK(model.mechanism.rows.size() == 5);
    CHECK(model.mechanism.dependent.size() == 5);
    CHECK(contains(warnings_of(model), "5 of 10 conditions follow from others"));
    CHECK(contains(warnings_of(model), "second"));
}

TEST_CASE("hinges that contradict one another are named", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    // On the same axis, but 10 mm along it apart from where the first holds the bar.
    scene.mechanism.joints.push_back(
        joint("second", JointKind::revolute, {"", Vector3(0, 0, 0.31), z_axis}, {"bar", Vector3(0, 0, 0.3), z_axis}));
    const std::string message = errors_of(scene);
    CAPTURE(message);
    CHECK(contains(message, "`second`"));
    CHECK(contains(message, "`hinge`"));
    CHECK(contains(message, "contradicts"));
}

TEST_CASE("a loop that cannot close is named with its gap", "[mechanism]") {
    // Two bars of 0.2 m between pivots that are 0.5 m apart: 0.1 m are missing.
    scene::Scene scene =
        scene_of({bar("left", 0.2, Vector3::Zero(), Vector3(0, 0, 0.3)), bar("right", 0.2, Vector3(0.5, 0, 0), Vector3(0, 0, 2.8))}, 0.01);
    scene.mechanism.joints = {joint("A", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"left", Vector3::Zero(), z_axis}),
                              joint("B", JointKind::revolute, {"", Vector3(0.5, 0, 0), z_axis}, {"right", Vector3::Zero(), z_axis}),
                              joint("C", JointKind::revolute, {"left", Vector3(0.2, 0, 0), z_axis}, {"right", Vector3(0.2, 0, 0), z_axis})};
    const std::string message = errors_of(scene);
    CAPTURE(message);
    CHECK(contains(message, "cannot be met"));
    CHECK((contains(message, "`C`") || contains(message, "`A`") || contains(message, "`B`")));
}

TEST_CASE("start velocities agree with joints, changed least", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    scene.bodies[0].linear_velocity = Vector3(1, 2, 0);
    const Model model = built(scene);
    CHECK(contains(warnings_of(model), "start velocities of `bar` were changed"));
    const Matrix34& v = model.bodies[0].velocity_start;
    const Matrix3 omega = v.leftCols<3>();
    // The hinge takes all of x; of y at the centre what an impulse at the hinge leaves: omega = m v d / (I_c + m d^2).
    const double d = 0.25, inertia = (0.25 + 4e-4) / 12, spin = 2 * d / (inertia + d * d);
    CHECK(v.col(3).isApprox(Vector3(0, spin * d, 0), 1e-12));
    CHECK(omega(1, 0) == Approx(spin).epsilon(1e-12));
}

TEST_CASE("start velocities that nobody gave follow joints and motors without a word", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(2))};
    const Model model = built(scene);
    CHECK_FALSE(contains(warnings_of(model), "start velocities"));
    CHECK(model.bodies[0].velocity_start.norm() > 1);  // they do follow
    scene.bodies[0].angular_velocity = Vector3(0, 0, 1);
    CHECK(contains(warnings_of(built(scene)), "start velocities of `bar` were changed"));
}

TEST_CASE("names that stand twice in a list are refused", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(1)), motor("drive", "hinge", at_rate(1))};
    CHECK(contains(errors_of(scene), "another motor is called `drive` already"));
    scene = hinged_bar();
    scene.mechanism.loads = {{"push", "", "bar", Vector3::Zero(), Vector3::UnitX()},
                             {"push", "", "bar", Vector3::Zero(), Vector3::UnitY()}};
    CHECK(contains(errors_of(scene), "another load is called `push` already"));
    for (scene::PointLoad& load : scene.mechanism.loads) load.name.clear();  // those that nobody asks for need none
    CHECK(build_model(scene));
}

TEST_CASE("names that are not there are refused", "[mechanism]") {
    scene::Scene scene = hinged_bar();
    scene.mechanism.joints[0].b.body = "beam";
    CHECK(contains(errors_of(scene), "no body is called `beam`"));
    scene = hinged_bar();
    scene.mechanism.motors = {motor("drive", "hing", at_rate(1))};
    CHECK(contains(errors_of(scene), "no joint is called `hing`"));
    scene = hinged_bar();
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(300))};  // 3 rad in a time step
    CHECK(contains(errors_of(scene), "half a turn or more in one time step"));
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(250))};
    CHECK(build_model(scene));
    scene = hinged_bar();
    scene.integrator = scene::Integrator::newmark;
    CHECK(contains(errors_of(scene), "newmark"));
}

TEST_CASE("two bodies that a joint joins do not collide unless they are told to", "[mechanism]") {
    scene::Scene scene =
        scene_of({bar("one", 0.2), bar("two", 0.2, Vector3(0.15, 0, 0.03)), bar("three", 0.2, Vector3(0.15, 0, 0.06))}, 0.01);
    for (scene::Body& body : scene.bodies) body.group = -1;
    scene.mechanism.joints = {
        joint("hinge", JointKind::revolute, {"one", Vector3(0.18, 0, 0), z_axis}, {"two", Vector3(0.03, 0, -0.03), z_axis})};
    CHECK(!may_collide(built(scene), 0, 1));
    CHECK(may_collide(built(scene), 0, 2));
    CHECK(may_collide(built(scene), 2, 1));
    scene.mechanism.joints[0].collide = true;
    CHECK(may_collide(built(scene), 1, 0));
}

}  // namespace fettle::core::model::build_mechanism_test
