// SPDX-License-Identifier: MIT
#include "design/quantities/step_expression.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "design/quantities/body_turn.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/quantities/marker_position.hpp"
#include "tests/design/quantities/file_problem.hpp"
#include "tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::step_expression_test {

namespace {

using tests::design_support::check_gradient;
using tests::design_support::check_pose_gradient;
using tests::design_support::problem_of;

constexpr double degree = std::numbers::pi / 180;

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

std::vector<NamedQuantity> parts() {
    const auto place = [](const Vector3& axis, const Reduction& taken) {
        return std::make_shared<MarkerPosition>(MarkerPosition::Of{0, Vector3(0.4, 0.3, 0.1), axis}, taken);
    };
    return {{"x", place(x_axis, {})},
            {"y", place(y_axis, {})},
            {"speed", place(x_axis, {Over::end, 1})},
            {"most", place(y_axis, Over::peak)},
            {"turn", std::make_shared<BodyTurn>(0, z_axis, Reduction())}};
}

std::shared_ptr<const StepExpression> made(const std::string& text, const Reduction& taken) {
    const auto expression = StepExpression::parse(text, parts(), taken);
    for (const Error& error : expression.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(expression);
    return *expression;
}

}  // namespace

TEST_CASE("step_expression: derivatives in all poses") {
    for (const std::string text : {"x * y / 1 m", "hypot(x - 0.1 m, 2 * y)", "y / most * 1 m", "x + 0.3 m/s * time + speed * 0.2 s",
                                   "x * cos(turn)", "if(x < 0.1 m, x, 2 * x - 0.1 m)"})
        for (const Over over : {Over::end, Over::mean, Over::peak, Over::rms, Over::integral})
            for (const int derivative : {0, 1}) {
                CAPTURE(text, static_cast<int>(over), derivative);
                Reduction taken(over, derivative);
                taken.from = 0.35;
                if (over == Over::integral && derivative == 0) taken.over = Over::mean;  // of metres and seconds there is no unit
                check_pose_gradient(*made(text, taken), 1e-6);
            }
}

TEST_CASE("step_expression: plain parts stand for their steps, others for their number") {
    const core::model::Model model = tests::design_support::cube_model();
    const core::stepper::Trajectory trajectory = tests::design_support::moving(14);
    const description::Simulated simulated{model, trajectory};
    const auto steps = [&](const std::string& text) { return made(text, Over::end)->numbers(simulated); };
    const std::vector<double> x = steps("x"), most = steps("most"), time = steps("time"), both = steps("2 * x - most");
    REQUIRE(x.size() == 15);
    const double peak = parts()[3].quantity->value(simulated).value;
    for (int t = 0; t <= 14; ++t) {
        CHECK(time[t] == Approx(0.1 * t).margin(1e-15));
        CHECK(most[t] == peak);
        CHECK(both[t] == Approx(2 * x[t] - peak));
    }
    CHECK(made("x * y", Over::peak)->dimension() == Dimension::area);
    CHECK(made("x * y", {Over::peak, 1})->instant_dimension() == Dimension::area);
}

TEST_CASE("step_expression: what cannot stand in one is refused by name") {
    const auto message = [](const std::string& text, const NamedQuantity& part) {
        const auto found = StepExpression::parse(text, {part}, Over::peak);
        return found ? std::string() : found.errors()[0].message;
    };
    const auto turn = std::make_shared<BodyTurn>(0, z_axis, Reduction());
    CHECK(message("2 * turn", {"turn", turn}).empty());
    CHECK(message("gap / 2", {"gap", std::make_shared<Clearance>(ClearanceRange{0, 1})}).find("cannot stand") != std::string::npos);
    CHECK(message("turn / 2", {"turn", std::make_shared<InScenario>(turn, 1)}).find("cannot stand") != std::string::npos);
    CHECK(message("turn ^ 3", {"turn", turn}).find("no unit") != std::string::npos);
    CHECK(message("turn + time", {"turn", turn}).find("time") != std::string::npos);
}

namespace {

const char* gears = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 1,
    "bodies": [{"name": "input", "density": 1000, "shape": {"part": "cylinder"}},
               {"name": "output", "density": 1000, "shape": {"part": "cylinder"}, "position": [50, 0, 0]},
               {"name": "sledge", "density": 1000, "shape": {"part": "box"}, "position": [0, 90, 0]}],
    "joints": [{"name": "a", "type": "revolute", "b": "input", "point": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "b", "type": "revolute", "b": "output", "point": [50, 0, 0], "axis": [0, 0, 1]},
               {"name": "rail", "type": "prismatic", "b": "sledge", "point": [0, 90, 0], "axis": [0, 1, 0]}],
    "motors": [{"name": "one", "joint": "a", "angle": {"times": [0, 1], "values": [0, 90]}},
               {"name": "two", "joint": "b", "angle": {"times": [0, 0.5, 1], "values": [0, 100, 180]}},
               {"name": "push", "joint": "rail", "travel": {"times": [0, 1], "values": [0, 30]}}]})";

}  // namespace

TEST_CASE("step_expression: transmission error, deviation from a law and dwell have their closed forms") {
    const auto problem = problem_of(gears, R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "middle", "unit": "deg", "value": 100, "lower": 80, "upper": 120}, {"name": "out", "value": 30, "lower": 5, "upper": 50},
                       {"name": "ratio", "unit": "1", "value": 2, "lower": 1, "upper": 3}],
        "set": {"/motors/two/angle/values/1": "= middle", "/motors/push/travel/values/1": "= out"},
        "quantities": {"turn_a": {"type": "turn", "body": "input", "axis": [0, 0, 1]}, "turn_b": {"type": "joint_position", "joint": "b"},
                       "lift": {"type": "joint_position", "joint": "rail"}, "whole_lift": {"type": "joint_position", "joint": "rail", "over": "largest"}},
        "constraints": [{"type": "expression", "expression": "turn_b - ratio * turn_a", "over": "peak", "upper": "5 deg"},
                        {"type": "expression", "expression": "lift - 40 mm/s * time", "over": "least", "upper": 100},
                        {"type": "expression", "expression": "lift - whole_lift * time / 1 s", "over": "rms", "upper": 100},
                        {"type": "expression", "expression": "turn_b - ratio * turn_a", "at": 0.25, "upper": 100},
                        {"type": "expression", "expression": "lift - 20 mm", "over": "peak", "from": 0.6, "to": 0.8, "upper": 100},
                        {"type": "expression", "expression": "turn_b / 1 s", "over": "integral", "to": 0.5, "upper": 100}]})");
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const auto value = [&](int k) { return at.constraints[k].value; };
    // The error is 20 deg t up to 0.5 s, then 10 deg - 20 deg (t - 0.5 s): a kink on a step.
    CHECK(value(0) == Approx(10 * degree).epsilon(1e-6));
    CHECK(value(1) == Approx(-10e-3).epsilon(1e-6));
    CHECK(value(2) == Approx(0).margin(1e-8));
    CHECK(value(3) == Approx(5 * degree).epsilon(1e-6));
    CHECK(value(4) == Approx(4e-3).epsilon(1e-6));
    CHECK(value(5) == Approx(100 * degree * 0.25).epsilon(1e-6));
    CHECK(at.jacobian(3, 0) == Approx(0.5).epsilon(1e-6));
    CHECK(at.jacobian(3, 2) == Approx(-22.5 * degree).epsilon(1e-6));
    CHECK(at.jacobian(1, 1) == Approx(1).epsilon(1e-6));
    CHECK(at.jacobian(4, 1) == Approx(0.8).epsilon(1e-6));
    CHECK(problem.design().constraints[0].bounds.upper == Approx(5 * degree));
}

TEST_CASE("step_expression: a law's table, whose values may follow from parameters") {
    const auto problem = problem_of(gears, R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "height", "value": 24, "lower": 10, "upper": 50}, {"name": "out", "value": 30, "lower": 5, "upper": 50}],
        "set": {"/motors/push/travel/values/1": "= out"},
        "quantities": {"lift": {"type": "joint_position", "joint": "rail"},
                       "line": {"type": "law", "of": "length", "times": [0, 1], "values": ["0 mm", "= height"]},
                       "curved": {"type": "law", "of": "length", "times": [0, 0.4, 1], "values": [0, "= height / 2", "= out"], "profile": "cubic"},
                       "slope": {"type": "law", "of": "angle", "times": [0, 1], "values": [0, 90], "derivative": 1}},
        "constraints": [{"type": "expression", "expression": "lift - line", "over": "peak", "upper": 100},
                        {"type": "expression", "expression": "lift - line", "over": "rms", "upper": 100},
                        {"type": "expression", "expression": "lift - curved", "over": "rms", "from": 0.1, "upper": 100},
                        {"type": "expression", "expression": "slope", "at": 0.3, "upper": 100},
                        {"type": "law", "of": "length", "times": [0, 1], "values": [0, "= height"], "over": "mean", "upper": 100}]})");
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    CHECK(at.constraints[0].value == Approx(6e-3).epsilon(1e-6));
    CHECK(at.constraints[1].value == Approx(6e-3 * std::sqrt(100 * 201 / 6.0) / 100).epsilon(1e-6));
    CHECK(at.constraints[3].value == Approx(90 * degree));
    CHECK(at.constraints[4].value == Approx(24e-3 * 0.5));
    CHECK(at.jacobian(0, 0) == Approx(-1));
    CHECK(at.jacobian(0, 1) == Approx(1).epsilon(1e-6));
    CHECK(at.jacobian(4, 0) == Approx(0.5));
    check_gradient(problem, 1e-6);
}

TEST_CASE("step_expression: a law along another quantity, and a stroke in a part of the motion") {
    const auto problem = problem_of(gears, R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "height", "value": 24, "lower": 10, "upper": 50}, {"name": "out", "value": 30, "lower": 5, "upper": 50},
                       {"name": "swing", "unit": "deg", "value": 90, "lower": 45, "upper": 120}],
        "set": {"/motors/push/travel/values/1": "= out", "/motors/one/angle/values/1": "= swing"},
        "quantities": {"lift": {"type": "joint_position", "joint": "rail"}, "turn": {"type": "turn", "body": "input", "axis": [0, 0, 1]},
                       "cam": {"type": "law", "of": "length", "along": "turn", "positions": [0, "45 deg", 90], "values": [0, "= height", 0], "profile": "cubic"}},
        "constraints": [{"type": "expression", "expression": "lift - cam", "at": 0.25, "upper": 100},
                        {"type": "expression", "expression": "lift - cam", "over": "rms", "upper": 100},
                        {"type": "stroke", "body": "sledge", "axis": [0, 1, 0], "from": 0.25, "to": 0.75, "upper": 100},
                        {"type": "stroke", "body": "sledge", "axis": [0, 1, 0], "upper": 100}]})");
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    // At a quarter of the swing, half-way to the law's middle, it is at half of its height, and rises by 1.5 times the mean.
    CHECK(at.constraints[0].value == Approx(7.5e-3 - 12e-3).epsilon(1e-6));
    CHECK(at.jacobian(0, 0) == Approx(-0.5).epsilon(1e-6));
    CHECK(at.jacobian(0, 1) == Approx(0.25).epsilon(1e-6));
    CHECK(at.jacobian(0, 2) == Approx(-1.5 * 24e-3 / (45 * degree) * 0.25).epsilon(1e-6));
    CHECK(at.constraints[2].value == Approx(15e-3).epsilon(1e-6));
    CHECK(at.jacobian(2, 1) == Approx(0.5).epsilon(1e-6));
    CHECK(at.constraints[3].value == Approx(30e-3).epsilon(1e-6));
    check_gradient(problem, 1e-5);
}

TEST_CASE("step_expression: a law along what is not there, or not at each step, is refused") {
    const tests::support::TemporaryFolder folder;
    folder.write("small.scene.json", gears);
    const auto refusal = [&](const std::string& law) {
        const auto file = reading::parse_design(R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "out", "value": 30, "lower": 5, "upper": 50}], "set": {"/motors/push/travel/values/1": "= out"},
            "quantities": {"peak": {"type": "turn", "body": "input", "axis": [0, 0, 1], "over": "peak"},
                           "turn": {"type": "turn", "body": "input", "axis": [0, 0, 1]},
                           "stroke": {"type": "stroke", "body": "sledge", "axis": [0, 1, 0]},
                           "law": {"type": "law", "of": "length", "values": [0, 1], )" +
                                                    law + R"(}},
            "objective": [{"type": "expression", "expression": "law", "over": "rms"}]})",
                                                folder.file("small.design.json"));
        if (!file) return file.errors().front().message;
        const auto problem = design::problem::DesignProblem::create(file->design);
        return problem ? std::string() : problem.errors().front().message;
    };
    CHECK(refusal(R"("along": "turn", "positions": [0, 90])").empty());
    CHECK(refusal(R"("along": "tern", "positions": [0, 90])").find("did you mean \"turn\"?") != std::string::npos);
    CHECK(refusal(R"("along": "stroke", "positions": [0, 90])").find("is no quantity that each instant has a number of") !=
          std::string::npos);
    CHECK(refusal(R"("along": "peak", "positions": [0, 90])").find("leave out what is taken") != std::string::npos);
    CHECK(refusal(R"("along": "turn", "times": [0, 1], "positions": [0, 90])").find("in place of `times`") != std::string::npos);
    CHECK(refusal(R"("times": [0, 1], "positions": [0, 90])").find("are of a law that is `along`") != std::string::npos);
}

TEST_CASE("step_expression: a parameter that is called `time` is no fault where it is not named") {
    const tests::support::TemporaryFolder folder;
    folder.write("small.scene.json", gears);
    const auto read = [&](const std::string& expression) {
        return reading::parse_design(R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "time", "value": 30, "lower": 5, "upper": 50}], "set": {"/motors/push/travel/values/1": "= time"},
            "quantities": {"lift": {"type": "joint_position", "joint": "rail"}},
            "constraints": [{"type": "expression", "expression": ")" +
                                         expression + R"(", "over": "peak", "upper": 100}]})",
                                     folder.file("small.design.json"));
    };
    CHECK(read("2 * lift"));
    const auto found = read("lift - time * 1 mm/s");
    REQUIRE(found.errors().size() == 1);
    CHECK(found.errors()[0].message.find("`time`") != std::string::npos);
}

// A motor that winds a spring up by theta does the work k theta^2 / 2: in quasi-statics nothing else takes any.
TEST_CASE("step_expression: the work of a motor against a spring") {
    const auto problem = problem_of(
        R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 1, "integrator": "quasi_static",
            "bodies": [{"name": "lever", "density": 1000, "shape": {"part": "cylinder"}}],
            "joints": [{"name": "axle", "type": "revolute", "b": "lever", "point": [0, 0, 0], "axis": [0, 0, 1], "stiffness": "0.2 N m/rad"}],
            "motors": [{"name": "spin", "joint": "axle", "angle": {"times": [0, 1], "values": [0, 90]}}]})",
        R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "far", "unit": "deg", "value": 90, "lower": 50, "upper": 120},
                           {"name": "k", "unit": "N m/rad", "value": 0.2, "lower": 0.1, "upper": 0.4}],
            "set": {"/motors/spin/angle/values/1": "= far", "/joints/axle/stiffness": "= k"},
            "quantities": {"torque": {"type": "motor_effort", "motor": "spin"}, "speed": {"type": "joint_position", "joint": "axle", "derivative": 1}},
            "constraints": [{"type": "expression", "expression": "torque * speed / 1 rad", "over": "integral", "upper": "400 mJ"},
                            {"type": "expression", "expression": "torque * speed / 1 rad", "over": "largest", "upper": "1 W"},
                            {"type": "motor_effort", "motor": "spin", "over": "integral", "upper": "1 N m s"},
                            {"type": "energy", "of": "spring", "derivative": 1, "at": 0.5, "upper": "1 W"}]})");
    const double k = 0.2, theta = 90 * degree, h = 0.01;
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const auto value = [&](int i) { return at.constraints[i].value; };
    CHECK(value(0) == Approx(k * theta * theta * (0.5 + h * h / 2)).epsilon(1e-4));
    CHECK(value(1) == Approx(k * theta * theta).epsilon(1e-4));
    CHECK(value(2) == Approx(k * theta * (0.5 + h * h / 2)).epsilon(1e-4));
    CHECK(value(3) == Approx(k * theta * theta / 2).epsilon(1e-4));
    CHECK(at.jacobian(0, 0) == Approx(k * theta).epsilon(1e-3));
    CHECK(problem.design().constraints[0].quantity->dimension() == Dimension::energy);
    check_gradient(problem, 1e-5);
}

namespace {

std::string pendulum(const std::string& integrator) {
    return R"({"fettle_scene": 1, "units": "mm", "timestep": 0.005, "end_time": 0.3, "gravity": [0, -9.81, 0],
        "bodies": [{"name": "rod", "density": 1000, "rotation": [0, 0, 10],
                    "shape": {"part": "box", "dimensions": {"size_x": 40, "size_y": 4, "size_z": 4}}}],
        "joints": [{"name": "axle", "type": "revolute", "b": "rod", "point": [-15, 1, 0], "axis": [0, 0, 1]}],
        "integrator": ")" +
           integrator + "\"}";
}

const char* of_the_pendulum = R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
    "parameters": [{"name": "pivot", "value": -15, "lower": -18, "upper": -10}, {"name": "turned", "unit": "deg", "value": 10, "lower": 0, "upper": 20}],
    "set": {"/joints/axle/point/0": "= pivot", "/bodies/rod/rotation/2": "= turned"},
    "quantities": {"angle": {"type": "joint_position", "joint": "axle"}, "whirl": {"type": "joint_position", "joint": "axle", "derivative": 2},
                   "load": {"type": "joint_force", "joint": "axle", "axis": [0, 1, 0]},
                   "height": {"type": "marker_position", "body": "rod", "point": [20, 0, 0], "axis": [0, 1, 0]},
                   "fastest": {"type": "marker_speed", "body": "rod", "point": [20, 0, 0], "over": "largest"}},
    "constraints": [{"type": "expression", "expression": "load / 1 N + height / (pivot + 20)", "over": "mean", "from": 0.05, "to": 0.2, "upper": 1e6},
                    {"type": "expression", "expression": "whirl / 1 rad/s^2 + cos(angle)", "over": "peak", "from": 0.02, "upper": 1e6},
                    {"type": "expression", "expression": "height / (fastest * 1 s)", "over": "rms", "upper": 1e6},
                    {"type": "joint_force", "joint": "axle", "over": "integral", "from": 0.033, "to": 0.127, "upper": 1e6},
                    {"type": "joint_position", "joint": "axle", "derivative": 2, "over": "largest", "to": 0.25, "upper": 1e6},
                    {"type": "marker_speed", "body": "rod", "point": [20, 0, 0], "derivative": 1, "over": "largest", "from": 0.02, "upper": 1e6},
                    {"type": "marker_position", "body": "rod", "point": [20, 0, 0], "derivative": 2, "at": 0.1234, "upper": 1e6}]})json";

}  // namespace

// What is asked follows from every pose before.
TEST_CASE("step_expression: derivatives against differences of whole simulations") {
    for (const std::string integrator : {"implicit_euler", "bdf2"}) {
        CAPTURE(integrator);
        check_gradient(problem_of(pendulum(integrator), of_the_pendulum), 1e-5);
    }
}

}  // namespace fettle::design::quantities::step_expression_test
