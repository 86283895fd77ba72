// SPDX-License-Identifier: MIT
// Motion that a time step cannot see at its ends: scripts and tables with several entries in one step, followed as they are, without
// dynamics and with, and judged as they are.
#include "core/stepper/prescribed_path.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/clearance/clearance.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/intersection_oracle.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::stepper::prescribed_path_test {

namespace {

using namespace tests::support;
using scene::BodyType;

model::Model model_of(std::vector<model::Body> bodies) {
    model::Model model;
    model.bodies = std::move(bodies);
    model.timestep = 0.1;
    model.end_time = 0.1;
    model.dhat = 1e-3;
    model.diagonal = 4;
    model.gravity = Vector3::Zero();
    model.velocity_tolerance = 1e-4;
    model.kappa = model::choose_kappa(model);
    return model;
}

geometry::Mesh cube(double a) { return box_mesh(Vector3::Constant(-a / 2), Vector3::Constant(a / 2)); }

// A wand of 1 m along x that turns once about z within one step, by quarters.
model::Body whole_turn() {
    model::Body body =
        make_body("wand", box_mesh({0, -0.01, -0.01}, {1, 0.01, 0.01}), make_pose({0, 0, 0}, {0, 0, 0}), BodyType::kinematic_body);
    for (int k = 1; k <= 4; ++k) {
        body.script.times.push_back(0.025 * k);
        body.script.poses.push_back(make_pose({0, 0, k * M_PI / 2}, {0, 0, 0}));
    }
    return body;
}

// A cube that goes from (0, 0) over (1, 0) to (1, 1): the corner after a quarter of the step.
model::Body corner() {
    model::Body body = make_body("cube", cube(0.2), make_pose({0, 0, 0}, {0, 0, 0}), BodyType::kinematic_body);
    body.script.times = {0.025, 0.1};
    body.script.poses = {make_pose({0, 0, 0}, {1, 0, 0}), make_pose({0, 0, 0}, {1, 1, 0})};
    return body;
}

model::Body post(double x, double y, BodyType type = BodyType::static_body) {
    return make_body("post", cube(0.1), make_pose({0, 0, 0}, {x, y, 0}), type, 10);
}

clearance::PairClearance judged(const model::Model& model, const Trajectory& trajectory) {
    clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-5;
    return clearance::certify(model, trajectory, {{0, 1, 1e-4}}, options).front();
}

}  // namespace

TEST_CASE("A whole turn within one step is a motion, and meets what stands in its way", "[stepper][prescribed]") {
    const model::Model hit = model_of({whole_turn(), post(-0.8, 0)});
    const Trajectory path = follow_scripts(hit);
    REQUIRE(path.steps.size() == 1);
    CHECK(path.steps[0].nodes.size() == 5);
    CHECK((path.steps[0].nodes.back()[0].rotation_vector - Vector3(0, 0, 2 * M_PI)).norm() < 1e-12);
    CHECK(judged(hit, path).status == clearance::PairStatus::violated);

    const model::Model free = model_of({whole_turn(), post(-1.5, 0)});
    const clearance::PairClearance clear = judged(free, follow_scripts(free));
    CHECK(clear.status == clearance::PairStatus::clear);
    CHECK(clear.lower > 0.449);
    CHECK(clear.upper < 0.4501);
    CHECK(clear.witness.time == Approx(0.05).margin(0.001));
}

TEST_CASE("An L-shaped script goes over its corner, at the time that it says", "[stepper][prescribed]") {
    const model::Model hit = model_of({corner(), post(1, 0.4)});
    CHECK(judged(hit, follow_scripts(hit)).status == clearance::PairStatus::violated);
    const model::Model beside = model_of({corner(), post(1.3, 0)});  // 0.15 m beyond the corner
    const clearance::PairClearance near = judged(beside, follow_scripts(beside));
    CHECK(near.status == clearance::PairStatus::clear);
    CHECK(near.upper == Approx(0.15).margin(2e-5));
    CHECK(near.witness.time >= 0.025 - 1e-9);
    CHECK(near.witness.time <= 0.025 + 0.15 * 0.075 + 1e-9);
    const model::Model inside = model_of({corner(), post(0.5, 0.5)});  // on the straight way that the script does not take
    CHECK(judged(inside, follow_scripts(inside)).lower > 0.3);
}

TEST_CASE("A motor's table and its stop are followed inside a step", "[stepper][prescribed]") {
    model::Body slide = make_body("slide", cube(0.2), make_pose({0, 0, 0}, {0, 0, 0}), BodyType::kinematic_body);
    slide.prescribed[0]->times = {0, 0.02, 0.04};
    slide.prescribed[0]->values = {0, 1, 0};
    const model::Model model = model_of({slide, post(1, 0)});
    const Trajectory path = follow_scripts(model);
    REQUIRE(path.steps[0].nodes.size() == 4);
    CHECK((path.steps[0].fractions == std::vector<double>{0, 0.02 / 0.1, 0.04 / 0.1, 1}));
    CHECK(path.steps[0].nodes[1][0].position.x() == 1);
    CHECK(path.poses[1][0].position.x() == 0);
    CHECK(judged(model, path).status == clearance::PairStatus::violated);

    model::Body spin = make_body("spin", cube(0.2), make_pose({0, 0, 0}, {0, 0, 0}), BodyType::kinematic_body);
    prescribe(spin, 5, 10);
    spin.prescribed[5]->stop_time = 0.07;
    const Trajectory stopped = follow_scripts(model_of({spin, post(1, 0)}));
    REQUIRE(stopped.steps[0].nodes.size() == 3);
    CHECK(stopped.steps[0].nodes[1][0].rotation_vector.z() == Approx(0.7));
    CHECK(stopped.steps[0].nodes[2][0].rotation_vector.z() == Approx(0.7));
}

TEST_CASE("Stretches that turn about several axes are followed, and end where the script says", "[stepper][prescribed]") {
    model::Body body = whole_turn();
    body.script.poses[1] = make_pose({M_PI / 2, 0, 0}, {0, 0, 0.5});
    body.script.poses[2] = make_pose({0, 2, 1}, {1, 0, 0});
    body.script.poses[3] = make_pose({0, 0.3, -3}, {1, 1, 0});
    const model::Model model = model_of({body});
    const std::vector<kinematics::Pose> start{body.pose_start};
    const auto way = prescribed_path(model, start, 0);
    REQUIRE(way.back().fraction == 1);
    double before = 0;
    for (const PrescribedNode& node : way) {
        REQUIRE(node.fraction > before);
        before = node.fraction;
        const kinematics::Pose wanted = model::scripted_pose(model.bodies[0], node.fraction * model.timestep);
        CHECK((node.targets[0].head<3>() - wanted.position).norm() < 1e-12);
        CHECK((kinematics::rotation(node.targets[0].tail<3>()) - wanted.rotation).cwiseAbs().maxCoeff() < 1e-11);
    }
}

TEST_CASE("Where no entry lies inside a step its path is straight, as it always was", "[stepper][prescribed]") {
    model::Model model = model_of({whole_turn(), post(1.5, 0)});
    model.timestep = 0.025;
    const Trajectory path = follow_scripts(model);
    REQUIRE(path.steps.size() == 4);
    for (const TrajectoryStep& step : path.steps) {
        CHECK(step.nodes.size() == 2);
        CHECK(step.fractions.empty());
    }
}

TEST_CASE("A simulation drives scripts through their entries and pushes what is there", "[stepper][prescribed]") {
    for (const auto& place : {Vector3(1, 0.4, 0), Vector3(0.5, 0.5, 0), Vector3(0.6, 0, 0)}) {
        const model::Model model = model_of({corner(), post(place.x(), place.y(), BodyType::dynamic_body)});
        const Simulation run = simulate(model);
        INFO(run.report.message);
        REQUIRE(run.report.status == SimulationStatus::ok);
        const TrajectoryStep& step = run.trajectory.steps[0];
        REQUIRE(step.fractions.size() == step.nodes.size());
        CHECK(step.fractions.front() == 0);
        CHECK(step.fractions.back() == 1);
        const auto corner_node = std::find(step.fractions.begin(), step.fractions.end(), 0.025 / 0.1) - step.fractions.begin();
        REQUIRE(corner_node < static_cast<std::ptrdiff_t>(step.nodes.size()));
        CHECK((step.nodes[corner_node][0].position - Vector3(1, 0, 0)).norm() < 1e-8);
        CHECK((run.trajectory.poses[1][0].position - Vector3(1, 1, 0)).norm() < 1e-8);
        // Only a body that stands on the way moves; one that is no longer pushed at the end goes where an implicit step has it, back.
        double moved = 0;
        for (const auto& node : step.nodes) moved = std::max(moved, (node[1].position - place).norm());
        CHECK((place.y() == 0.5 ? moved < 1e-9 : moved > 0.3));
        IntersectionReport report;
        IntersectionOracle(model).look_at_step(run.trajectory, 0, 10, 4, report);
        CHECK(report.intersections.empty());
    }
}

TEST_CASE("A dynamic body's motor goes through its table, and blocked it says so", "[stepper][prescribed]") {
    model::Body slide = make_body("slide", cube(0.2), make_pose({0, 0, 0}, {0, 0, 0}));
    for (int k = 1; k < 6; ++k) prescribe(slide, k);
    prescribe(slide, 0);
    slide.prescribed[0]->times = {0, 0.02, 0.04};
    slide.prescribed[0]->values = {0, 1, 0};
    slide.prescribed[4].reset();  // one degree of freedom is left
    const Simulation pushed = simulate(model_of({slide, post(0.8, 0, BodyType::dynamic_body)}));
    REQUIRE(pushed.report.status == SimulationStatus::ok);
    CHECK(pushed.trajectory.poses[1][1].position.x() == Approx(0.8).margin(1e-3));  // pushed on the way, and back
    CHECK(pushed.trajectory.poses[1][0].position.x() == Approx(0).margin(1e-8));
    const Simulation blocked = simulate(model_of({slide, post(0.8, 0)}));
    CHECK(blocked.report.status == SimulationStatus::blocked);
    CHECK(blocked.trajectory.steps.empty());
}

}  // namespace fettle::core::stepper::prescribed_path_test
