// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/clearance.hpp"

#include <catch2/catch.hpp>

#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/setup/build_model.hpp"
#include "fettle/design/description/constraint.hpp"
#include "fettle/tests/support/box_mesh.hpp"

namespace fettle::design::quantities::clearance_test {

namespace {

using design::description::Measurement;
using design::description::Simulated;

core::scene::Body box(const std::string& name, double half, double x) {
    core::scene::Body body;
    body.name = name;
    body.type = core::scene::BodyType::static_body;
    for (auto& coordinate : body.prescribed) coordinate = core::scene::MotionCurve{};
    body.mesh = tests::support::box_mesh(Vector3::Constant(-half), Vector3::Constant(half));
    body.pose.position.x() = x;
    return body;
}

// A small cube and a large one, both static: no simulation looks whether they overlap.
core::model::Model cubes(double x) {
    core::scene::Scene scene;
    scene.bodies = {box("small", 0.01, x), box("large", 0.05, 0)};
    auto model = core::setup::build_model(scene);
    REQUIRE(model);
    return std::move(model).value();
}

void remove_a_triangle(core::model::Body& body) {
    auto triangles = body.mesh.triangles;
    triangles.pop_back();
    body.mesh = core::geometry::make_mesh("open", body.mesh.vertices, triangles);
    body.hierarchy = std::make_shared<const core::geometry::BodyHierarchy>(body.mesh);
}

Measurement measured(const core::model::Model& model, const Clearance& clearance) {
    const core::stepper::Trajectory start = core::clearance::as_assembled(model);
    return clearance.value({model, start, 1e-9});
}

}  // namespace

TEST_CASE("windows divide the steps without gap or overlap") {
    for (const int steps : {10, 17, 205}) {
        for (const int windows : {1, 2, 3, 10}) {
            int next = 0;
            for (int w = 0; w < windows; ++w) {
                const auto [first, last] = window_steps(steps, w, windows);
                CHECK(first == next);
                CHECK(last >= first);
                next = last;
            }
            CHECK(next == steps);
        }
    }
    CHECK(window_steps(2, 1, 5) == std::pair(0, 1));
    CHECK(window_steps(2, 4, 5) == std::pair(1, 2));
}

TEST_CASE("a clearance is that of solids: a body inside another violates it, with the reason") {
    const Clearance clearance({.a = 0, .b = 1}, 1e-3);
    const Measurement beside = measured(cubes(0.1), clearance);
    CHECK(beside.value == Approx(0.04));
    CHECK(beside.fault.empty());
    CHECK(beside.clearance->status == core::clearance::PairStatus::clear);

    const Measurement inside = measured(cubes(0.01), clearance);
    CHECK(inside.fault.find("`small` and `large` one lies inside") != std::string::npos);
    CHECK(inside.value == Approx(-0.03));
    CHECK(inside.lower == inside.value);
    CHECK(inside.upper == inside.value);
    CHECK(inside.clearance->lower == 0);
    CHECK(inside.clearance->status == core::clearance::PairStatus::violated);
    design::description::Bounds at_least;
    at_least.lower = 1e-3;
    CHECK(violation(at_least, inside) >= 1);

    const Measurement across = measured(cubes(0.055), clearance);
    CHECK(across.lower == 0);
    CHECK(across.fault.find("pass through each other") != std::string::npos);
    CHECK(violation({.upper = 1}, across) >= 1);  // which is true of any bound
}

TEST_CASE("a clearance is not met where a body may lie inside another whose mesh is not closed") {
    core::model::Model model = cubes(0);
    remove_a_triangle(model.bodies[1]);
    const Measurement inside = measured(model, Clearance({.a = 0, .b = 1}, 1e-3));
    CHECK(inside.fault.find("`small` and `large`: whether one lies inside the other cannot be verified") != std::string::npos);
    model.bodies[1].mass_kind = core::scene::MassKind::area;
    CHECK(measured(model, Clearance({.a = 0, .b = 1}, 1e-3)).fault.empty());
    model = cubes(0.2);
    remove_a_triangle(model.bodies[1]);
    CHECK(measured(model, Clearance({.a = 0, .b = 1}, 1e-3)).fault.empty());
}

TEST_CASE("the derivative of a body's place inside another leads it out") {
    core::model::Model model = cubes(0.01);
    const core::stepper::Trajectory start = core::clearance::as_assembled(model);
    const Clearance clearance({.a = 0, .b = 1});
    const Simulated simulated{model, start, 1e-9};
    adjoint::Seeds seeds = adjoint::zero_seeds(model, 0);
    clearance.add_seeds(simulated, clearance.value(simulated), 1, seeds);
    CHECK(seeds.trajectory_bar.pose_bar[0][0].col(3).x() == Approx(1));
    const double step = 1e-4;
    const double ahead = measured(cubes(0.01 + step), clearance).value, behind = measured(cubes(0.01 - step), clearance).value;
    CHECK((ahead - behind) / (2 * step) == Approx(1).epsilon(1e-4));
}

TEST_CASE("a clearance of bodies that are not there, or of one body, is refused") {
    const core::model::Model model = cubes(0.1);
    CHECK(Clearance({.a = 0, .b = 1}).check(model, 0).empty());
    CHECK(Clearance({.a = 0, .b = 2}).check(model, 0).size() == 1);
    CHECK(Clearance({.a = 1, .b = 1}).check(model, 0).size() == 1);
    CHECK(Clearance({.a = 0, .b = 1, .motion = true}).check(model, 0).size() == 1);
}

}  // namespace fettle::design::quantities::clearance_test
