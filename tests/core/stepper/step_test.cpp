// SPDX-License-Identifier: MIT
// One step: where it ends, its path, how the barrier's stiffness goes on, and what is left after a failure.
#include "core/stepper/step.hpp"

#include <catch2/catch.hpp>

#include "core/ccd/safe_step.hpp"
#include "tests/core/stepper/physics_models.hpp"

namespace fettle::core::stepper::step_test {

using namespace fettle::tests::support;
using fettle::tests::physics::weightless;
using fettle::tests::physics::world;

namespace {

geometry::Mesh cube() { return box_mesh(Vector3::Constant(-0.1), Vector3::Constant(0.1)); }

StepResult one_step(const model::Model& model, const StepState& state, const SimulationOptions& options = {}) {
    solver::NewtonWorkspace workspace(model);
    return step(model, state, workspace, options);
}

// A cube `gap` above the ground, falling at `speed`.
model::Model falling(double gap, double speed) {
    model::Body body = make_body("cube", cube(), make_pose(Vector3::Zero(), {0.03, 0.02, 0.1 + gap}));
    set_velocity(body, {0, 0, -speed}, Vector3::Zero());
    model::Model model = world({body, ground_plate()}, 0.01);
    model.adaptive_kappa = true;
    return model;
}

}  // namespace

TEST_CASE("a free step ends where implicit Euler says, on a straight path", "[step]") {
    model::Model model = world({make_body("cube", cube(), make_pose(Vector3::Zero(), {0, 0, 3}))}, 0.01);
    set_velocity(model.bodies[0], {1, 0, 0}, Vector3::Zero());
    const StepState start = start_state(model);
    const StepResult result = one_step(model, start);
    REQUIRE(result.status == SimulationStatus::ok);
    CHECK(result.state.time == 0.01);
    const Vector3 moved(0.01, 0, -tests::physics::gravity * 1e-4);
    CHECK((result.state.history.poses[0].position - Vector3(0, 0, 3) - moved).norm() < 1e-12);
    CHECK((result.state.history.velocities[0].col(3) - moved / 0.01).norm() < 1e-10);
    REQUIRE(result.path.nodes.size() == 2);
    CHECK(result.path.nodes.front()[0].position == start.history.poses[0].position);
    CHECK(result.path.nodes.back()[0].position == result.state.history.poses[0].position);
    CHECK(result.report.contacts == 0);
    CHECK(result.report.shift == 0);
}

TEST_CASE("rotations stay rotations", "[step]") {
    model::Model model = weightless({make_body("cube", cube(), make_pose({1, 2, 3}, Vector3::Zero()))}, 0.01);
    set_velocity(model.bodies[0], Vector3::Zero(), {3, -20, 5});
    StepState state = start_state(model);
    for (int t = 0; t < 20; ++t) {
        const StepResult result = one_step(model, state);
        REQUIRE(result.status == SimulationStatus::ok);
        state = result.state;
        const Matrix3 R = state.history.poses[0].rotation;
        CHECK((R.transpose() * R - Matrix3::Identity()).norm() < 1e-14);
    }
}

TEST_CASE("the stored path is clear, however fast the impact", "[step]") {
    const model::Model model = falling(0.05, 20);  // 20 cm in a step
    const StepState start = start_state(model);
    const StepResult result = one_step(model, start);
    INFO(result.message);
    REQUIRE(result.status == SimulationStatus::ok);
    for (std::size_t k = 0; k + 1 < result.path.nodes.size(); ++k) {
        std::vector<kinematics::PathSegment> segments;
        for (std::size_t i = 0; i < model.bodies.size(); ++i)
            segments.push_back(path_between(start.history.poses[i].rotation, result.path.nodes[k][i], result.path.nodes[k + 1][i]));
        ccd::Candidates candidates;
        ccd::cover(model, segments, model.dhat, candidates);
        CHECK(ccd::is_path_clear(model, candidates, segments));
    }
    CHECK(result.state.history.poses[0].position.z() > 0.1);
}

TEST_CASE("the barrier's stiffness starts at ten times the model's and follows the gap", "[step]") {
    const model::Model model = falling(5e-4, 0);
    StepState state = start_state(model);
    CHECK(state.kappa == 10 * model.kappa);
    SECTION("well apart: half as much, but no less than at the start") {
        state.kappa = 100 * model.kappa;
        CHECK(one_step(model, state).state.kappa == 50 * model.kappa);
        state.kappa = 12 * model.kappa;
        CHECK(one_step(model, state).state.kappa == 10 * model.kappa);
    }
    SECTION("far inside the activation distance: four times as much") {
        const model::Model hard = falling(1e-6, 0);
        model::Model heavy = hard;
        heavy.bodies[0].force = {0, 0, -1e7};  // kappa is not chosen for this
        const StepResult result = one_step(heavy, start_state(heavy));
        INFO(result.message);
        REQUIRE(result.status == SimulationStatus::ok);
        REQUIRE(result.report.minimum_distance < 1e-2 * heavy.dhat);
        CHECK(result.state.kappa == 40 * heavy.kappa);
        heavy.velocity_tolerance = 1e-2;
        StepState most = start_state(heavy);
        most.kappa = 9e3 * heavy.kappa;
        heavy.bodies[0].force *= 100;
        const StepResult capped = one_step(heavy, most);
        INFO(capped.message);
        REQUIRE(capped.status == SimulationStatus::ok);
        REQUIRE(capped.report.minimum_distance < 1e-2 * heavy.dhat);
        CHECK(capped.state.kappa == 1e4 * heavy.kappa);
    }
    SECTION("given by the scene, or for a gradient: never") {
        model::Model fixed = model;
        fixed.adaptive_kappa = false;
        CHECK(start_state(fixed).kappa == fixed.kappa);
        CHECK(one_step(fixed, start_state(fixed)).state.kappa == fixed.kappa);
        SimulationOptions exact;
        exact.for_gradient = true;
        const StepResult result = one_step(model, state, exact);
        REQUIRE(result.status == SimulationStatus::ok);
        CHECK(result.state.kappa == model.kappa);
        CHECK(result.report.residual <= 1e-8);
    }
}

TEST_CASE("a step that fails leaves the state as it was", "[step]") {
    model::Model model = falling(5e-4, 1);
    const StepState start = start_state(model);
    const auto unchanged = [&](const StepResult& result) {
        CHECK_FALSE(result.message.empty());
        CHECK(result.state.time == start.time);
        CHECK(result.state.kappa == start.kappa);
        CHECK(result.state.history.poses[0].position == start.history.poses[0].position);
        CHECK(result.path.nodes.empty());
    };
    SimulationOptions stopped;
    stopped.should_stop = [] { return true; };
    const StepResult interrupted = one_step(model, start, stopped);
    CHECK(interrupted.status == SimulationStatus::interrupted);
    unchanged(interrupted);
    model.max_newton_iterations = 0;
    const StepResult limited = one_step(model, start);
    CHECK(limited.status == SimulationStatus::not_converged);
    unchanged(limited);
}

TEST_CASE("outputs are there when they are asked for", "[step]") {
    const model::Model model = falling(5e-4, 0);
    SimulationOptions options;
    CHECK(one_step(model, start_state(model), options).outputs.contacts.empty());
    options.outputs = true;
    const StepResult result = one_step(model, start_state(model), options);
    REQUIRE(result.outputs.contacts.size() == 1);
    CHECK(result.outputs.time == 0.01);
    CHECK(result.outputs.kappa == start_state(model).kappa);
    CHECK(result.outputs.contact_energy > 0);
    CHECK(result.outputs.contacts[0].distance == Approx(result.report.minimum_distance));
    CHECK(result.outputs.contacts[0].contacts == result.report.contacts);
}

}  // namespace fettle::core::stepper::step_test
