// SPDX-License-Identifier: MIT
// Joints as trees with ranges: against the rows that the simulation holds them by, and what is refused.
#include "core/clearance/joint_ranges.hpp"

#include "core/clearance/range_bound.hpp"
#include "tests/core/clearance/random_trees.hpp"

namespace fettle::core::clearance::joint_ranges_test {

using namespace fettle::tests::mechanisms;
using namespace fettle::tests::trees;
using fettle::tests::support::contains;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

std::string refusal(const scene::Scene& scene) {
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model);
    REQUIRE(!ranges);
    std::string out;
    for (const auto& error : ranges.errors()) out += error.where + ": " + error.message + "\n";
    return out;
}

scene::Scene hinged(const std::optional<std::array<double, 2>>& limits) {
    scene::Scene scene = scene_of({bar("bar", 0.5)}, 0.01);
    scene.mechanism.joints = {
        tests::mechanisms::joint("hinge", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"bar", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].forces.limits = limits;
    return scene;
}

// Where every body is.
std::vector<kinematics::Pose> poses_at(const Tree& tree, const std::vector<double>& u) {
    std::vector<kinematics::Pose> out;
    for (int i = 0; i < count_of(tree.model.bodies); ++i) {
        kinematics::Pose pose = tree.model.bodies[i].pose_start;
        for (int at = i; at >= 0; at = tree.ranges.linkage.bodies[at].parent) {
            const auto& screws = tree.ranges.linkage.bodies[at].screws;
            for (auto screw = screws.rbegin(); screw != screws.rend(); ++screw) {
                const auto k = static_cast<std::size_t>(screw->coordinate);
                const double d = u[k] - tree.ranges.linkage.coordinates[k].start;
                const Matrix3 turn = kinematics::rotation(Vector3(screw->turn * d * screw->axis));
                pose.rotation = turn * pose.rotation;
                pose.position = screw->point + turn * (pose.position - screw->point) + screw->slide * d * screw->axis;
            }
        }
        out.push_back(pose);
    }
    return out;
}

}  // namespace

TEST_CASE("joint ranges: wherever coordinates are, the simulation's rows are met, and the coordinates are theirs", "[ranges]") {
    std::mt19937 random(5);
    for (int i = 0; i < 40; ++i) {
        const Tree tree = random_tree(random);
        const std::vector<double> u = random_coordinates(tree, random);
        const std::vector<kinematics::Pose> poses = poses_at(tree, u);
        const auto& mechanism = tree.model.mechanism;
        const auto frames = placed(mechanism.set.frames, poses);
        std::vector<double> angles(mechanism.set.measures.size(), 0.0);  // with their turns, as the coordinates have them
        for (const auto& joint : mechanism.joints) {
            if (joint.coordinate < 0) continue;
            const auto m = static_cast<std::size_t>(joint.coordinate);
            const double wanted = tests::trees::value_of(tree, u, joint.name), found = value_of(mechanism.set.measures[m], frames);
            const bool angle = mechanism.set.measures[m].kind == measure::MeasureKind::angle;
            angles[m] = angle ? measure::nearest_turn(found, wanted) : found;
            CHECK(angles[m] == Approx(wanted).margin(1e-12));
        }
        const VectorX values = constraint::row_values(mechanism.set, mechanism.rows, frames, angles);
        for (std::size_t k = 0; k < mechanism.rows.size(); ++k) CHECK(std::abs(values[k] - mechanism.rows[k].constant) < 1e-12);
    }
}

TEST_CASE("joint ranges: limits, those of springs on the joint, whole turns without", "[ranges]") {
    const auto range = [](const scene::Scene& scene) {
        const model::Model model = built(scene);
        const auto ranges = joint_ranges(model);
        REQUIRE(ranges);
        REQUIRE(ranges->linkage.coordinates.size() == 1);
        return ranges->linkage.coordinates[0];
    };
    const auto plain = range(hinged(std::array<double, 2>{-0.5, 1}));
    CHECK(plain.low == -0.5);
    CHECK(plain.high == 1);
    CHECK(!plain.is_whole_turn);
    scene::Scene sprung = hinged(std::array<double, 2>{-0.5, 1});
    scene::Spring spring;
    spring.name = "stop";
    spring.joint = "hinge";
    spring.forces.limits = {-0.25, 3};
    sprung.mechanism.springs.push_back(spring);
    CHECK(range(sprung).low == -0.25);
    CHECK(range(sprung).high == 1);
    const auto whole = range(hinged(std::nullopt));
    CHECK(whole.is_whole_turn);
    CHECK(whole.high - whole.low >= 2 * std::numbers::pi);
    CHECK(whole.high - whole.low < 2 * std::numbers::pi + 1e-12);
}

TEST_CASE("joint ranges: gears count once, without limits over as many turns as bring both back", "[ranges]") {
    scene::Scene scene = scene_of({bar("one", 0.2), bar("two", 0.2, Vector3(0.5, 0, 0))}, 0.01);
    scene.mechanism.joints = {
        tests::mechanisms::joint("A", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"one", Vector3::Zero(), z_axis}),
        tests::mechanisms::joint("B", JointKind::revolute, {"", Vector3(0.5, 0, 0), z_axis}, {"two", Vector3::Zero(), z_axis}),
        tests::mechanisms::joint("mesh", JointKind::gear, {}, {})};
    scene.mechanism.joints[2].of = {"A", "B"};
    scene.mechanism.joints[2].ratio = -2.0 / 3;
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model);
    REQUIRE(ranges);
    REQUIRE(ranges->linkage.coordinates.size() == 1);
    const auto& c = ranges->linkage.coordinates[0];
    CHECK(c.joints.size() == 2);
    CHECK(c.high - c.low == Approx(3 * 2 * std::numbers::pi));
    CHECK(ranges->linkage.bodies[1].screws[0].turn == Approx(-2.0 / 3));
    scene.mechanism.joints[1].forces.limits = {-0.2, 0.4};
    const model::Model limited = built(scene);
    const auto narrow = joint_ranges(limited);
    REQUIRE(narrow);
    CHECK(narrow->linkage.coordinates[0].low == Approx(-0.6));
    CHECK(narrow->linkage.coordinates[0].high == Approx(0.3));
    scene.mechanism.joints[1].forces.limits.reset();
    scene.mechanism.joints[2].ratio = std::sqrt(2);
    CHECK(contains(refusal(scene), "no whole number of turns"));
}

TEST_CASE("joint ranges: what cannot be covered is refused by name", "[ranges]") {
    scene::Scene slide = hinged(std::nullopt);
    slide.mechanism.joints[0].kind = JointKind::prismatic;
    CHECK(contains(refusal(slide), "`hinge`: has no limits"));
    scene::Scene planar = hinged(std::nullopt);
    planar.mechanism.joints[0].kind = JointKind::planar;
    CHECK(contains(refusal(planar), "`hinge`: has no limits on its two slides"));
    CHECK(contains(refusal(scene_of({bar("bar", 0.5)}, 0.01)), "there is no joint"));
    scene::Scene held = hinged(std::nullopt);
    held.bodies[0].prescribed[2] = scene::MotionCurve{};
    CHECK(contains(refusal(held), "coordinates of `bar` are prescribed"));
    // A four-bar: left, top, right between two places of the world.
    scene::Scene loop = scene_of({bar("left", 0.2, Vector3::Zero(), Vector3(0, 0, M_PI / 2)), bar("top", 0.4, Vector3(0, 0.2, 0)),
                                  bar("right", 0.2, Vector3(0.4, 0, 0), Vector3(0, 0, M_PI / 2))},
                                 0.01);
    loop.mechanism.joints = {
        tests::mechanisms::joint("A", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"left", Vector3::Zero(), z_axis}),
        tests::mechanisms::joint("B", JointKind::revolute, {"left", Vector3(0.2, 0, 0), z_axis}, {"top", Vector3::Zero(), z_axis}),
        tests::mechanisms::joint("C", JointKind::revolute, {"top", Vector3(0.4, 0, 0), z_axis}, {"right", Vector3(0.2, 0, 0), z_axis}),
        tests::mechanisms::joint("D", JointKind::revolute, {"", Vector3(0.4, 0, 0), z_axis}, {"right", Vector3::Zero(), z_axis})};
    const std::string said = refusal(loop);
    CAPTURE(said);
    CHECK(contains(said, "closes a loop"));
    for (const char* name : {"`A`", "`B`", "`C`", "`D`"}) CHECK(contains(said, name));
}

TEST_CASE("joint ranges: bodies on no joint, and what hangs on nothing, are held and named", "[ranges]") {
    scene::Scene scene = scene_of({bar("alone", 0.2), bar("one", 0.2, Vector3(0, 1, 0)), bar("two", 0.2, Vector3(0, 1, 0))}, 0.01);
    scene.mechanism.joints = {
        tests::mechanisms::joint("A", JointKind::revolute, {"one", Vector3::Zero(), z_axis}, {"two", Vector3::Zero(), z_axis})};
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model);
    REQUIRE(ranges);
    CHECK(ranges->held == std::vector<std::string>{"alone", "one"});
    CHECK(ranges->linkage.bodies[2].parent == 1);
}

}  // namespace fettle::core::clearance::joint_ranges_test
