// SPDX-License-Identifier: MIT
#include "core/stepper/scripted_motion.hpp"

#include <catch2/catch.hpp>

#include "core/stepper/simulate.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::stepper::scripted_motion_test {

namespace {

model::Model two_movers() {
    model::Model model;
    model.timestep = 0.1;
    model.end_time = 1;
    const auto cube = tests::support::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    for (const double x : {0.0, 10.0}) {
        model.bodies.push_back(tests::support::make_body(x > 0 ? "slide" : "wheel", cube, tests::support::make_pose({0, 0, 0}, {x, 0, 0}),
                                                         scene::BodyType::kinematic_body));
    }
    tests::support::prescribe(model.bodies[0], 5, 2);
    tests::support::prescribe(model.bodies[1], 0, -3);
    model.bodies[1].prescribed[0]->stop_time = 0.5;
    return model;
}

}  // namespace

TEST_CASE("Scripted bodies follow their scripts, the rest stays", "[stepper][scripted]") {
    model::Model model = two_movers();
    model.bodies.push_back(tests::support::make_body("loose", model.bodies[0].mesh, tests::support::make_pose({0, 0, 0}, {0, 5, 0})));
    model.bodies[2].velocity_start.col(3) = Vector3(1, 1, 1);
    tests::support::prescribe(model.bodies[2], 2, 1);
    const Trajectory path = follow_scripts(model);
    REQUIRE(path.steps.size() == 10);
    CHECK((path.poses.back()[0].rotation - kinematics::rotation({0, 0, 2})).norm() < 1e-14);
    CHECK((path.poses.back()[1].position - Vector3(10 - 1.5, 0, 0)).norm() < 1e-14);
    CHECK((path.poses.back()[2].position - Vector3(0, 5, 1)).norm() < 1e-14);  // the scripted coordinate moves, the free ones do not
    CHECK(held_bodies(model) == std::vector<std::string>{"loose"});
    CHECK(is_scripted(model.bodies[0]));
    CHECK(follow_scripts(model, 3).steps.size() == 3);
}

TEST_CASE("Where every body is scripted the path is that of a simulation", "[stepper][scripted]") {
    const model::Model model = two_movers();
    const Trajectory path = follow_scripts(model), simulated = simulate(model).trajectory;
    REQUIRE(simulated.steps.size() == path.steps.size());
    for (std::size_t t = 0; t < path.poses.size(); ++t) {
        for (std::size_t b = 0; b < 2; ++b) {
            CHECK((path.poses[t][b].rotation == simulated.poses[t][b].rotation));
            CHECK((path.poses[t][b].position == simulated.poses[t][b].position));
        }
    }
    for (std::size_t t = 0; t < path.steps.size(); ++t) {
        REQUIRE(simulated.steps[t].nodes.size() == 2);
        CHECK((simulated.steps[t].nodes[1][0].rotation_vector == path.steps[t].nodes[1][0].rotation_vector));
    }
}

}  // namespace fettle::core::stepper::scripted_motion_test
