// SPDX-License-Identifier: MIT
// What acts on bodies at the start, by hand; and that Newmark's first step knows it: energy and order of a mass on a spring.
#include "core/energy/start_history.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mechanisms.hpp"

namespace fettle::core::energy::start_history_test {

using namespace fettle::tests::mechanisms;
using scene::Integrator;

namespace {

const Vector3 x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ();

scene::Spring spring(const std::string& name, const scene::Attachment& a, const scene::Attachment& b) {
    scene::Spring out;
    out.name = name;
    out.a = a;
    out.b = b;
    return out;
}

Vector3 velocity_at(const model::Body& body, const Vector3& x) {
    const Matrix3 w = body.velocity_start.leftCols<3>() * body.pose_start.rotation.transpose();
    return body.velocity_start.col(3) + w * (x - body.pose_start.position);
}

// A mass of 1 kg on a spring along x, pulled out by 0.1 m and pushed; nothing turns it.
struct Oscillator {
    static constexpr double stiffness = 30, pull = 0.1, push = 0.2, anchor = -1;
    double damping = 0;

    model::Model at(double h) const {
        scene::Scene scene = scene_of({bar("mass", 0.1, Vector3::Zero(), Vector3::Zero(), 0.05)}, h);
        scene.integrator = Integrator::newmark;
        scene.bodies[0].linear_velocity = push * x_axis;
        scene::Spring holds = spring("holds", {"", Vector3(anchor, 0, 0), z_axis}, {"mass", Vector3(0.05, 0, 0), z_axis});
        holds.forces.stiffness = stiffness;
        holds.forces.rest = 0.05 - anchor - pull;
        holds.forces.damping = damping;
        scene.mechanism.springs = {holds};
        return built(scene);
    }

    // x'' + 2 g x' + w^2 x = 0 of the pull x.
    double exact(double t) const {
        const double g = damping / 2, w = std::sqrt(stiffness - g * g);
        return std::exp(-g * t) * (pull * std::cos(w * t) + (push + g * pull) / w * std::sin(w * t));
    }

    double error(int steps) const {
        constexpr double end = 0.8;
        const stepper::Simulation done = run(at(end / steps), steps, true);
        const double travel = (done.trajectory.poses.back()[0].position - done.trajectory.poses.front()[0].position).x();
        return pull + travel - exact(end);
    }
};

}  // namespace

TEST_CASE("loads at the start: springs, dampers, friction, loads at points, by hand", "[time_integration][joints]") {
    scene::Scene scene = scene_of({bar("one", 0.3), bar("two", 0.2, Vector3(0.1, 0.3, 0.2), Vector3(0.4, 0.2, -0.3))}, 0.01);
    scene.integrator = Integrator::newmark;
    scene.friction.eps_v = 1e-3;
    scene.bodies[0].angular_velocity = Vector3(2, -1, 3);
    scene.bodies[1].linear_velocity = Vector3(0.2, 0.3, -0.1);
    scene.bodies[1].force = Vector3(0.3, 0.2, 0.1);
    scene.bodies[1].torque = Vector3(0.01, 0.02, -0.01);
    scene::Spring between = spring("between", {"one", Vector3(0.3, 0, 0), z_axis}, {"two", Vector3(0.2, 0, 0), z_axis});
    between.forces = {7, 0.2, 0, 0.3, 0.25, std::nullopt};
    scene.mechanism.springs = {between};
    scene.mechanism.loads = {{"load", "", "two", Vector3(0.1, 0.02, 0), Vector3(0.1, 0.2, 0.3)}};
    const model::Model model = built(scene);
    const model::Body &one = model.bodies[0], &two = model.bodies[1];
    const Vector3 a = world_position(scene.bodies[0].pose, Vector3(0.3, 0, 0)),
                  b = world_position(scene.bodies[1].pose, Vector3(0.2, 0, 0)),
                  at = world_position(scene.bodies[1].pose, Vector3(0.1, 0.02, 0));
    const Vector3 n = (b - a).normalized();
    const double rate = n.dot(velocity_at(two, b) - velocity_at(one, a));
    REQUIRE(std::abs(rate) > 1e-2);  // faster than friction's bound
    const double pulled = 7 * ((b - a).norm() - 0.2) + 0.3 * rate + std::copysign(0.25, rate);
    const Vector3 load(0.1, 0.2, 0.3), force = pulled * n;
    Vector6 wanted_one, wanted_two;
    wanted_one << force, (a - one.pose_start.position).cross(force);
    wanted_two << load - force, (at - two.pose_start.position).cross(load) - (b - two.pose_start.position).cross(force);
    wanted_two.head<3>() += two.force;
    wanted_two.tail<3>() += two.torque;
    const std::vector<Vector6> loads = start_loads(model);
    CHECK((loads[0] - wanted_one).norm() < 1e-12 * wanted_one.norm());
    CHECK((loads[1] - wanted_two).norm() < 1e-12 * wanted_two.norm());
    const double mass = one.moments(3, 3);
    CHECK((mass * start_history(model).accelerations[0].col(3) - force).norm() < 1e-11 * force.norm());
}

TEST_CASE("Newmark keeps the energy of a mass on a spring from its first step on", "[time_integration][joints]") {
    const Oscillator oscillator;
    const model::Model model = oscillator.at(0.05);  // a quarter of a radian each
    REQUIRE(model.bodies[0].moments(3, 3) == Approx(1));
    const double energy = 0.5 * Oscillator::push * Oscillator::push + 0.5 * Oscillator::stiffness * Oscillator::pull * Oscillator::pull;
    for (const stepper::StepOutputs& step : run(model, 40, true).outputs)
        CHECK(step.kinetic_energy + step.spring_energy == Approx(energy).epsilon(1e-10));
}

TEST_CASE("Newmark is of second order with springs and dampers", "[time_integration][joints]") {
    for (const double damping : {0.0, 2.0}) {
        const Oscillator oscillator{damping};
        const double coarse = oscillator.error(40), fine = oscillator.error(80);
        CAPTURE(damping, coarse, fine);
        CHECK(coarse / fine == Approx(4).epsilon(0.05));
        CHECK(std::abs(fine) < 1e-4);
    }
}

}  // namespace fettle::core::energy::start_history_test
