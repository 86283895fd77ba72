// SPDX-License-Identifier: MIT
// Whole simulations with an answer known in closed form, and what a run must report when it cannot go on.
#include "core/stepper/simulate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/setup/build_model.hpp"
#include "tests/support/intersection_oracle.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::stepper::simulate_test {

using namespace fettle::tests::support;

namespace {

const double pi = std::acos(-1.0);

model::Model model_of(std::vector<model::Body> bodies, double h = 0.01) {
    model::Model model;
    model.bodies = std::move(bodies);
    model.gravity = Vector3(0, 0, -9.81);
    model.timestep = h;
    model.dhat = 1e-3;
    model.diagonal = 1;
    model.velocity_tolerance = 1e-5;
    model.kappa = model::choose_kappa(model);
    return model;
}

SimulationOptions steps(int n, bool for_gradient = false) {
    SimulationOptions options;
    options.steps = n;
    options.for_gradient = for_gradient;
    return options;
}

geometry::Mesh cube(double a) { return box_mesh(Vector3::Constant(-a / 2), Vector3::Constant(a / 2)); }

}  // namespace

TEST_CASE("free fall follows the implicit Euler sum exactly", "[simulate]") {
    model::Body body = make_body("cube", cube(0.1), make_pose(Vector3(0.3, 0.2, 0.1), Vector3(1, 2, 3)));
    set_velocity(body, Vector3(0.5, 0, 2), Vector3::Zero());
    const model::Model model = model_of({body});
    const Simulation run = simulate(model, steps(100));
    REQUIRE(run.report.status == SimulationStatus::ok);
    const double h = model.timestep, n = 100, t = n * h;
    // x_n = x_0 + n h v_0 + h^2 a n (n + 1) / 2
    const Vector3 expected = Vector3(1, 2, 3) + t * Vector3(0.5, 0, 2) + 0.5 * h * h * n * (n + 1) * model.gravity;
    CHECK((run.trajectory.poses[100][0].position - expected).norm() < 1e-12);
    CHECK((run.trajectory.poses[100][0].rotation - body.pose_start.rotation).norm() < 1e-12);
}

TEST_CASE("the error of free fall is first order in the time step", "[simulate]") {
    std::vector<double> errors;
    for (double h : {0.02, 0.01, 0.005}) {
        const model::Model model = model_of({make_body("cube", cube(0.1), make_pose(Vector3::Zero(), Vector3::Zero()))}, h);
        const int n = static_cast<int>(std::lround(0.4 / h));
        errors.push_back(std::abs(simulate(model, steps(n)).trajectory.poses[n][0].position.z() + 0.5 * 9.81 * 0.16));
    }
    CHECK(std::log2(errors[0] / errors[1]) == Approx(1).margin(1e-6));
    CHECK(std::log2(errors[1] / errors[2]) == Approx(1).margin(1e-6));
}

TEST_CASE("a cube comes to rest on the ground within the activation distance", "[simulate]") {
    const model::Model model =
        model_of({make_body("cube", cube(0.2), make_pose(Vector3::Zero(), Vector3(0.01, 0.02, 0.15))), ground_plate()});
    const Simulation run = simulate(model, steps(100, true));
    REQUIRE(run.report.status == SimulationStatus::ok);
    const Vector3 end = run.trajectory.poses.back()[0].position, before = run.trajectory.poses[99][0].position;
    CHECK(end.z() - 0.1 > 0);
    CHECK(end.z() - 0.1 < model.dhat);
    CHECK((end - before).norm() < 1e-6);
    CHECK(find_intersections(model, run.trajectory, 4).intersections.empty());
    // The contact carries the weight: kappa b'(d) summed balances m g, which is what a vanishing residual says.
    CHECK(run.report.steps.back().residual < 1e-9);
}

TEST_CASE("momentum is exact under contact without gravity", "[simulate]") {
    model::Body a = make_body("a", cube(0.2), make_pose(Vector3(0.1, 0.2, 0.3), Vector3(0, 0, 0)));
    model::Body b =
        make_body("b", cube(0.2), make_pose(Vector3(-0.3, 0.1, 0.2), Vector3(0.5, 0.03, -0.02)), scene::BodyType::dynamic_body, 2000);
    set_velocity(a, Vector3(2, 0, 0), Vector3::Zero());
    model::Model model = model_of({a, b});
    model.gravity.setZero();
    model.kappa = 1e6;
    const Simulation run = simulate(model, steps(60, true));
    REQUIRE(run.report.status == SimulationStatus::ok);
    int with_contact = 0;
    for (const StepReport& r : run.report.steps) with_contact += r.contacts > 0;
    REQUIRE(with_contact > 0);
    const auto momentum = [&](std::size_t t) {
        Vector3 p = Vector3::Zero();
        for (int i = 0; i < 2; ++i)
            p += model.bodies[i].moments(3, 3) * (run.trajectory.poses[t][i].position - run.trajectory.poses[t - 1][i].position) /
                 model.timestep;
        return p;
    };
    for (std::size_t t = 1; t <= 60; ++t) CHECK((momentum(t) - Vector3(2 * a.moments(3, 3), 0, 0)).norm() < 1e-9 * a.moments(3, 3));
}

TEST_CASE("a motor turns its body by its script and leaves the other coordinates free", "[simulate]") {
    model::Body rotor = make_body("rotor", cube(0.1), make_pose(Vector3::Zero(), Vector3(0, 0, 1)));
    prescribe(rotor, 5, 2 * pi);
    const model::Model model = model_of({rotor});
    const Simulation run = simulate(model, steps(100));
    REQUIRE(run.report.status == SimulationStatus::ok);
    // One revolution in a second, falling meanwhile.
    CHECK((run.trajectory.poses[100][0].rotation - Matrix3::Identity()).norm() < 1e-10);
    CHECK((run.trajectory.poses[25][0].rotation - kinematics::rotation(Vector3(0, 0, pi / 2))).norm() < 1e-10);
    CHECK(run.trajectory.poses[100][0].position.z() < -3.5);
}

TEST_CASE("a fixed degree of freedom does not move", "[simulate]") {
    model::Body body = make_body("cube", cube(0.1), make_pose(Vector3(0.2, 0, 0), Vector3(0, 0, 1)));
    prescribe(body, 0);
    prescribe(body, 4);
    set_velocity(body, Vector3(0, 1, 0), Vector3(1, 0, 0));
    const Simulation run = simulate(model_of({body}), steps(20));
    REQUIRE(run.report.status == SimulationStatus::ok);
    CHECK(run.trajectory.poses[20][0].position.x() == 0);
    CHECK(run.trajectory.poses[20][0].position.y() == Approx(0.2).epsilon(1e-9));
}

TEST_CASE("a kinematic body pushes a free one along", "[simulate]") {
    model::Body pusher = make_body("pusher", cube(0.2), make_pose(Vector3::Zero(), Vector3(0, 0, 0.1002)), scene::BodyType::kinematic_body);
    prescribe(pusher, 0, 0.5);
    const model::Body block = make_body("block", cube(0.2), make_pose(Vector3::Zero(), Vector3(0.25, 0, 0.1002)));
    const model::Model model = model_of({pusher, block, ground_plate()});
    const Simulation run = simulate(model, steps(60));
    INFO(run.report.message);
    REQUIRE(run.report.status == SimulationStatus::ok);
    CHECK(run.trajectory.poses[60][0].position.x() == Approx(0.3).epsilon(1e-12));
    CHECK(run.trajectory.poses[60][1].position.x() > 0.5);
    CHECK(find_intersections(model, run.trajectory, 8).intersections.empty());
}

TEST_CASE("a blocked motor ends in an error that names the bodies", "[simulate]") {
    model::Body pusher = make_body("pusher", cube(0.2), make_pose(Vector3::Zero(), Vector3(0, 0, 0.2)), scene::BodyType::kinematic_body);
    prescribe(pusher, 0, 1.0);
    const model::Body block = make_body("block", cube(0.2), make_pose(Vector3::Zero(), Vector3(0.25, 0, 0.2)));
    const model::Body wall = make_body("wall", cube(0.4), make_pose(Vector3::Zero(), Vector3(0.6, 0, 0.2)), scene::BodyType::static_body);
    model::Model model = model_of({pusher, block, wall});
    model.gravity.setZero();
    const Simulation run = simulate(model, steps(40));
    INFO(run.report.message);
    CHECK(run.report.status == SimulationStatus::blocked);
    CHECK(run.report.message.find("'pusher'") != std::string::npos);
    CHECK(run.report.message.find("'block'") != std::string::npos);
    // It got as far as there was room, and what was simulated is usable.
    CHECK(run.trajectory.steps.size() >= 9);
    CHECK(find_intersections(model, run.trajectory, 8).intersections.empty());
}

TEST_CASE("two runs agree bit for bit, and candidates kept between steps change nothing", "[simulate]") {
    const model::Model model =
        model_of({make_body("a", cube(0.2), make_pose(Vector3(0.2, 0.1, 0), Vector3(0, 0, 0.2))),
                  make_body("b", cube(0.2), make_pose(Vector3(0, 0.3, 0.1), Vector3(0.03, 0, 0.5))), ground_plate()});
    const Simulation first = simulate(model, steps(60)), second = simulate(model, steps(60));
    REQUIRE(first.report.status == SimulationStatus::ok);
    for (std::size_t t = 0; t < first.trajectory.poses.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(first.trajectory.poses[t][i].position == second.trajectory.poses[t][i].position);
            CHECK(first.trajectory.poses[t][i].rotation == second.trajectory.poses[t][i].rotation);
        }
}

TEST_CASE("a run can be interrupted and what was reached is usable", "[simulate]") {
    const model::Model model = model_of({make_body("cube", cube(0.1), make_pose(Vector3::Zero(), Vector3(0, 0, 1))), ground_plate()});
    SimulationOptions options = steps(50);
    int done = 0;
    options.on_step = [&](const Progress& p) { done = p.step; };
    options.should_stop = [&] { return done == 7; };
    const Simulation run = simulate(model, options);
    CHECK(run.report.status == SimulationStatus::interrupted);
    CHECK(run.trajectory.steps.size() == 7);
    CHECK(run.trajectory.poses.size() == 8);
}

}  // namespace fettle::core::stepper::simulate_test
