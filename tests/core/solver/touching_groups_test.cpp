// SPDX-License-Identifier: MIT
#include "core/solver/touching_groups.hpp"

#include <catch2/catch.hpp>

#include "core/model/choose_kappa.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::solver::touching_groups_test {

using namespace fettle::tests::support;

TEST_CASE("bodies are joined by contacts and friction, not by what cannot move", "[touching_groups]") {
    model::Model model;
    const auto mesh = box_mesh(Vector3::Zero(), Vector3::Ones());
    for (int i = 0; i < 6; ++i)
        model.bodies.push_back(make_body("b", mesh, {}, i == 2 ? scene::BodyType::static_body : scene::BodyType::dynamic_body));
    contact::ContactSet contacts;
    contacts.pairs = {{0, 2, {}}, {1, 2, {}}, {5, 3, {}}};
    contact::FrictionSet friction;
    CHECK(touching_groups(model, contacts, friction) == std::vector<int>{0, 1, 2, 3, 4, 3});
    friction.pairs = {{4, 5, 0.1, {}}, {1, 0, 0.1, {}}};
    CHECK(touching_groups(model, contacts, friction) == std::vector<int>{0, 0, 2, 3, 3, 3});
}

TEST_CASE("a body in free flight costs one iteration a step, whatever rests beside it", "[touching_groups][physics]") {
    const auto box = box_mesh(Vector3::Constant(-0.05), Vector3::Constant(0.05));
    model::Model model;
    model.bodies = {make_body("floor", box_mesh(Vector3(-1, -1, -0.1), Vector3(1, 1, 0)), {}, scene::BodyType::static_body),
                    make_body("resting", box, make_pose(Vector3::Zero(), Vector3(0, 0, 0.0509))),
                    make_body("thrown", box, make_pose(Vector3::Zero(), Vector3(0.5, 0.3, 0.3)))};
    const Vector3 velocity(0.3, -0.2, 3);
    set_velocity(model.bodies[2], velocity, Vector3::Zero());
    model.gravity = Vector3(0, 0, -9.81);
    model.dhat = 1e-3;
    model.diagonal = 0.2;
    model.velocity_tolerance = 1e-4;
    model.friction.mu.setConstant(0.3);
    model.kappa = model::choose_kappa(model);
    stepper::SimulationOptions options;
    options.steps = 40;
    const stepper::Simulation run = simulate(model, options);
    REQUIRE(run.report.status == stepper::SimulationStatus::ok);
    int iterations = 0;  // after the first steps, in which the one that rests finds its place
    for (std::size_t k = 10; k < run.report.steps.size(); ++k) iterations += run.report.steps[k].newton_iterations;
    CHECK(iterations <= 33);
    // Implicit Euler's own parabola: x_n = x_0 + n h v + h^2 g n (n + 1) / 2.
    const double h = model.timestep, n = 40;
    const Vector3 expected = Vector3(0.5, 0.3, 0.3) + n * h * velocity + h * h * n * (n + 1) / 2 * model.gravity;
    CHECK((run.trajectory.poses.back()[2].position - expected).norm() <= 1e-12);
}

}  // namespace fettle::core::solver::touching_groups_test
