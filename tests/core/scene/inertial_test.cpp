// SPDX-License-Identifier: MIT
// Given mass and inertia: against those of solids, values that no body has, and from a file to a motion.
#include "core/scene/inertial.hpp"

#include <catch2/catch.hpp>

#include "core/geometry/mass_moments.hpp"
#include "core/kinematics/rotation.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/core/scene_files/scene_workshop.hpp"

namespace fettle::core::scene::inertial_test {

namespace {

using namespace scene_files::test_support;

// The inertia of a box with these edges, by the textbook.
Inertial box_of(const Vector3& edges, double mass, const Vector3& centre) {
    const Vector3 squares = edges.cwiseAbs2();
    const Vector3 moments = mass / 12 * (Vector3::Constant(squares.sum()) - squares);
    return {mass, centre, moments.asDiagonal()};
}

Inertial diagonal(double a, double b, double c) { return {1, Vector3::Zero(), Vector3(a, b, c).asDiagonal()}; }

// The plain scene's box with given mass and inertia in place of its density.
json given(const json& inertial) {
    json scene = with("/bodies/0/inertial", inertial);
    scene["bodies"][0].erase("density");
    return scene;
}

const json turned = {{"mass", "500 g"}, {"centre", {1, 2, 3}}, {"inertia", {{3e-4, 1e-5, 0}, {1e-5, 4e-4, 0}, {0, 0, 5e-4}}}};

TEST_CASE("given inertia: moments about a point are those of the solid", "[scene]") {
    const Vector3 low(0.1, -0.2, 0.3), high(0.4, 0.2, 0.9), c(0.7, 0.1, -0.3);
    const auto mesh = tests::support::box_mesh(low - c, high - c);
    const double density = 700, mass = density * (high - low).prod();
    const Inertial box = box_of(high - low, mass, 0.5 * (low + high));
    const Matrix4 solid = density * geometry::solid_moments(mesh.vertices, mesh.triangles);
    CHECK((moments_about(box, c) - solid).norm() <= 1e-13 * solid.norm());
    // There and back, with axes that are not principal ones.
    const Matrix3 turn = kinematics::rotation({0.4, -1, 2});
    const Inertial leaning{mass, box.centre, turn * box.inertia * turn.transpose()};
    const Inertial again = inertial_of(moments_about(leaning, Vector3::Zero()));
    CHECK(again.mass == mass);
    CHECK((again.centre - leaning.centre).norm() <= 1e-15);
    CHECK((again.inertia - leaning.inertia).norm() <= 1e-13 * leaning.inertia.norm());
}

TEST_CASE("given inertia: what no body has", "[scene]") {
    CHECK(fault_of(diagonal(2, 3, 4)).empty());
    CHECK(fault_of(diagonal(2, 3, 5)).empty());  // flat
    CHECK(fault_of(diagonal(2, 3, 5.000005)).empty());
    CHECK(fault_of(diagonal(2, 3, 5.001)).starts_with("a principal moment of inertia is more than the sum of the other two"));
    CHECK(contains(fault_of(diagonal(-0.1, 3, 3)), "is not positive definite"));
    CHECK(contains(fault_of(diagonal(0, 3, 3)), "positive definite"));
    CHECK(contains(fault_of(diagonal(0, 0, 0)), "positive moments"));
    CHECK(contains(fault_of(diagonal(std::nan(""), 3, 3)), "finite"));
    Inertial skew = diagonal(2, 3, 4);
    skew.inertia(0, 1) = 0.1;
    CHECK(contains(fault_of(skew), "symmetric"));
    for (const double mass : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        Inertial weightless = diagonal(2, 3, 4);
        weightless.mass = mass;
        CHECK(contains(fault_of(weightless), "mass"));
    }
    // What rounding makes of a flat body has no negative moment.
    const Matrix4 flat = moments_about(diagonal(2, 3, 5.000005), Vector3::Zero());
    CHECK(flat(2, 2) == 0);
    CHECK(flat(0, 0) == Approx(3).epsilon(1e-5));
}

TEST_CASE("given inertia: a scene file's, in its place", "[scene]") {
    const Workshop shop;
    const auto scene = shop.read(given(turned));
    REQUIRE(scene);
    const Body& body = scene->bodies[0];
    REQUIRE(body.inertial);
    CHECK(body.inertial->mass == 0.5);
    CHECK(body.inertial->centre.isApprox(Vector3(1e-3, 2e-3, 3e-3)));
    CHECK(body.inertial->inertia(0, 1) == 1e-5);
    CHECK_FALSE(body.density_given);
    const auto refused = [&](const json& file) {
        const auto result = shop.read(file);
        REQUIRE(result.errors().size() == 1);
        return result.errors().front();
    };
    CHECK(contains(refused(with("/bodies/0/inertial", turned)).where, "/bodies/0/density"));  // both
    json strange = turned;
    strange["inertia"][2][2] = 9e-4;
    CHECK(contains(refused(given(strange)).where, "/bodies/0/inertial"));
    CHECK(contains(refused(given(strange)).message, "sum of the other two"));
    strange["inertia"] = {{1, 0, 0}, {0, 1, 0}};
    CHECK(contains(refused(given(strange)).message, "three rows"));
    for (const char* key : {"mass", "centre", "inertia"}) {
        json partial = turned;
        partial.erase(key);
        CHECK(contains(refused(given(partial)).message, key));
    }
    json split = given(turned);
    split["bodies"][0]["split_components"] = true;
    CHECK(contains(refused(split).where, "split_components"));
}

TEST_CASE("given inertia: an open mesh moves by it, about its centre", "[scene]") {
    const Workshop shop;
    json file = given(turned);
    file["bodies"][0].erase("mesh");
    file["bodies"][0]["vertices"] = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    file["bodies"][0]["triangles"] = {{0, 1, 2}};
    file["bodies"][0]["torque"] = {0, 0, 1e-3};
    file["bodies"][0]["fixed"] = {"px", "py", "pz", "rx", "ry"};
    file["timestep"] = 0.01;
    const auto scene = shop.read(file);
    REQUIRE(scene);
    const auto model = setup::build_model(*scene);
    REQUIRE(model);
    const model::Body& body = model->bodies[0];
    CHECK(body.given_mass == 0.5);
    CHECK(body.reference_point.isApprox(Vector3(1e-3, 2e-3, 3e-3)));
    CHECK(body.moments(3, 3) == 0.5);
    CHECK(body.moments.col(3).head<3>().norm() < 1e-18);
    stepper::SimulationOptions options;
    options.steps = 20;
    options.for_gradient = true;
    const auto run = stepper::simulate(*model, options);
    REQUIRE(run.report.status == stepper::SimulationStatus::ok);
    // Implicit Euler: theta_n = (torque / izz) h^2 n (n + 1) / 2, but for O(theta^2) of each step.
    const double expected = 1e-3 / 5e-4 * 1e-4 * 20 * 21 / 2;
    CHECK(kinematics::rotation_vector(run.trajectory.poses.back()[0].rotation).z() == Approx(expected).epsilon(1e-4));
    Scene wrong = *scene;
    wrong.bodies[0].inertial->mass = 0;
    const auto refused = setup::build_model(wrong);
    REQUIRE_FALSE(refused);
    CHECK(contains(refused.errors().front().where, "/bodies/0/inertial"));
}

}  // namespace

}  // namespace fettle::core::scene::inertial_test
