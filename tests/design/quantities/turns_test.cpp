// SPDX-License-Identifier: MIT
// joint_position.hpp and body_turn.hpp: what motors say, closed forms, and differences of whole simulations.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/design/quantities/file_problem.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::quantities::turns_test {

using problem::DesignEvaluation;
using problem::DesignProblem;
using tests::design_support::check_gradient;
using tests::design_support::problem_of;

constexpr double degree = std::numbers::pi / 180;

TEST_CASE("turns: a motor's joint and its body turn as the motor says, over more than one turn") {
    const DesignProblem problem = problem_of(
        R"({"fettle_scene": 1, "units": "mm", "timestep": 0.02, "end_time": 1,
            "bodies": [{"name": "wheel", "density": 1000, "shape": {"part": "cylinder"}, "rotation": [0, 0, 20]},
                       {"name": "sledge", "density": 1000, "shape": {"part": "box"}, "position": [50, 0, 0]}],
            "joints": [{"name": "axle", "type": "revolute", "b": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1]},
                       {"name": "rail", "type": "prismatic", "b": "sledge", "point": [50, 0, 0], "axis": [0, 1, 0]}],
            "motors": [{"name": "spin", "joint": "axle", "angle": {"times": [0, 1], "values": [0, 500]}},
                       {"name": "push", "joint": "rail", "travel": {"times": [0, 1], "values": [0, 30]}}]})",
        R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "far", "unit": "deg", "value": 500, "lower": 100, "upper": 900}, {"name": "out", "value": 30, "lower": 5, "upper": 50}],
            "set": {"/motors/spin/angle/values/1": "= far", "/motors/push/travel/values/1": "= out"},
            "quantities": {"a": {"type": "turn", "body": "wheel", "axis": [0, 0, 1]}, "b": {"type": "joint_position", "joint": "axle"}},
            "constraints": [{"type": "joint_position", "joint": "axle", "lower": "10 deg"},
                            {"type": "turn", "body": "wheel", "axis": [0, 0, -2], "upper": 10},
                            {"type": "joint_position", "joint": "rail", "over": "mean", "lower": 2},
                            {"type": "expression", "expression": "a / b", "lower": 0.5}]})");
    const DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
    REQUIRE(at.usable);
    CHECK(at.constraints[0].value == Approx(500 * degree));
    CHECK(at.constraints[1].value == Approx(-500 * degree));
    CHECK(at.constraints[2].value == Approx(30e-3 * 0.5));
    CHECK(at.constraints[3].value == Approx(1));
    const MatrixX expected = (MatrixX(4, 2) << 1, 0, -1, 0, 0, 0.5, 0, 0).finished();
    CHECK((at.jacobian - expected).cwiseAbs().maxCoeff() < 1e-7);
}

TEST_CASE("turns: what contact and gravity turn, against differences") {
    // A pendulum from a joint whose place is a parameter, and the small design's cube, which contact tilts.
    const DesignProblem pendulum = problem_of(
        R"({"fettle_scene": 1, "units": "mm", "timestep": 0.005, "end_time": 0.3, "gravity": [0, -9.81, 0],
            "bodies": [{"name": "rod", "density": 1000, "rotation": [0, 0, 10],
                        "shape": {"part": "box", "dimensions": {"size_x": 40, "size_y": 4, "size_z": 4}}}],
            "joints": [{"name": "axle", "type": "revolute", "b": "rod", "point": [-15, 1, 0], "axis": [0, 0, 1]}]})",
        R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "at", "value": -15, "lower": -18, "upper": -10}, {"name": "turned", "unit": "deg", "value": 10, "lower": 0, "upper": 20}],
            "set": {"/joints/axle/point/0": "= at", "/bodies/rod/rotation/2": "= turned"},
            "constraints": [{"type": "joint_position", "joint": "axle", "over": "end", "upper": 1000},
                            {"type": "joint_position", "joint": "axle", "over": "least", "upper": 1000},
                            {"type": "turn", "body": "rod", "axis": [0, 0, 1], "over": "sum", "upper": 1000000},
                            {"type": "turn", "body": "rod", "axis": [0, 1, 3], "over": "end", "upper": 1000000}]})");
    check_gradient(pendulum, 1e-6);
    std::string design = tests::design_support::small_design;
    const std::size_t from = design.find("\"constraints\""), to = design.find("\"optimiser\"");
    design.replace(from, to - from, R"("constraints": [{"type": "turn", "body": "cube", "axis": [0, 1, 0], "upper": 1000},
        {"type": "turn", "body": "cube", "axis": [1, 1, 0], "over": "largest", "upper": 1000},
        {"type": "turn", "body": "table", "axis": [0, 1, 0], "upper": 1000}], )");
    const DesignProblem cube = problem_of(tests::design_support::small_scene, design);
    check_gradient(cube, 1e-5);
    const DesignEvaluation at = cube.evaluate(description::values_of(cube.design().parameters));
    CHECK(at.constraints[2].value == Approx(4 * degree));
    CHECK(at.jacobian(2, 4) == Approx(0.1));
}

}  // namespace fettle::design::quantities::turns_test
