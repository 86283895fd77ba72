// SPDX-License-Identifier: MIT
/// Mechanisms of bars for the tests of joints, springs and motors: scenes made in memory, built and run.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/text.hpp"

namespace fettle::tests::mechanisms {

inline constexpr double gravity = 9.81;

/// A bar from its file frame's origin along x, of square section 2 `half` and 1000 kg/m^3.
inline core::scene::Body bar(const std::string& name, double length, const Vector3& position = Vector3::Zero(),
                             const Vector3& rotation_vector = Vector3::Zero(), double half = 0.01) {
    core::scene::Body body;
    body.name = name;
    body.where = "a.scene.json#/bodies/" + name;
    body.mesh = support::box_mesh(Vector3(0, -half, -half), Vector3(length, half, half));
    body.pose.position = position;
    body.pose.rotation = core::kinematics::rotation(rotation_vector);
    return body;
}

inline core::scene::Scene scene_of(std::vector<core::scene::Body> bodies, double h) {
    core::scene::Scene scene;
    scene.path = "a.scene.json";
    scene.bodies = std::move(bodies);
    scene.gravity = Vector3::Zero();
    scene.timestep = h;
    scene.velocity_tolerance = 1e-9;
    for (core::scene::Body& body : scene.bodies) body.group = 0;  // tests of contact say so
    return scene;
}

/// A joint whose two points are at `a` of body_a's frame and `b` of body_b's; no name: the world.
inline core::scene::Joint joint(const std::string& name, core::scene::JointKind kind, const core::scene::Attachment& a,
                                const core::scene::Attachment& b) {
    core::scene::Joint out;
    out.name = name;
    out.where = "a.scene.json#/joints/" + name;
    out.kind = kind;
    out.a = a;
    out.b = b;
    return out;
}

inline core::scene::Motor motor(const std::string& name, const std::string& of, const core::scene::Curve& curve) {
    core::scene::Motor out;
    out.name = name;
    out.where = "a.scene.json#/motors/" + name;
    out.joint = of;
    out.curve = curve;
    return out;
}

/// A spring or damper along a joint's coordinate.
inline core::scene::Spring spring_of(const std::string& name, const std::string& joint, const core::scene::CoordinateForces& forces) {
    core::scene::Spring out;
    out.name = name;
    out.joint = joint;
    out.forces = forces;
    return out;
}

/// The same between points.
inline core::scene::Spring spring_between(const std::string& name, const core::scene::Attachment& a, const core::scene::Attachment& b,
                                          const core::scene::CoordinateForces& forces) {
    core::scene::Spring out = spring_of(name, "", forces);
    out.a = a;
    out.b = b;
    return out;
}

/// A slider-crank in space: crank "main", rod between balls "pin" and the slider's "wrist", slider on "guide", with a load that pushes it.
inline core::scene::Scene slider_crank_scene() {
    using core::scene::JointKind;
    const Vector3 x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ();
    const double start = 0.4, tilt = std::asin(0.1 * std::sin(start) / 0.3);
    const Vector3 pin(0.1 * std::cos(start), 0.1 * std::sin(start), 0), wrist(pin.x() + 0.3 * std::cos(tilt), 0, 0);
    core::scene::Scene scene = scene_of(
        {bar("crank", 0.1, Vector3::Zero(), Vector3(0, 0, start)), bar("rod", 0.3, pin, Vector3(0, 0, -tilt)), bar("slider", 0.05, wrist)},
        0.02);
    scene.mechanism.joints = {
        joint("main", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("pin", JointKind::ball, {"crank", Vector3(0.1, 0, 0), z_axis}, {"rod", Vector3::Zero(), z_axis}),
        joint("wrist", JointKind::cylindrical, {"rod", Vector3(0.3, 0, 0), z_axis}, {"slider", Vector3::Zero(), z_axis}),
        joint("guide", JointKind::prismatic, {"", wrist, x_axis}, {"slider", Vector3::Zero(), x_axis})};
    scene.mechanism.loads = {{"push", "", "slider", Vector3(0.02, 0.01, 0), Vector3(-12, 1, 0.3)}};
    return scene;
}

/// Two bars that springs with all that they can have act between, and on one of them from the world; no rows.
inline core::scene::Scene loose_bars_scene() {
    const Vector3 z_axis = Vector3::UnitZ();
    core::scene::Scene scene = scene_of({bar("one", 0.3), bar("two", 0.2, Vector3(0.1, 0.3, 0.2), Vector3(0.4, 0.2, -0.3))}, 0.01);
    scene.gravity = Vector3(0.2, 0.1, -0.5);
    scene.dhat = 0.05;
    scene.friction.eps_v = 0.5;
    scene.bodies[0].angular_velocity = Vector3(2, -1, 3);
    scene.bodies[1].linear_velocity = Vector3(0.2, 0.3, -0.1);
    scene.mechanism.springs = {spring_between("between", {"one", Vector3(0.3, 0, 0), z_axis}, {"two", Vector3(0.2, 0, 0), z_axis},
                                              {7, 0.2, 0, 0.3, 0.2, std::array<double, 2>{0.0, 0.42}}),
                               spring_between("from world", {"", Vector3(0, 0, 0.5), z_axis}, {"one", Vector3(0.1, 0, 0), z_axis},
                                              {4, 0.8, 0, 0.1, 0, std::nullopt})};
    scene.mechanism.loads = {{"load", "", "two", Vector3(0.1, 0.02, 0), Vector3(0.1, 0.2, 0.3)}};
    return scene;
}

inline core::scene::Curve at_rate(double rate) {
    core::scene::Curve curve;
    curve.rate = rate;
    return curve;
}

inline core::model::Model built(const core::scene::Scene& scene) {
    auto model = core::setup::build_model(scene);
    if (!model) {
        for (const auto& error : model.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(model);
    }
    return std::move(model).value();
}

/// A simulation that has to end well, with outputs. @param exactly  each step to rounding level
inline core::stepper::Simulation run(const core::model::Model& model, int steps, bool exactly = false) {
    core::stepper::SimulationOptions options;
    options.steps = steps;
    options.outputs = true;
    options.for_gradient = exactly;
    core::stepper::Simulation out = core::stepper::simulate(model, options);
    INFO(out.report.message);
    REQUIRE(out.report.status == core::stepper::SimulationStatus::ok);
    REQUIRE(count_of(out.outputs) == steps);
    return out;
}

/// Where a point of a body's file frame is.
inline Vector3 place(const core::model::Model& model, const core::stepper::Simulation& run, int step, int body, const Vector3& point) {
    const auto i = static_cast<std::size_t>(body);
    return core::kinematics::world_position(run.trajectory.poses[step][i], point - model.bodies[i].reference_point);
}

}  // namespace fettle::tests::mechanisms
