// SPDX-License-Identifier: MIT
#include "design/quantities/marker_position.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/design/quantities/file_problem.hpp"
#include "tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::marker_position_test {

using tests::design_support::check_gradient;
using tests::design_support::check_pose_gradient;
using tests::design_support::problem_of;

TEST_CASE("marker_position: derivatives in all poses, of places, velocities and accelerations") {
    const Vector3 point(0.4, 0.3, 0.1), axis = Vector3(1, 2, -1).normalized();
    for (const int derivative : {0, 1, 2})
        for (const Over over : {Over::end, Over::mean, Over::largest, Over::peak, Over::rms, Over::integral})
            for (const Vector3& along : {axis, Vector3(Vector3::Zero())}) {
                CAPTURE(derivative, static_cast<int>(over), along.norm());
                Reduction taken(over, derivative);
                taken.from = 0.25;
                taken.to = 1.1;
                check_pose_gradient(MarkerPosition({0, point, along, Vector3(0.2, 0, -0.1)}, taken), derivative == 2 ? 1e-6 : 1e-8);
            }
}

// A point on a wheel that a motor turns: x = r cos(w t), so that differences of steps have x'' = -k x, k = 2 (1 - cos(w h)) / h^2.
TEST_CASE("marker_position: a point on a turning wheel") {
    const auto problem = problem_of(
        R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 1,
            "bodies": [{"name": "wheel", "density": 1000, "shape": {"part": "cylinder"}}],
            "joints": [{"name": "axle", "type": "revolute", "b": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1]}],
            "motors": [{"name": "spin", "joint": "axle", "angle": {"times": [0, 1], "values": [0, 540]}}]})",
        R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "far", "unit": "deg", "value": 540, "lower": 400, "upper": 600}],
            "set": {"/motors/spin/angle/values/1": "= far"},
            "constraints": [
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "derivative": 2, "over": "peak", "upper": "10 m/s^2"},
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "axis": [1, 0, 0], "derivative": 2, "at": "0.5 s", "upper": 10},
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "derivative": 1, "over": "mean", "from": 0.1, "to": 0.9, "upper": 1000},
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "axis": [0, 1, 0], "at": 0.5, "upper": 1000},
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "origin": [50, 0, 0], "over": "largest", "upper": 1000},
                {"type": "marker_position", "body": "wheel", "point": [30, 0, 0], "axis": [0, 1, 0], "over": "least", "from": 0, "to": 0.25, "upper": 99},
                {"type": "joint_position", "joint": "axle", "derivative": 1, "over": "rms", "upper": "1000 rpm"},
                {"type": "joint_position", "joint": "axle", "derivative": 2, "over": "peak", "upper": 1000},
                {"type": "turn", "body": "wheel", "axis": [0, 0, 1], "derivative": 1, "over": "end", "upper": 1000}]})");
    const double w = 3 * std::numbers::pi, h = 0.01, r = 0.03;
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const auto value = [&](int k) { return at.constraints[k].value; };
    const double k = 2 * (1 - std::cos(w * h)) / (h * h);
    CHECK(value(0) == Approx(k * r).epsilon(1e-6));
    CHECK(k == Approx(w * w).epsilon(1e-3));
    CHECK(value(1) == Approx(-k * r * std::cos(w / 2)).margin(1e-6));
    CHECK(value(2) == Approx(r * std::sin(w * h) / h).epsilon(1e-6));
    CHECK(value(3) == Approx(r * std::sin(w / 2)).epsilon(1e-6));
    CHECK(value(4) == Approx(0.08).epsilon(1e-4));
    CHECK(value(5) == Approx(0).margin(1e-9));  // at the start
    CHECK(value(6) == Approx(w).epsilon(1e-6));
    CHECK(value(7) == Approx(0).margin(1e-3));
    CHECK(value(8) == Approx(w).epsilon(1e-6));
    CHECK(at.jacobian(6, 0) == Approx(1).epsilon(1e-6));
    CHECK(at.jacobian(0, 0) == Approx(2 * std::sin(w * h) / h * r).epsilon(1e-4));
    const auto dimension = [&](int k) { return problem.design().constraints[k].quantity->dimension(); };
    CHECK(dimension(0) == Dimension::acceleration);
    CHECK(dimension(2) == Dimension::speed);
    CHECK(dimension(7) == Dimension::angular_acceleration);
    CHECK(problem.design().constraints[6].bounds.upper == Approx(1000 * std::numbers::pi / 30));
    CHECK(problem.design().constraints[7].bounds.upper == Approx(1000 * std::numbers::pi / 180));
}

TEST_CASE("marker_position: the derivative of a magnitude that is not its vector's is refused") {
    const core::model::Model model = tests::design_support::cube_model();
    CHECK(MarkerPosition({0, Vector3::Zero()}, Reduction(Over::peak, 2)).check(model, 9).empty());
    CHECK(MarkerPosition({3, Vector3::Zero()}, Over::peak).check(model, 9).size() == 1);
}

}  // namespace fettle::design::quantities::marker_position_test
