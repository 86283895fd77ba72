// SPDX-License-Identifier: MIT
// The balance of a simulation tells nothing where all is kept, the work of forces where they did it, an error where there is one.
#include "core/stepper/balance.hpp"

#include <numbers>

#include "tests/support/mechanisms.hpp"

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
    CHECK(std::abs(driven.energy_error) < 2e-3 * driven.energy_available);
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
        SimulationOptions options;
        options.steps = 1000;
        options.outputs = true;
        const auto found = simulate(model, options).balance;  // what gains too much ends early
        REQUIRE(found);
        CHECK(found->momentum_error < 1e-12);
        return balance_warning(model, *found);
    };
    for (const Integrator integrator : {Integrator::newmark, Integrator::bdf2}) {
        CHECK(warning(integrator, std::nullopt).empty());
        CHECK(warning(integrator, 1e-3).find("gained energy from nowhere") != std::string::npos);  // a hundredth of the size per second
    }
    CHECK(warning(Integrator::implicit_euler, std::nullopt).find("lost") != std::string::npos);
}

TEST_CASE("a scripted body supplies what it pulls along by a joint") {
    // A carriage that is taken along z at 2 m/s^2 for 0.1 s, and 0.04 kg on a hinge about z: what the load gets is the carriage's work.
    scene::Body carriage = bar("carriage", 0.1), load = bar("load", 0.1);
    carriage.type = scene::BodyType::kinematic_body;
    for (auto& each : carriage.prescribed) each = scene::MotionCurve{};
    for (int k = 0; k <= 100; ++k) {
        const double time = 1e-3 * k;
        carriage.prescribed[2]->times.push_back(time);
        carriage.prescribed[2]->values.push_back(time * time);
    }
    scene::Scene scene = scene_of({carriage, load}, 1e-3);
    scene.integrator = Integrator::implicit_euler;
    scene.mechanism.joints = {
        joint("hinge", JointKind::revolute, {"carriage", Vector3::Zero(), Vector3::UnitZ()}, {"load", Vector3::Zero(), Vector3::UnitZ()})};
    const model::Model model = built(scene);
    const Simulation out = run(model, 100);
    REQUIRE(out.outputs.back().drives.size() == 1);
    CHECK(out.outputs.back().drives[0].force.z() == Approx(0.04 * 2).epsilon(1e-6));
    CHECK(out.outputs.back().drives[0].torque.norm() == Approx(0).margin(1e-9));  // both have their mass centre at one place
    REQUIRE(out.balance);
    CHECK(out.outputs.back().kinetic_energy == Approx(0.5 * 0.04 * 0.2 * 0.2).epsilon(0.02));
    CHECK(out.balance->work == Approx(out.outputs.back().kinetic_energy).epsilon(1e-3));
    CHECK(balance_warning(model, *out.balance).empty());
}

TEST_CASE("what comes to rest, anywhere, is told to gain energy where it is thrown, and nowhere else") {
    const auto block = [](const std::string& name, const Vector3& low, const Vector3& size) {
        scene::Body body;
        body.name = name;
        body.where = "a.scene.json#/bodies/" + name;
        body.mesh = fettle::tests::support::box_mesh(low, low + size);
        return body;
    };
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark})
        for (const Vector3& at : {Vector3(0, 0, 0), Vector3(3, -2, 1)})
            for (const int boxes : {1, 3}) {
                INFO(static_cast<int>(integrator) << " " << at.transpose() << " " << boxes);
                std::vector<scene::Body> bodies{block("floor", at - Vector3(0.1, 0.1, 0.02), Vector3(0.2, 0.2, 0.02))};
                bodies[0].type = scene::BodyType::static_body;
                const double gap = 2e-4, size = 0.02;
                for (int k = 0; k < boxes; ++k)
                    bodies.push_back(
                        block("box" + std::to_string(k), at + Vector3(-0.01, -0.01, gap + k * (size + gap)), Vector3::Constant(size)));
                scene::Scene scene = scene_of(bodies, 2e-3);
                scene.velocity_tolerance.reset();
                for (scene::Body& body : scene.bodies) body.group = -1;
                scene.gravity = Vector3(0, 0, -gravity);
                scene.integrator = integrator;
                const model::Model model = built(scene);
                for (const int steps : {1, 60}) {
                    SimulationOptions options;
                    options.steps = steps;
                    options.outputs = true;
                    const Simulation out = simulate(model, options);
                    const auto found = out.balance;
                    REQUIRE(found);
                    INFO(steps << " steps: error " << found->energy_error << " J of " << found->energy_available << ", start "
                               << found->energy_start << ", end " << found->energy_end << ", lost " << found->dissipated);
                    // Newmark's rule throws what has fallen 0.2 mm up by millimetres, and says so.
                    const bool is_thrown = found->energy_error > 0.5 * found->energy_available;
                    CHECK((!is_thrown || integrator == Integrator::newmark));
                    CHECK(out.report.status == (is_of_nowhere(*found) ? SimulationStatus::energy_gained : SimulationStatus::ok));
                    const std::string told = balance_warning(model, *found);
                    CHECK((is_thrown ? told.find("bdf2") != std::string::npos : told.find("gained") == std::string::npos));
                    CHECK(found->energy_available > 0);
                }
            }
}

TEST_CASE("what joints and loads hold is not warned of, though energies are rounding") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2})
        for (const double h : {0.02, 0.002}) {
            scene::Scene arm = slider(integrator, h);
            arm.gravity = Vector3(0, 0, -gravity);
            arm.mechanism.joints[0].kind = JointKind::fixed;
            CHECK(balance_warning(built(arm), balance(arm, 100)).empty());
            // A hinge whose friction holds nearly all that it can.
            arm.gravity.setZero();
            arm.mechanism.joints[0].kind = JointKind::revolute;
            arm.mechanism.joints[0].forces.friction = 0.01;
            arm.bodies[0].torque = Vector3(0.00998, 0, 0);
            const std::string told = balance_warning(built(arm), balance(arm, 100));
            CAPTURE(told);
            CHECK(told.empty());
        }
}

TEST_CASE("a hoist that comes back is measured by the work that went through it") {
    // 1 kg up by 0.1 m and down again: the net work is nothing, the largest is 0.981 J.
    energy::TermReport start;
    BalanceSum sum(start, 0.1);
    StepOutputs step;
    for (const double power : {9.81, -9.81}) {
        for (int k = 0; k < 2; ++k) {
            step.supplied_power = power;
            step.potential_energy += 0.1 * power;
            sum.add(step);
        }
    }
    CHECK(sum.balance().energy_end == Approx(0).margin(1e-12));
    CHECK(sum.balance().energy_available == Approx(1.962));
}

TEST_CASE("energy that the time integration loses is warned of, with the remedy, where no damping explains it") {
    // A bar on a hinge, let go from the side for 2 s.
    const auto told = [](Integrator integrator, double h, double damping) {
        scene::Scene scene = scene_of({bar("bar", 0.2)}, h);
        scene.velocity_tolerance.reset();
        scene.integrator = integrator;
        scene.gravity = Vector3(0, 0, -gravity);
        scene.mechanism.joints = {
            joint("hinge", JointKind::revolute, {"", Vector3::Zero(), Vector3::UnitY()}, {"bar", Vector3::Zero(), Vector3::UnitY()})};
        scene.mechanism.joints[0].forces.damping = damping;
        const Balance found = balance(scene, static_cast<int>(std::lround(2 / h)));
        const double dropped = 0.08 * gravity * 0.1;
        CHECK(found.energy_available == Approx(dropped).epsilon(0.02));
        return balance_warning(built(scene), found);
    };
    const std::string coarse = told(Integrator::implicit_euler, 0.01, 0);
    CHECK(coarse.find("has lost") != std::string::npos);
    CHECK(coarse.find("bdf2") != std::string::npos);
    CHECK(coarse.find("blow") == std::string::npos);
    CHECK(told(Integrator::bdf2, 0.002, 0).empty());
    CHECK(told(Integrator::bdf2, 0.002, 2e-3).empty());
    CHECK(told(Integrator::implicit_euler, 1e-4, 2e-3).empty());
}

TEST_CASE("what a drive loses by starting at once is no loss of the time integration") {
    // A bar that turns at 0.3 rad/s from the first step on; stops for a while; turns back.
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
        scene::Scene scene = scene_of({bar("wheel", 0.2)}, 0.01);
        scene.integrator = integrator;
        scene.mechanism.joints = {
            joint("axle", JointKind::revolute, {"", Vector3::Zero(), Vector3::UnitY()}, {"wheel", Vector3::Zero(), Vector3::UnitY()})};
        scene::Curve curve;
        curve.times = {0, 0.3, 0.6, 0.9};
        curve.values = {0, 0.09, 0.09, 0};
        scene.mechanism.motors = {motor("drive", "axle", curve)};
        const Balance found = balance(scene, 90);
        INFO(static_cast<int>(integrator) << ": " << found.energy_lost << " J of " << found.energy_available << ", in all "
                                          << -found.energy_error);
        CHECK(std::abs(found.energy_lost) < 1e-2 * found.energy_available);
        CHECK(found.energy_error < -0.2 * found.energy_available);
        CHECK(balance_warning(built(scene), found).empty());
        // Fast, the rule takes its share: no motion that is driven throughout changes by it, but the motor's effort has it in it.
        scene.mechanism.motors[0].curve.values = {0, 3, 3, 0};
        const Balance fast = balance(scene, 90);
        CHECK((integrator == Integrator::bdf2 || fast.energy_lost > 0.05 * fast.energy_available));
        const std::string told = balance_warning(built(scene), fast);
        CHECK(told.empty() == (integrator == Integrator::bdf2));
        CHECK((told.empty() || told.find("forces and efforts") != std::string::npos));
    }
}

TEST_CASE("a motion that has made more energy than there was ends by name, asked for or not") {
    // A cube falls into a corner of Newmark's: the rule throws it up again and again.
    scene::Body floor = bar("floor", 0.2, Vector3(-0.1, 0, -0.01)), cube = bar("cube", 0.02, Vector3(-0.01, 0, 0.0102));
    floor.type = scene::BodyType::static_body;
    scene::Scene scene = scene_of({floor, cube}, 2e-3);
    for (scene::Body& body : scene.bodies) body.group = -1;
    scene.velocity_tolerance.reset();
    scene.gravity = Vector3(0, 0, -gravity);
    for (const Integrator integrator : {Integrator::newmark, Integrator::bdf2, Integrator::implicit_euler})
        for (const bool outputs : {false, true}) {
            scene.integrator = integrator;
            const model::Model model = built(scene);
            SimulationOptions options;
            options.steps = 300;
            options.outputs = outputs;
            const Simulation out = simulate(model, options);
            INFO(static_cast<int>(integrator) << " " << out.report.message);
            const bool gains = integrator == Integrator::newmark;
            CHECK(out.report.status == (gains ? SimulationStatus::energy_gained : SimulationStatus::ok));
            CHECK(out.outputs.size() == (outputs ? out.trajectory.steps.size() : 0));
            if (!gains) continue;
            CHECK(out.trajectory.steps.size() < 300);
            CHECK(out.report.message.find("gained energy from nowhere") != std::string::npos);
            CHECK(out.report.message.find("bdf2") != std::string::npos);
        }
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
