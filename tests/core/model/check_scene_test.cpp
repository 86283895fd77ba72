// SPDX-License-Identifier: MIT
#include "core/model/check_scene.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/text.hpp"
#include "core/setup/build_model.hpp"
#include "tests/core/model/box_scenes.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::model::check_scene_test {

using core::setup::build_model;
namespace {

using base::ErrorCode;
using scene::BodyType;

using fettle::tests::box_body;
using fettle::tests::only_error;
using fettle::tests::scene_of;
using fettle::tests::support::contains;

TEST_CASE("A cubic curve that goes beyond its table is told", "[model]") {
    scene::Scene scene = scene_of({box_body("cube", {0, 0, 0}, {1, 1, 1})});
    scene::Motor motor;
    motor.name = "drive";
    motor.curve = {scene::CurveKind::cubic, 0, {0, 1, 2, 3}, {0, 90, 90, 0}, std::nullopt};
    const auto doubts = [&](const scene::Curve& curve) {
        scene.mechanism.motors = {motor};
        scene.mechanism.motors[0].curve = curve;
        const std::vector<std::string> warnings = check_scene(scene, true).warnings;
        return std::count_if(warnings.begin(), warnings.end(), [](const std::string& text) {
            return contains(text, "motor `drive`: its cubic curve goes beyond its table, by");
        });
    };
    // Slopes at the middle entries: 45 and -45, so at 1.5 s 90 + (45 + 45)/8 = 101.25: 12.5% of 90.
    CHECK(doubts(motor.curve) == 1);
    CHECK(curve_value(motor.curve, 1.5) == Approx(101.25));
    scene.mechanism.motors = {motor};
    CHECK(contains(check_scene(scene, true).warnings.back(), "by 12% of the table's range at 1.5 s"));
    scene::Curve within = motor.curve;
    within.values = {0, 30, 60, 90};
    CHECK(doubts(within) == 0);
    within.values = {5, 5, 5, 5};
    CHECK(doubts(within) == 0);
    scene::Curve linear = motor.curve;
    linear.kind = scene::CurveKind::linear;
    CHECK(doubts(linear) == 0);
    CHECK(doubts({scene::CurveKind::cubic, 0, {0, 1}, {0, 90}, std::nullopt}) == 0);
}

TEST_CASE("A motion or load beyond any mechanism is refused", "[model]") {
    scene::Body cube = box_body("cube", {0, 0, 0}, {1, 1, 1});
    cube.linear_velocity.x() = 1e150;
    CHECK(contains(only_error(build_model(scene_of({cube}))).message, "beyond 1e30"));
    cube.linear_velocity.x() = 0;
    cube.prescribed[5] = scene::MotionCurve{};
    cube.prescribed[5]->rate = 1e150;
    CHECK(contains(only_error(build_model(scene_of({cube}))).where, "/prescribed"));
}

TEST_CASE("Newmark's rule, which lets them oscillate, drives no coordinates of a body that is free otherwise", "[model]") {
    scene::Scene scene = scene_of({box_body("slide", {0, 0, 0}, {0.1, 0.1, 0.1})});
    scene.integrator = scene::Integrator::newmark;
    scene::Body& body = scene.bodies[0];
    body.prescribed[2] = scene::MotionCurve{};  // held
    CHECK(check_scene(scene, true).errors.empty());
    scene::MotionCurve driven;
    driven.rate = 0.4;
    body.prescribed[0] = driven;
    const Errors errors = check_scene(scene, true).errors;
    REQUIRE(errors.size() == 1);
    CHECK(contains(errors[0].where, "/prescribed"));
    CHECK(contains(errors[0].message, "bdf2"));
    body.prescribed.fill(driven);  // its velocity is that of its places
    CHECK(check_scene(scene, true).errors.empty());
    body.prescribed.fill(std::nullopt);
    body.prescribed[0] = driven;
    scene.integrator = scene::Integrator::bdf2;
    CHECK(check_scene(scene, true).errors.empty());
}

TEST_CASE("A size or a density that is hardly meant is a warning, with its place and what to look at", "[model]") {
    const auto warnings = [](std::vector<scene::Body> bodies) { return build_model(scene_of(std::move(bodies))).value().warnings; };
    const auto told = [&](std::vector<scene::Body> bodies, const std::string& part) {
        const std::vector<std::string> all = warnings(std::move(bodies));
        return std::any_of(all.begin(), all.end(), [&](const std::string& warning) { return contains(warning, part); });
    };
    const auto box = [](const std::string& name, double size, double at) {
        return box_body(name, {at, 0, 0}, {at + size, 0.2 * size, 0.1 * size});
    };
    // A rod whose millimetres were taken for metres, alone and among others.
    CHECK(
        told({box("rod", 58, 0)}, "a.scene.json#/bodies/rod: body `rod`: its size is 58 m and its mass 3.9e+06 kg, which is hardly meant"));
    CHECK(told({box("rod", 58, 0)}, "`mesh_unit`"));
    CHECK(told({box("pin", 5e-3, -1), box("crank", 8e-3, -2), box("rod", 5.8, 0)}, "body `rod`: its size is 5.8 m"));
    CHECK(told({box("pin", 5e-3, -1), box("crank", 8e-3, -2), box("rod", 5.8, 0)}, "where others are about 8 mm"));
    CHECK(told({box("pin", 5e-6, -1), box("crank", 8e-3, -2), box("rod", 9e-3, 0)}, "body `pin`: its size is 5 um"));
    scene::Body still = box("block", 94, 0);
    still.type = BodyType::static_body;
    CHECK(told({still}, "body `block`: its size is 94 m"));
    CHECK(told({box("rod", 10, 0)}, "body `rod`: its size is 10 m"));
    CHECK(told({box("rod", 0.058e-3, 0)}, "body `rod`: its size is 58 um"));
    scene::Scene heavy = scene_of({box("rod", 0.058, 0)});
    heavy.gravity = Vector3(0, 0, -9810);
    CHECK(build_model(heavy)->warnings == std::vector<std::string>{"a.scene.json#/gravity: gravity is 9810 m/s^2, which is hardly meant; "
                                                                   "is it in mm/s^2? m/s^2 are expected, whatever the unit of lengths "
                                                                   "(9.81 on the Earth)"});
    scene::Scene unwritten = scene_of({box("rod", 58, 0)});  // of a program: it is named once
    unwritten.path.clear();
    unwritten.bodies[0].where.clear();
    CHECK(build_model(unwritten)->warnings.front().rfind("body `rod`: its size is 58 m", 0) == 0);
    // What is meant: parts of all usual sizes, and a large ground under small ones.
    CHECK(warnings({box("pin", 5e-3, -1), box("crank", 0.3, -2), box("frame", 1, 0)}).empty());
    scene::Body ground = box("ground", 9, 0);
    ground.type = BodyType::static_body;
    CHECK(warnings({ground, box("marble", 0.01, -1)}).empty());
    scene::Scene small = scene_of({box("gear", 50e-6, 0)});
    small.length_unit = 1e-6;
    CHECK(build_model(small)->warnings.empty());
    scene::Body light = box("light", 0.1, 0);
    light.density = 1.24;
    CHECK(told({light}, "a density of 1.24 kg/m^3 is hardly meant"));
    light.mass_kind = scene::MassKind::area;  // per m^2 it may be
    CHECK(warnings({light}).empty());
    scene::Body paper = box("rod", 58, 0);  // scenes of the source paper are taken as they are
    paper.mesh_policy = scene::MeshPolicy::lenient;
    CHECK(warnings({paper}).empty());
}

TEST_CASE("A contact distance that is a good part of a body is a warning", "[model]") {
    const auto warnings = [](std::optional<double> dhat) {
        scene::Scene scene = scene_of({box_body("rod", {0, 0, 0}, {0.06, 0.01, 0.01}), box_body("pin", {0.1, 0, 0}, {0.132, 0.02, 0.02})});
        scene.dhat = dhat;
        return build_model(scene).value().warnings;
    };
    const std::vector<std::string> told = warnings(5e-3);
    REQUIRE(told.size() == 1);
    CHECK(contains(told[0],
                   "a.scene.json#/contact/dhat: the contact distance is 5 mm, which is hardly meant beside `pin`, whose size is 32 mm"));
    CHECK(contains(told[0], "well below the play of the fits (if it is not given: 135 um)"));
    CHECK(warnings(1.5e-3).empty());
    CHECK(warnings(std::nullopt).empty());
}

TEST_CASE("More than a turn in each time step is a warning", "[model]") {
    scene::Scene scene = scene_of({box_body("crank", {0, 0, 0}, {0.1, 0.1, 0.1})});
    scene.timestep = 5e-3;
    scene::Body& crank = scene.bodies[0];
    const auto warnings = [&] { return build_model(scene).value().warnings; };
    crank.prescribed[5] = scene::MotionCurve{};
    crank.prescribed[5]->rate = 1e7 * M_PI / 180;
    REQUIRE(warnings().size() == 1);
    CHECK(contains(warnings()[0],
                   "body `crank`: its prescribed rate about z makes 139 turns in each time step of 0.005 s, which is hardly meant"));
    crank.prescribed[5]->rate = -2 * M_PI * 150;  // 9,000 turns per minute
    CHECK(warnings().empty());
    crank.prescribed[5].reset();
    crank.angular_velocity.x() = 2 * M_PI * 400;
    REQUIRE(warnings().size() == 1);
    CHECK(contains(warnings()[0], "its angular velocity makes 2 turns"));
}

TEST_CASE("A time step of more than a day is refused: it is in seconds", "[model]") {
    scene::Scene scene = scene_of({box_body("cube", {0, 0, 0}, {0.1, 0.1, 0.1})});
    scene.timestep = 86400;
    CHECK(build_model(scene));
    for (const double step : {86401.0, 99999999999.0}) {
        scene.timestep = step;
        const base::Error error = only_error(build_model(scene));
        CHECK(error.code == ErrorCode::out_of_range);
        CHECK(error.where == "a.scene.json#/timestep");
        CHECK(contains(error.message, "at most a day"));
    }
}

TEST_CASE("More time steps than can be counted are refused", "[model]") {
    scene::Scene scene = scene_of({box_body("cube", {0, 0, 0}, {0.1, 0.1, 0.1})});
    scene.timestep = 1e-9;
    scene.end_time = 2;
    CHECK(build_model(scene));
    scene.end_time = 3;
    const base::Error error = only_error(build_model(scene));
    CHECK(error.code == ErrorCode::out_of_range);
    CHECK(error.where == "a.scene.json#/end_time");
    CHECK(contains(error.message, "are more than 2147483647 steps: take a shorter time"));
}

TEST_CASE("Real meshes: tolerated with warnings, refused when strict", "[model]") {
    scene::Body twins = box_body("twins", {0, 0, 0}, {1, 1, 1});
    twins.mesh = tests::joined(twins.mesh, tests::box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
    CHECK(build_model(scene_of({twins})).errors().size() > 0);
    twins.mesh_policy = scene::MeshPolicy::tolerant;
    const auto model = build_model(scene_of({twins}));
    REQUIRE(model);
    REQUIRE(model->warnings.size() == 1);
    CHECK(contains(model->warnings[0], "body `twins`"));
    CHECK(contains(model->warnings[0], "triangles intersect"));
}

TEST_CASE("Names that a terminal, a table or a file of another program would take for something else are refused", "[model]") {
    for (const char* name : {"a\033[2Jb", "a\nb", "a\xff", "a\xC2\x9B"}) {
        scene::Body body = box_body("box", {0, 0, 0}, {1, 1, 1});
        body.name = name;
        const base::Errors errors = check_scene(scene_of({body}), true).errors;
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].code == base::ErrorCode::out_of_range);
        CHECK(errors[0].message.find("a name is text on one line") != std::string::npos);
        CHECK(base::name_fault(errors[0].message).empty());
    }
}

TEST_CASE("A density that is not positive is refused with body and place", "[model]") {
    for (const double density : {-1000.0, 0.0}) {
        scene::Body box = box_body("piston", {0, 0, 0}, {1, 1, 1});
        box.density = density;
        const auto error = only_error(build_model(scene_of({box})));
        CHECK(error.code == ErrorCode::out_of_range);
        CHECK(error.where == "a.scene.json#/bodies/piston/density");
        CHECK(contains(error.message, "`piston`"));
        box.type = BodyType::static_body;
        CHECK(build_model(scene_of({box})));
    }
    scene::Body box = box_body("piston", {0, 0, 0}, {1, 1, 1});
    box.density = std::numeric_limits<double>::quiet_NaN();
    CHECK(only_error(build_model(scene_of({box}))).code == ErrorCode::not_finite);
}

TEST_CASE("Every copy of a bad mesh is refused", "[model]") {
    std::vector<scene::Body> bodies;
    for (const char* name : {"a", "b"}) {
        bodies.push_back(box_body(name, {0, 0, 0}, {1, 1, 1}));
        bodies.back().mesh.triangles.pop_back();
        geometry::build_connectivity(bodies.back().mesh);
    }
    const base::Errors errors = build_model(scene_of(bodies)).errors();
    for (const std::string name : {"`a`", "`b`"})
        CHECK(std::count_if(errors.begin(), errors.end(), [&](const base::Error& e) { return contains(e.message, name); }) == 3);
}

TEST_CASE("Two bodies of one name are refused", "[model]") {
    const scene::Body cube = box_body("cube", {0, 0, 0}, {1, 1, 1});
    scene::Body again = cube;
    again.pose.position = {5, 0, 0};
    const base::Error error = only_error(build_model(scene_of({cube, again})));
    CHECK(error.code == ErrorCode::inconsistent);
    CHECK(contains(error.where, "/bodies/cube"));
    CHECK(contains(error.message, "another body is called `cube` already"));
    again.name = "other";
    CHECK(build_model(scene_of({cube, again})));
}

TEST_CASE("Copies of a part are measured once, and alike", "[model]") {
    scene::Body first = box_body("first", {0, 0, 0}, {1, 2, 3}), second = first, shell = first;
    second.name = "second";
    second.pose.position = {5, 0, 0};
    shell.name = "shell";
    shell.mass_kind = scene::MassKind::area;
    const SceneCheck check = check_scene(scene_of({first, second, shell}), true);
    CHECK(check.errors.empty());
    REQUIRE(check.measures.size() == 3);
    CHECK(check.measures[0].amount() == Approx(6));
    CHECK(check.measures[1].unit_moments == check.measures[0].unit_moments);
    CHECK(check.measures[2].amount() == Approx(22));
    CHECK((check.measures[0].centre().value() - Vector3(0.5, 1, 1.5)).norm() < 1e-14);
}

}  // namespace

}  // namespace fettle::core::model::check_scene_test
