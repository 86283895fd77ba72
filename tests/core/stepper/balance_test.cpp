// SPDX-License-Identifier: MIT
// What the balance of a simulation tells: nothing where all is kept, what forces did where they did it, an error where there is one.
#include "fettle/core/stepper/balance.hpp"

#include <numbers>

#include "fettle/tests/core/stepper/mechanism_models.hpp"

namespace fettle::core::stepper::balance_test {

using namespace fettle::tests::mechanisms;
using scene::Integrator;
using scene::JointKind;

namespace {

const Vector3 x_axis = Vector3::UnitX();

// A bar of 0.08 kg (0.2 x 0.02 x 0.02 m) that slides along x.
scene::Scene slider(Integrator integrator, double h) {
    scene::Scene scene = scene_of({bar("mass", 0.2)}, h);
    scene.velocity_tolerance.reset();
    scene.integrator = integrator;
    scene.mechanism.joints = {joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"mass", Vector3::Zero(), x_axis})};
    return scene;
}

Balance balance(const scene::Scene& scene, int steps) {
    const model::Model model = built(scene);
    const Simulation out = run(model, steps);
    REQUIRE(out.balance);
    return *out.balance;
}

}  // namespace

TEST_CASE("a spring's energy, a damper's loss and a motor's work are told, and balance") {
    scene::Scene scene = slider(Integrator::newmark, 1e-3);
    scene.mechanism.joints.clear();
    scene::Spring spring;
    spring.name = spring.where = "spring";
    spring.a.point = Vector3(-0.3, 0, 0);
    spring.b = {"mass", Vector3(0.1, 0, 0), x_axis};
    spring.forces.stiffness = 300;
    spring.forces.rest = 0.35;
    scene.mechanism.springs = {spring};
    const double stored = 0.5 * 300 * 0.05 * 0.05;
    const Balance free = balance(scene, 400);
    CHECK(free.energy_start == Approx(stored));
    CHECK(free.energy_end == Approx(stored).epsilon(1e-3));
    CHECK(free.work == 0);
    CHECK(free.dissipated == 0);
    CHECK(std::abs(free.energy_error) < 1e-3 * stored);
    scene.mechanism.springs[0].forces.damping = 2;
    const Balance damped = balance(scene, 400);
    CHECK(damped.dissipated > 0.9 * stored);
    CHECK(std::abs(damped.energy_error) < 1e-2 * stored);
    // At 0.5 m/s, from the start on, against 4 N of friction and a spring of 40 N/m, for 0.2 s.
    scene = slider(Integrator::implicit_euler, 1e-3);
    scene.mechanism.joints[0].forces.friction = 4;
    scene.mechanism.joints[0].forces.stiffness = 40;
    scene.mechanism.motors = {motor("drive", "slide", at_rate(0.5))};
    const Balance driven = balance(scene, 200);
    CHECK(driven.dissipated == Approx(4 * 0.1).epsilon(1e-6));
    CHECK(driven.work - driven.dissipated == Approx(driven.energy_end - driven.energy_start - driven.energy_error).epsilon(1e-9));
    CHECK(driven.energy_end - driven.energy_start == Approx(0.5 * 40 * 0.01).epsilon(1e-6));
    CHECK(std::abs(driven.energy_error) < 2e-3 * driven.energy_scale);
}

TEST_CASE("energy that comes from nowhere, and momentum that goes, are warned of") {
    scene::Body body;
    body.name = "box";
    body.mesh = fettle::tests::support::box_mesh(Vector3(-0.01, -0.025, -0.05), Vector3(0.01, 0.025, 0.05));
    body.angular_velocity = std::numbers::pi / 180 * Vector3(20, 700, 30);
    scene::Scene scene = scene_of({body}, 2e-3);
    scene.velocity_tolerance.reset();
    const auto warning = [&](Integrator integrator, std::optional<double> tolerance) {
        scene.integrator = integrator;
        scene.velocity_tolerance = tolerance;
        const model::Model model = built(scene);
        const auto found = run(model, 1000).balance;
        REQUIRE(found);
        CHECK(found->momentum_error < 1e-12);
        return balance_warning(model, *found);
    };
    for (const Integrator integrator : {Integrator::newmark, Integrator::bdf2}) {
        CHECK(warning(integrator, std::nullopt).empty());
        CHECK(warning(integrator, 1e-3).find("gained energy from nowhere") != std::string::npos);  // a hundredth of the size per second
    }
    CHECK(warning(Integrator::implicit_euler, std::nullopt).find("angular momentum") != std::string::npos);
}

TEST_CASE("what a joint carries and what its stop, its spring, its damper and its friction push with are told apart") {
    scene::Scene scene = slider(Integrator::implicit_euler, 1e-3);
    scene.mechanism.joints[0].a.axis = scene.mechanism.joints[0].b.axis = Vector3::UnitZ();
    scene.gravity = Vector3(0, 0, -gravity);
    scene.mechanism.joints[0].forces.limits = {{-0.01, 0.02}};
    scene.mechanism.joints[0].forces.damping = 2;
    const auto last = [&] { return run(built(scene), 2000).outputs.back().joints[0]; };
    const JointForce on_stop = last();
    const double weight = 1000 * 0.2 * 0.02 * 0.02 * gravity;
    CHECK(on_stop.stop == Approx(weight).epsilon(1e-6));
    CHECK(std::abs(on_stop.force.z()) < 1e-9);
    CHECK(std::abs(on_stop.damping) < 1e-6 * weight);
    scene.mechanism.joints[0].forces.limits.reset();
    scene.mechanism.joints[0].forces.stiffness = 500;
    CHECK(last().spring == Approx(weight).epsilon(1e-6));
    scene.mechanism.joints[0].forces.stiffness = 0;
    CHECK(last().damping == Approx(weight).epsilon(1e-6));  // falls steadily at weight / 2
    scene.mechanism.joints[0].forces.damping = 0;
    scene.mechanism.joints[0].forces.friction = 2 * weight;
    CHECK(last().friction == Approx(weight).epsilon(1e-3));  // what the solver may leave
}

}  // namespace fettle::core::stepper::balance_test
