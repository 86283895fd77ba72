// SPDX-License-Identifier: MIT
#include "core/constraint/whole_turns.hpp"

#include <catch2/catch.hpp>

#include "core/stepper/jointed_motion.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::constraint::whole_turns_test {

using namespace fettle::tests::mechanisms;
using scene::JointKind;

namespace {

constexpr double degree = M_PI / 180, turn = 2 * M_PI;
const Vector3 z_axis = Vector3::UnitZ();

// Crank, coupler and rocker on a base of 0.1, of which the rocker is written at `rocker` and assembled on the right.
scene::Scene four_bar(double crank, double rocker) {
    constexpr double a = 0.06, b = 0.12, c = 0.06;
    scene::Scene scene = scene_of(
        {bar("crank", a, Vector3::Zero(), Vector3(0, 0, crank)), bar("coupler", b, Vector3(a * std::cos(crank), a * std::sin(crank), 0)),
         bar("rocker", c, Vector3(0.1, 0, 0), Vector3(0, 0, rocker))},
        0.01);
    scene.mechanism.joints = {joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
                              joint("A", JointKind::revolute, {"crank", Vector3(a, 0, 0), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
                              joint("B", JointKind::revolute, {"coupler", Vector3(b, 0, 0), z_axis}, {"rocker", Vector3(c, 0, 0), z_axis}),
                              joint("C", JointKind::revolute, {"", Vector3(0.1, 0, 0), z_axis}, {"rocker", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[2].assemble = scene::Assemble{scene::AssembleSide::right, "A", "C"};
    scene.mechanism.motors = {motor("drive", "O", at_rate(0.5))};
    return scene;
}

double about_z(const Matrix3& rotation) { return std::atan2(rotation(1, 0), rotation(0, 0)); }

double angle_of(const model::Model& model, const std::string& name) {
    for (const model::Joint& joint : model.mechanism.joints)
        if (joint.name == name && !joint.is_motor) return model.mechanism.angles_start[joint.coordinate];
    FAIL("no joint " << name);
    return 0;
}

}  // namespace

TEST_CASE("whole turns: those after which geared joints are back", "[turns]") {
    CHECK(turns_to_return({1}) == 1);
    CHECK(turns_to_return({1, -2.0 / 3}) == 3);
    CHECK(turns_to_return({1, 0.5, 0.75}) == 4);
    CHECK(!turns_to_return({1, std::sqrt(2)}));
}

TEST_CASE("whole turns: a joint's angle at the start is within half a turn of the start as written, however it was assembled", "[turns]") {
    for (const double crank : {60.0, 100.0, -75.0})
        for (int k = 0; k < 72; ++k) {
            const double written = (5 * k - 178) * degree;
            const model::Model model = built(four_bar(crank * degree, written));
            const double stands = about_z(model.bodies[2].pose_start.rotation);
            const double wanted = std::remainder(stands - written, turn);
            CAPTURE(crank, written / degree, stands / degree);
            CHECK(std::abs(angle_of(model, "C") - wanted) < 1e-9);
            CHECK(std::abs(angle_of(model, "O")) < 1e-12);
        }
}

TEST_CASE("whole turns: what a motor says at the start counts, and so does what is geared to it", "[turns]") {
    scene::Scene scene = scene_of({bar("one", 0.1), bar("two", 0.1, Vector3(0.5, 0, 0)), bar("rack", 0.1, Vector3(0, 0.5, 0))}, 0.01);
    scene.mechanism.joints = {joint("A", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"one", Vector3::Zero(), z_axis}),
                              joint("B", JointKind::revolute, {"", Vector3(0.5, 0, 0), z_axis}, {"two", Vector3::Zero(), z_axis}),
                              joint("S", JointKind::prismatic, {"", Vector3(0, 0.5, 0), z_axis}, {"rack", Vector3::Zero(), z_axis}),
                              joint("gear", JointKind::gear, {}, {}), joint("pinion", JointKind::rack, {}, {})};
    scene.mechanism.joints[3].of = {"A", "B"};
    scene.mechanism.joints[3].ratio = -2;
    scene.mechanism.joints[4].of = {"B", "S"};
    scene.mechanism.joints[4].ratio = 0.01;
    scene::Curve curve;
    curve.times = {0, 1};
    curve.values = {750 * degree, 760 * degree};
    scene.mechanism.motors = {motor("drive", "A", curve)};
    const model::Model model = built(scene);
    CHECK(angle_of(model, "A") == Approx(750 * degree));
    CHECK(angle_of(model, "B") == Approx(-1500 * degree));
    CHECK(model.bodies[2].pose_start.position.z() - model.bodies[2].reference_point.z() == Approx(-0.01 * 1500 * degree));
}

TEST_CASE("whole turns: joints that gears alone join are turned together", "[turns]") {
    measure::MeasureSet set;
    set.frames.resize(2);
    for (int k = 0; k < 3; ++k) set.measures.push_back({measure::MeasureKind::angle, 0, 1, 0, 0, {}});
    set.measures.push_back({measure::MeasureKind::offset, 0, 1, 2, 0, {}});
    const Row gear{0, {{0, 0.5}, {1, -1}}, 0, {}, 1, 0}, rack{1, {{2, 0.01}, {3, -1}}, 0, {}, 1, 1};
    const std::vector<double> found{4 * turn + 0.2, 2 * turn + 0.1, turn + 0.3, 0}, wanted{0.1, 0.0, 0.0, 0};
    const std::vector<double> turned = nearest_turns(set, {gear, rack}, wanted, found);
    CHECK(turned[0] == Approx(0.2));
    CHECK(turned[1] == Approx(0.1));
    CHECK(turned[2] == Approx(turn + 0.3));  // the rack says it
    CHECK(nearest_turns(set, {}, wanted, found)[2] == Approx(0.3));
    const Row odd{0, {{0, std::sqrt(2)}, {1, -1}}, 0, {}, 1, 0};
    CHECK(nearest_turns(set, {odd}, wanted, found)[0] == found[0]);
}

}  // namespace fettle::core::constraint::whole_turns_test
