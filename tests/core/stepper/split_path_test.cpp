// SPDX-License-Identifier: MIT
// Nodes between which joints hold: measured gaps, ends that stay, what cannot be done.
#include "core/stepper/split_path.hpp"

#include "tests/support/mechanisms.hpp"

namespace fettle::core::stepper::split_path_test {

using namespace fettle::tests::mechanisms;
using core::scene::JointKind;
using fettle::tests::support::contains;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

// Two bars hinged to one another and to the world, falling; or the first one driven.
model::Model double_pendulum(bool driven) {
    scene::Scene scene = scene_of({bar("upper", 0.2), bar("lower", 0.3, Vector3(0.2, 0, 0))}, 0.02);
    scene.gravity = Vector3(0, -gravity, 0);
    scene.mechanism.joints = {joint("A", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"upper", Vector3::Zero(), z_axis}),
                              joint("B", JointKind::revolute, {"upper", Vector3(0.2, 0, 0), z_axis}, {"lower", Vector3::Zero(), z_axis})};
    if (driven) scene.mechanism.motors = {motor("drive", "A", at_rate(12))};
    return built(scene);
}

// The largest distance of B's two points, between nodes too.
double sampled_gap(const model::Model& model, const Trajectory& trajectory) {
    double worst = 0;
    for (int t = 0; t < count_of(trajectory.steps); ++t)
        for (int k = 0; k < segment_count(trajectory, t); ++k)
            for (double s = 0; s <= 1; s += 0.125) {
                const kinematics::Pose a = pose_at(trajectory, t, k, s, 0), b = pose_at(trajectory, t, k, s, 1);
                const Vector3 on_a = world_position(a, Vector3(0.2, 0, 0) - model.bodies[0].reference_point);
                worst = std::max(worst, (on_a - world_position(b, -model.bodies[1].reference_point)).norm());
            }
    return worst;
}

}  // namespace

TEST_CASE("split path: joints hold between nodes as well as is asked for, and steps end where they did", "[mechanism]") {
    for (const bool driven : {false, true}) {
        const model::Model model = double_pendulum(driven);
        const Simulation simulation = run(model, 30);
        Trajectory split = simulation.trajectory;
        const PathGap before = largest_path_gap(model, split);
        REQUIRE(before.joint >= 0);
        CHECK(before.gap > 1e-4);
        CHECK(sampled_gap(model, split) <= before.gap);
        const SplitPath done = split_at_joints(model, 1e-6, split);
        CHECK(done.refusal.empty());
        CHECK(done.added > 30);
        CHECK(done.left.gap <= 1e-6);
        CHECK(sampled_gap(model, split) <= 1e-6);
        for (std::size_t t = 0; t < split.steps.size(); ++t) {
            const auto &now = split.steps[t], &then = simulation.trajectory.steps[t];
            REQUIRE(now.nodes.size() == now.fractions.size());
            CHECK(now.fractions.back() == 1);
            for (std::size_t i = 0; i < 2; ++i) {
                CHECK(now.nodes.back()[i].position == then.nodes.back()[i].position);
                CHECK(now.nodes.back()[i].rotation_vector == then.nodes.back()[i].rotation_vector);
            }
        }
    }
}

TEST_CASE("split path: a path that holds stays as it is", "[mechanism]") {
    const model::Model model = double_pendulum(false);
    const Simulation simulation = run(model, 5);
    Trajectory split = simulation.trajectory;
    const SplitPath done = split_at_joints(model, 1, split);
    CHECK(done.added == 0);
    CHECK(split.steps[0].nodes.size() == simulation.trajectory.steps[0].nodes.size());
    CHECK(split.steps[0].fractions == simulation.trajectory.steps[0].fractions);
}

TEST_CASE("split path: what cannot be brought below is told with joint and step", "[mechanism]") {
    const model::Model model = double_pendulum(true);
    Trajectory split = run(model, 3).trajectory;
    const SplitPath done = split_at_joints(model, 1e-13, split);
    CHECK(contains(done.refusal, "joint '"));
    CHECK(contains(done.refusal, "step 1"));
    CHECK(done.left.gap < 5e-9);  // 1024 parts: (12 x 0.02 / 1024)^2 x 0.5 / 8 = 3.4e-9
}

}  // namespace fettle::core::stepper::split_path_test
