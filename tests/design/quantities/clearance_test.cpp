// SPDX-License-Identifier: MIT
#include "design/quantities/clearance.hpp"

#include <catch2/catch.hpp>

#include "core/clearance/clearance.hpp"
#include "core/setup/build_model.hpp"
#include "design/description/constraint.hpp"
#include "tests/design/quantities/file_problem.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

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
    CHECK(inside.fault.find("`small` and `large` lies inside the other") != std::string::npos);
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

namespace {

// A pin of radius 3 mm in a slot of 10 mm, 2 mm off its middle towards `right`, 4.5 mm above its floor; it rises by 10 mm in 1 s.
constexpr const char* pin_in_slot = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.125, "end_time": 1,
  "variables": {"wall": "5mm", "offset": "2mm", "bottom": "5mm"},
  "bodies": [
    {"name": "channel", "type": "static", "shape": {
      "profiles": {"u": {"path": [[-20, 0], {"to": [20, 0], "name": "under"}, {"to": [20, 30], "name": "outside"},
        {"to": ["= wall", 30], "name": "lip"}, {"to": ["= wall", "= bottom"], "name": "right"}, {"to": ["= -wall", "= bottom"], "name": "floor"},
        {"to": ["= -wall", 30], "name": "left"}, {"to": [-20, 30], "name": "lip"}], "name": "outside"}},
      "solid": {"extrude": "u", "to": 10}}},
    {"name": "pin", "type": "kinematic", "density": 1240, "position": ["= offset", 12.5, 5], "prescribed": {"py": {"rate": 10}},
     "shape": {"part": "box", "dimensions": {"size_x": 6, "size_y": 6, "size_z": 4}}}
  ]
})";

std::string faces_design(const std::string& constraint) {
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "simulation": {"clearance_tolerance": 1e-9},
  "parameters": [{"name": "wall", "lower": 4, "upper": 8}, {"name": "offset", "lower": -3, "upper": 3, "value": 0.4},
                 {"name": "bottom", "lower": 2, "upper": 6, "value": 5}],
  "objective": [{"type": "mass", "bodies": ["pin"]}], "constraints": [{"type": "clearance", "a": "channel", "b": "pin", "minimum": 0.1)" +
           constraint + "}]}";
}

// Value [mm] and derivatives by wall, offset and bottom.
std::array<double, 4> measured_faces(const std::string& constraint) {
    const auto problem = tests::design_support::problem_of(pin_in_slot, faces_design(constraint));
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    CHECK(at.constraints[0].is_proven);
    CHECK(at.constraints[0].fault.empty());
    CHECK(at.constraints[0].lower <= at.constraints[0].upper);
    CHECK(at.constraints[0].upper - at.constraints[0].lower < 1e-8);
    return {1e3 * at.constraints[0].value, at.jacobian(0, 0), at.jacobian(0, 1), at.jacobian(0, 2)};
}

void check_same(const std::array<double, 4>& found, const std::array<double, 4>& wanted) {
    for (std::size_t k = 0; k < 4; ++k) CHECK(found[k] == Approx(wanted[k]).margin(1e-6));
}

}  // namespace

TEST_CASE("a clearance between named faces is that of these faces, whatever else is nearer") {
    // wall 5, offset 0.4, bottom 5: the pin's sides are 1.6 mm from `right`, 2.4 mm from `left`; its underside 4.5 mm from `floor`.
    check_same(measured_faces(""), {1.6, 1, -1, 0});
    check_same(measured_faces(R"(, "faces_a": ["left"])"), {2.4, 1, 1, 0});
    check_same(measured_faces(R"(, "faces_a": ["floor"])"), {4.5, 0, 0, -1});
    check_same(measured_faces(R"(, "faces_a": ["left", "right"])"), {1.6, 1, -1, 0});
    // Over the motion, up to 19.5 mm above the floor.
    check_same(measured_faces(R"(, "faces_a": ["floor"], "motion": true)"), {4.5, 0, 0, -1});
    check_same(measured_faces(R"(, "faces_a": ["floor"], "motion": true, "from": 0.5)"), {9.5, 0, 0, -1});
    // The side of the pin against the flat ends of the channel, of which it is 3 mm away.
    check_same(measured_faces(R"(, "faces_a": ["u end"])"), {std::hypot(3, 1.6), 1.6 / std::hypot(3, 1.6), -1.6 / std::hypot(3, 1.6), 0});
}

TEST_CASE("a clearance over a part of the motion is proven for the steps that are in it") {
    // The lower edge of the lip is at 30 mm; the pin's upper face comes up from 15.5 to 25.5 mm.
    const std::string lip = R"(, "faces_a": ["lip"], "motion": true)";
    const auto gap = [](double time) { return std::hypot(30 - 15.5 - 10 * time, 1.6); };
    CHECK(measured_faces(lip)[0] == Approx(gap(1)));
    CHECK(measured_faces(lip + R"(, "to": 0.5)")[0] == Approx(gap(0.5)));
    CHECK(measured_faces(lip + R"(, "to": "0.51 s")")[0] == Approx(gap(0.625)));  // the step from 0.5 to 0.625 s is in it
    CHECK(measured_faces(R"(, "motion": true, "from": 0.25, "to": 0.5)")[0] == Approx(1.6));
    CHECK(steps_of({.a = 0, .b = 1, .motion = true, .window = 1, .windows = 2, .from = 0.25, .to = 0.75}, 0.125, 8) == std::pair(4, 6));
    CHECK(steps_of({.a = 0, .b = 1, .motion = true, .from = 0.3, .to = 0.31}, 0.125, 8) == std::pair(2, 3));
    CHECK(steps_of({.a = 0, .b = 1, .motion = true, .from = 1.0}, 0.125, 8) == std::pair(7, 8));
}

TEST_CASE("faces, parts of the motion and ranges that are not there are refused with what there is") {
    const auto refusal = [](const std::string& constraint) {
        const tests::support::TemporaryFolder folder;
        folder.write("small.scene.json", pin_in_slot);
        const auto file = reading::parse_design(faces_design(constraint), folder.file("small.design.json"));
        if (!file) return file.errors().front().where + ": " + file.errors().front().message;
        const auto problem = problem::DesignProblem::create(file->design);
        return problem ? std::string() : problem.errors().front().message;
    };
    CHECK(refusal(R"(, "faces_a": ["flor"])").find("did you mean \"floor\"?") != std::string::npos);
    CHECK(refusal(R"(, "faces_a": [])").find("name a face") != std::string::npos);
    CHECK(refusal(R"(, "from": 0.5)").find("set `motion` to true") != std::string::npos);
    CHECK(refusal(R"(, "motion": true, "from": 2)").find("not within the motion") != std::string::npos);
    CHECK(refusal(R"(, "motion": true, "from": 0.5, "to": 0.25)").find("begins before it ends") != std::string::npos);
    CHECK(refusal(R"(, "motion": true, "ranges": true)").find("whatever the motion") != std::string::npos);
    CHECK(refusal(R"(, "ranges": true)").find("there is no joint") != std::string::npos);
    const core::model::Model model = cubes(0.1);
    const Errors none = Clearance({.a = 0, .b = 1, .faces_a = {"side"}}).check(model, 0);
    REQUIRE(none.size() == 1);
    CHECK(none[0].message.find("its mesh names none") != std::string::npos);
}

TEST_CASE("a clearance over the ranges of joints has the derivative of its least, by whatever moves it") {
    // An arm on a pivot that is not parallel to its sides, on it a slider; a post beside them.
    const std::string scene = R"({
      "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.01, "end_time": 0.01,
      "variables": {"arm_length": "60mm", "post_x": "40mm", "pivot_x": "2mm", "tilt": 0.1, "high": "35deg", "reach": "12mm"},
      "bodies": [
        {"name": "arm", "density": 1240, "position": ["= arm_length / 2", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": "= arm_length", "size_y": 8, "size_z": 6}}},
        {"name": "slider", "density": 1240, "position": ["= arm_length", 0, 10], "rotation": [0, 0, 10], "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 8}}},
        {"name": "post", "type": "static", "position": ["= post_x", 75, 4], "rotation": [0, 20, 17], "shape": {"part": "box", "dimensions": {"size_x": 14, "size_y": 10, "size_z": 24}}}
      ],
      "joints": [
        {"name": "pivot", "type": "revolute", "b": "arm", "point": ["= pivot_x", 1, 0], "axis": ["= tilt", 0, 1], "limits": [-30, "= high"]},
        {"name": "rail", "type": "prismatic", "a": "arm", "b": "slider", "point": ["= arm_length", 0, 10], "axis": [1, 0.2, 0], "limits": [-5, "= reach"]}
      ]
    })";
    const auto design = [](const std::string& high, const std::string& what) {
        return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "simulation": {"clearance_tolerance": 1e-9},
          "parameters": [{"name": "arm_length", "lower": 50, "upper": 70}, {"name": "post_x", "lower": 30, "upper": 50},
            {"name": "pivot_x", "lower": -5, "upper": 5}, {"name": "tilt", "lower": -0.3, "upper": 0.3, "unit": "1"},
            {"name": "high", "value": )" +
               high + R"(, "lower": 20, "upper": 140, "unit": "deg"}, {"name": "reach", "lower": 5, "upper": 20}],
          "objective": [{"type": "mass", "bodies": ["arm"]}],
          "constraints": [{"type": "clearance", "a": "slider", "b": "post", "minimum": 1, "ranges": true)" +
               what + "}]}";
    };
    for (const std::string high : {"35", "120"}) {  // at the end of the pivot's range, and within it
        const auto problem = tests::design_support::problem_of(scene, design(high, ""));
        CHECK(problem.rest_constraints() == std::vector<int>{0});
        const VectorX p = description::values_of(problem.design().parameters);
        const auto at = problem.rest_rows(p);
        REQUIRE(at);
        CAPTURE(high, at->values[0], at->jacobian);
        CHECK(at->values[0] > 0.0005);
        CHECK((at->jacobian(0, 4) != 0) == (high == "35"));
        for (Eigen::Index k = 0; k < p.size(); ++k) {
            const double h = 1e-4 * (problem.design().parameters[k].upper - problem.design().parameters[k].lower);
            VectorX above = p, below = p;
            above[k] += h;
            below[k] -= h;
            const auto one = problem.rest_rows(above), other = problem.rest_rows(below);
            REQUIRE((one && other));
            INFO(problem.design().parameters[k].name);
            CHECK(at->jacobian(0, k) == Approx((one->values[0] - other->values[0]) / (2 * h)).epsilon(1e-6).margin(1e-9));
        }
    }
}

TEST_CASE("clearance over ranges: coordinates that gears couple have derivatives, in their ratios and limits too", "[quantity]") {
    // A wheel drives an arm, and the arm a finger that turns the other way.
    const std::string scene = R"({
      "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.01, "end_time": 0.01,
      "variables": {"long": "60mm", "post_x": "45mm", "pivot_x": "2mm", "ratio": 0.6, "other": -0.8, "high": "40deg", "stop": "70 deg"},
      "bodies": [
        {"name": "wheel", "density": 1240, "position": [-60, 0, 0], "shape": {"part": "cylinder"}},
        {"name": "arm", "density": 1240, "position": ["= long / 2", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": "= long", "size_y": 8, "size_z": 6}}},
        {"name": "finger", "density": 1240, "position": [25, 80, 0], "rotation": [0, 0, -20], "shape": {"part": "box", "dimensions": {"size_x": 50, "size_y": 8, "size_z": 6}}},
        {"name": "post", "type": "static", "position": ["= post_x", -45, 0], "rotation": [0, 20, 17], "shape": {"part": "box", "dimensions": {"size_x": 14, "size_y": 10, "size_z": 24}}}
      ],
      "joints": [
        {"name": "crank", "type": "revolute", "b": "wheel", "point": [-60, 0, 0], "axis": [0, 0, 1], "limits": [-60, "= high"]},
        {"name": "pivot", "type": "revolute", "b": "arm", "point": ["= pivot_x", 1, 0], "axis": [0, 0, 1]},
        {"name": "knuckle", "type": "revolute", "b": "finger", "point": [0, 85, 0], "axis": [0, 0, 1], "limits": [-60, "= stop"]},
        {"name": "g1", "type": "gear", "of": ["crank", "pivot"], "ratio": "= ratio"},
        {"name": "g2", "type": "gear", "of": ["pivot", "knuckle"], "ratio": "= other"}
      ]
    })";
    const std::string design =
        R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "simulation": {"clearance_tolerance": 1e-9},
          "parameters": [{"name": "long", "lower": 50, "upper": 70}, {"name": "post_x", "lower": 30, "upper": 50},
            {"name": "pivot_x", "lower": -5, "upper": 5}, {"name": "ratio", "lower": 0.4, "upper": 0.8, "unit": "1"},
            {"name": "other", "lower": -1, "upper": -0.5, "unit": "1"}, {"name": "high", "lower": 10, "upper": 60, "unit": "deg"}],
          "objective": [{"type": "mass", "bodies": ["arm"]}],
          "constraints": [{"type": "clearance", "a": "arm", "b": "post", "minimum": 1, "ranges": true},
                          {"type": "clearance", "a": "arm", "b": "finger", "minimum": 0.01, "ranges": true},
                          {"type": "clearance", "a": "finger", "b": "post", "minimum": 0.01, "ranges": true}]})";
    const auto problem = tests::design_support::problem_of(scene, design);
    const VectorX p = description::values_of(problem.design().parameters);
    const auto at = problem.rest_rows(p);
    REQUIRE(at);
    CAPTURE(at->values.transpose(), at->jacobian);
    CHECK((at->values.array() > 1e-4).all());
    CHECK(at->jacobian.col(3).cwiseAbs().maxCoeff() > 1e-4);  // by the ratios
    CHECK(at->jacobian.col(4).cwiseAbs().maxCoeff() > 1e-4);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const double h = 1e-4 * (problem.design().parameters[k].upper - problem.design().parameters[k].lower);
        VectorX above = p, below = p;
        above[k] += h;
        below[k] -= h;
        const auto one = problem.rest_rows(above), other = problem.rest_rows(below);
        REQUIRE((one && other));
        for (Eigen::Index i = 0; i < at->values.size(); ++i) {
            INFO(problem.design().constraints[i].name << " by " << problem.design().parameters[k].name);
            CHECK(at->jacobian(i, k) == Approx((one->values[i] - other->values[i]) / (2 * h)).epsilon(1e-6).margin(1e-9));
        }
    }
}

}  // namespace fettle::design::quantities::clearance_test
