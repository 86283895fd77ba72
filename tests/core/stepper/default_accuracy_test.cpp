// SPDX-License-Identifier: MIT
// What a user gets: scenes without a word about the solver, over a decade of time steps, against motions that are integrated here by
// Runge's and Kutta's method. Orders 1, 2, 2 of implicit Euler, BDF2 and Newmark, and what is conserved. The solver's own error must not
// show. A single pendulum: tests/scenes/pendulum_test.cpp.
#include <functional>
#include <numbers>

#include "tests/core/stepper/physics_models.hpp"
#include "tests/support/integrated.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::stepper::default_accuracy_test {

using namespace fettle::tests;
using mechanisms::bar;
using mechanisms::joint;
using scene::Integrator;
using scene::JointKind;
using support::integrated;
using support::Rates;
using support::State;

namespace {

const Vector3 y_axis = Vector3::UnitY();
constexpr double pi = std::numbers::pi;

// As a file without "contact" would give it.
scene::Scene default_scene(std::vector<scene::Body> bodies, Integrator integrator, double h) {
    scene::Scene scene = mechanisms::scene_of(std::move(bodies), h);
    scene.velocity_tolerance.reset();
    scene.integrator = integrator;
    return scene;
}

Simulation run_for(const model::Model& model, double time) {
    return mechanisms::run(model, static_cast<int>(std::lround(time / model.timestep)));
}

const std::vector<Integrator> all{Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark};
const std::vector<Integrator> with_joints{Integrator::implicit_euler, Integrator::bdf2};

// Errors at h, h/2, ... over a decade fall with the integrator's order: from step to step at the end, and nearly so over all of them.
void check_order(const std::vector<Integrator>& integrators, double coarsest, const std::function<double(Integrator, double)>& error) {
    for (const Integrator integrator : integrators) {
        const double order = integrator == Integrator::implicit_euler ? 1 : 2;
        constexpr int halvings = 4;
        std::vector<double> errors;
        for (int k = 0; k <= halvings; ++k) errors.push_back(error(integrator, coarsest / (1 << k)));
        for (const double e : errors) UNSCOPED_INFO("error " << e);
        INFO("integrator " << static_cast<int>(integrator));
        CHECK(std::log2(errors.front() / errors.back()) / halvings > 0.8 * order);
        CHECK(std::log2(errors[halvings - 1] / errors[halvings]) > 0.9 * order);
    }
}

// 20 x 50 x 100 mm, tumbling about its middle axis.
scene::Scene tumbling(Integrator integrator, double h) {
    scene::Body body;
    body.name = "box";
    body.mesh = support::box_mesh(Vector3(-0.01, -0.025, -0.05), Vector3(0.01, 0.025, 0.05));
    body.angular_velocity = pi / 180 * Vector3(20, 700, 30);
    return default_scene({body}, integrator, h);
}

double angle_between(const Matrix3& a, const Matrix3& b) { return std::asin(std::min(1.0, (a - b).norm() / (2 * std::sqrt(2.0)))) * 2; }

}  // namespace

TEST_CASE("A free body tumbles with the integrator's order") {
    const double time = 0.4;
    // Euler's equations with a quaternion, world from body.
    const Vector3 moments = Vector3(0.05 * 0.05 + 0.1 * 0.1, 0.02 * 0.02 + 0.1 * 0.1, 0.02 * 0.02 + 0.05 * 0.05);
    const Vector3 start = tumbling(Integrator::bdf2, 1).bodies[0].angular_velocity;
    const Rates rates = [&](const State& y) {
        const Vector3 omega(y[4], y[5], y[6]), spin = moments.cwiseProduct(omega);
        const Vector3 turn = spin.cross(omega).cwiseQuotient(moments);
        const Eigen::Quaterniond q(y[0], y[1], y[2], y[3]), dq = q * Eigen::Quaterniond(0, omega.x(), omega.y(), omega.z());
        return State{dq.w() / 2, dq.x() / 2, dq.y() / 2, dq.z() / 2, turn.x(), turn.y(), turn.z()};
    };
    const State end = integrated({1, 0, 0, 0, start.x(), start.y(), start.z()}, rates, time);
    const Matrix3 expected = Eigen::Quaterniond(end[0], end[1], end[2], end[3]).toRotationMatrix();
    check_order(all, 4e-3, [&](Integrator integrator, double h) {
        const Simulation out = run_for(mechanisms::built(tumbling(integrator, h)), time);
        return angle_between(physics::rotation(out, count_of(out.trajectory.steps)), expected);
    });
}

TEST_CASE("A free body keeps its energy and its angular momentum") {
    for (const auto& [integrator, h, allowed] : {std::tuple{Integrator::newmark, 4e-3, 2e-3},
                                                 {Integrator::newmark, 2e-3, 5e-4},
                                                 {Integrator::newmark, 1e-3, 2e-4},
                                                 {Integrator::newmark, 5e-4, 1e-4},
                                                 {Integrator::bdf2, 2e-3, 4e-2},
                                                 {Integrator::bdf2, 1e-3, 1e-2},
                                                 {Integrator::bdf2, 5e-4, 2e-3}}) {
        const Simulation out = run_for(mechanisms::built(tumbling(integrator, h)), 2);
        const StepOutputs &first = out.outputs.front(), &last = out.outputs.back();
        INFO("integrator " << static_cast<int>(integrator) << ", step " << h);
        CHECK(last.kinetic_energy / first.kinetic_energy == Approx(1).margin(allowed));
        CHECK((last.angular_momentum - first.angular_momentum).norm() <= allowed * first.angular_momentum.norm());
    }
}

TEST_CASE("A double pendulum swings with the integrator's order") {
    // Two equal bars; a, b their angles from the vertical. With J = m (L^2 + half^2) / 3 about an end:
    //   (J + m L^2) a'' + m L^2/2 cos(a - b) b'' = -m L^2/2 sin(a - b) b'^2 - 3/2 m g L sin a
    //   m L^2/2 cos(a - b) a'' + J b'' = m L^2/2 sin(a - b) a'^2 - m g L/2 sin b
    const double length = 0.2, half = 0.01, time = 0.5, g = mechanisms::gravity;
    const double inertia = (length * length + half * half) / 3, coupling = 0.5 * length * length;
    const Rates rates = [&](const State& y) {
        const double c = coupling * std::cos(y[0] - y[1]), s = coupling * std::sin(y[0] - y[1]);
        Eigen::Matrix2d mass;
        mass << inertia + length * length, c, c, inertia;
        const Eigen::Vector2d force(-s * y[3] * y[3] - 1.5 * g * length * std::sin(y[0]),
                                    s * y[2] * y[2] - 0.5 * g * length * std::sin(y[1]));
        const Eigen::Vector2d acceleration = mass.inverse() * force;
        return State{y[2], y[3], acceleration[0], acceleration[1]};
    };
    const double first = 1.2, second = 0.4;
    const State end = integrated({first, second, 0, 0}, rates, time);
    check_order(with_joints, 4e-3, [&](Integrator integrator, double h) {
        const Vector3 elbow = length * Vector3(std::sin(first), 0, -std::cos(first));
        scene::Scene scene = default_scene({bar("upper", length, Vector3::Zero(), Vector3(0, pi / 2 - first, 0)),
                                            bar("lower", length, elbow, Vector3(0, pi / 2 - second, 0))},
                                           integrator, h);
        scene.gravity = Vector3(0, 0, -g);
        scene.mechanism.joints = {
            joint("shoulder", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"upper", Vector3::Zero(), y_axis}),
            joint("elbow", JointKind::revolute, {"upper", Vector3(length, 0, 0), y_axis}, {"lower", Vector3::Zero(), y_axis})};
        const model::Model model = mechanisms::built(scene);
        const Simulation out = run_for(model, time);
        const int last = count_of(out.trajectory.steps);
        const Vector3 tip = mechanisms::place(model, out, last, 1, Vector3(length, 0, 0));
        const Vector3 expected = length * Vector3(std::sin(end[0]) + std::sin(end[1]), 0, -std::cos(end[0]) - std::cos(end[1]));
        return (tip - expected).norm();
    });
}

TEST_CASE("A mass on a spring swings with the integrator's order") {
    const double stiffness = 40, time = 0.4, stretch = 0.05, length = 0.3;
    check_order(all, 4e-3, [&](Integrator integrator, double h) {
        scene::Scene scene = default_scene({bar("mass", 0.2)}, integrator, h);
        scene::Spring spring;
        spring.name = spring.where = "spring";
        spring.a.point = Vector3(-length, 0, 0);
        spring.b = {"mass", Vector3(0.1, 0, 0), Vector3::UnitX()};  // its centre
        spring.forces.stiffness = stiffness;
        spring.forces.rest = length + 0.1 - stretch;
        scene.mechanism.springs = {spring};
        const model::Model model = mechanisms::built(scene);
        const double mass = model.bodies[0].moments(3, 3);
        const Simulation out = run_for(model, time);
        const int last = count_of(out.trajectory.steps);
        const double x = mechanisms::place(model, out, last, 0, Vector3::Zero()).x();
        return std::abs(x - stretch * (std::cos(std::sqrt(stiffness / mass) * time) - 1));
    });
}

TEST_CASE("A block bounces on soft contact with the integrator's order") {
    // Four corners above a plane: each pushes by kappa/(4 dhat^2) b(d^2), b(g) = -(g - dhat^2)^2 ln(g / dhat^2).
    const double kappa = 2000, dhat = 0.02, gap = 0.0205, speed = 0.3, time = 0.09, side = 0.1;
    const double mass = 1000 * side * side * side;
    const Rates rates = [&](const State& y) {
        const double g = y[0] * y[0], hat = dhat * dhat, away = g - hat;
        const double slope = g < hat ? -2 * away * std::log(g / hat) - away * away / g : 0;
        return State{y[1], -4 * kappa / (4 * hat) * slope * 2 * y[0] / mass};
    };
    const State end = integrated({gap, -speed}, rates, time);
    REQUIRE(end[1] > 0);  // it has turned round
    check_order(all, 2e-3, [&](Integrator integrator, double h) {
        scene::Body block;
        block.name = "block";
        block.mesh = support::box_mesh(Vector3(-side / 2, -side / 2, 0), Vector3(side / 2, side / 2, side));
        block.pose.position = Vector3(0, 0, gap);
        block.linear_velocity = Vector3(0, 0, -speed);
        scene::Body ground;
        ground.name = "ground";
        ground.type = scene::BodyType::static_body;
        ground.mesh = support::box_mesh(Vector3(-1, -1, -0.1), Vector3(1, 1, 0));
        scene::Scene scene = default_scene({block, ground}, integrator, h);
        for (scene::Body& body : scene.bodies) body.group = -1;
        scene.kappa = kappa;
        scene.dhat = dhat;
        const model::Model model = mechanisms::built(scene);
        const Simulation out = run_for(model, time);
        const int last = count_of(out.trajectory.steps);
        return std::abs(mechanisms::place(model, out, last, 0, Vector3::Zero()).z() - end[0]);
    });
}

TEST_CASE("A joint's friction holds what is below it and brakes what is above by default") {
    for (const Integrator integrator : with_joints) {
        for (const double force : {4.9, 8.0}) {
            scene::Body block;
            block.name = "block";
            block.mesh = support::box_mesh(Vector3(-0.05, -0.05, -0.05), Vector3(0.05, 0.05, 0.05));
            block.force = Vector3(force, 0, 0);
            scene::Scene scene = default_scene({block}, integrator, 0.005);
            scene.mechanism.joints = {joint("slide", JointKind::prismatic, {"", Vector3::Zero(), Vector3::UnitX()},
                                            {"block", Vector3::Zero(), Vector3::UnitX()})};
            scene.mechanism.joints[0].forces.friction = 5;
            const model::Model model = mechanisms::built(scene);
            const Simulation out = run_for(model, 1);
            const double way = physics::position(out, 200).x(), speed = physics::velocity(out, 200).x();
            INFO("integrator " << static_cast<int>(integrator) << ", " << force << " N");
            if (force < 5)  // 1 - (1 - v/eps_v)^2 = 4.9/5
                CHECK(speed == Approx(model.friction.eps_v * (1 - std::sqrt(1 - force / 5))).epsilon(0.01));
            else  // 1 kg by 3 N for a second, half a step more or less
                CHECK(way == Approx(1.5).margin(integrator == Integrator::implicit_euler ? 8e-3 : 2e-3));
        }
    }
}

}  // namespace fettle::core::stepper::default_accuracy_test
