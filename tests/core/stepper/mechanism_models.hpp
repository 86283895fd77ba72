// SPDX-License-Identifier: MIT
/// Mechanisms of bars for the tests of joints, springs and motors: scenes made in memory, built and run.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "fettle/core/model/build_model.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/tests/support/box_mesh.hpp"
#include "fettle/tests/support/text.hpp"

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

inline core::scene::Curve at_rate(double rate) {
    core::scene::Curve curve;
    curve.rate = rate;
    return curve;
}

inline core::model::Model built(const core::scene::Scene& scene) {
    auto model = core::model::build_model(scene);
    if (!model) {
        for (const auto& error : model.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(model);
    }
    return std::move(model).value();
}

inline core::stepper::Simulation run(const core::model::Model& model, int steps, bool exactly = false) {
    core::stepper::SimulationOptions options;
    options.steps = steps;
    options.outputs = true;
    options.for_gradient = exactly;
    core::stepper::Simulation out = core::stepper::simulate(model, options);
    INFO(out.report.message);
    REQUIRE(out.report.status == core::stepper::SimulationStatus::ok);
    return out;
}

/// Where a point of a body's file frame is.
inline Vector3 place(const core::model::Model& model, const core::stepper::Simulation& run, int step, int body, const Vector3& point) {
    const auto i = static_cast<std::size_t>(body);
    return core::kinematics::world_position(run.trajectory.poses[static_cast<std::size_t>(step)][i],
                                            point - model.bodies[i].reference_point);
}

}  // namespace fettle::tests::mechanisms
