// SPDX-License-Identifier: MIT
// Joints, springs, dampers, motors and loads of scene files: as they are read, and refused.
#include "core/scene_files/mechanism_reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "core/scene/curve.hpp"
#include "tests/core/scene_files/scene_workshop.hpp"

namespace fettle::core::scene_files::mechanism_reader_test {

namespace {

using base::ErrorCode;
using namespace test_support;
constexpr double degree = std::numbers::pi / 180;

json two_boxes() {
    return json::parse(R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "arm", "mesh": "near.obj", "density": 1240, "position": [100, 0, 0], "rotation": [0, 0, 90]},
        {"name": "block", "mesh": "near.obj", "density": 1240, "position": [0, 50, 0]}],
      "joints": [
        {"name": "hinge", "type": "revolute", "b": "arm", "point": [100, 10, 0], "axis": [0, 0, 2], "limits": [-90, 45],
         "stiffness": 2, "rest": 30, "damping": 0.1, "friction": 0.02},
        {"name": "slide", "type": "prismatic", "a": "arm", "b": "block", "point_a": [1, 2, 3], "point_b": ["1cm", 0, 0], "axis": [1, 0, 0],
         "limits": ["-1cm", 5], "stiffness": 100, "preload": 3, "collide": true},
        {"name": "thread", "type": "screw", "b": "block", "point_b": [0, 0, 0], "axis_b": [0, 1, 0], "pitch": 1.5},
        {"name": "wheels", "type": "gear", "of": ["hinge", "thread"], "teeth": [20, -50]},
        {"name": "pinion", "type": "rack", "of": ["hinge", "slide"], "radius": 12}],
      "springs": [{"name": "s", "a": "arm", "b": "block", "point_a": [0, 0, 0], "point_b": [0, 0, 1], "stiffness": 50, "rest": 40},
                  {"name": "t", "joint": "hinge", "stiffness": 1, "rest": 10}],
      "dampers": [{"name": "d", "joint": "slide", "damping": 7}],
      "motors": [{"name": "m", "joint": "hinge", "angle": {"times": [0, 1, 3], "values": [0, 90, 45], "profile": "cubic", "rate": 10}},
                 {"name": "n", "joint": "slide", "speed": 20}, {"name": "o", "joint": "thread", "torque": 0.5}],
      "loads": [{"name": "l", "body": "arm", "point": [1, 0, 0], "force": [1, 2, 3]}]})");
}

json with_value(const std::string& pointer, const json& value) {
    json scene = two_boxes();
    scene[json::json_pointer(pointer)] = value;
    return scene;
}

}  // namespace

TEST_CASE("a mechanism is read in SI, each end in its body's frame", "[mechanism]") {
    const Workshop shop;
    const auto scene = shop.read(two_boxes());
    REQUIRE(scene.errors().empty());
    const scene::Mechanism& m = scene->mechanism;
    REQUIRE(m.joints.size() == 5);
    const scene::Joint& hinge = m.joints[0];
    CHECK(hinge.kind == scene::JointKind::revolute);
    CHECK(hinge.a.body.empty());
    CHECK(hinge.a.point.isApprox(Vector3(0.1, 0.01, 0)));
    CHECK(hinge.b.body == "arm");
    CHECK((hinge.b.point - Vector3(0.01, 0, 0)).norm() < 1e-15);  // (0, 10, 0) turned back by 90 degrees about z
    CHECK(hinge.forces.limits.value()[0] == Approx(-90 * degree));
    CHECK(hinge.forces.rest.value() == Approx(30 * degree));
    CHECK(hinge.forces.friction == 0.02);
    CHECK(!hinge.collide);
    const scene::Joint& slide = m.joints[1];
    CHECK(slide.a.point.isApprox(Vector3(0.001, 0.002, 0.003)));
    CHECK(slide.b.point.isApprox(Vector3(0.01, 0, 0)));
    CHECK(slide.a.axis.isApprox(Vector3(0, -1, 0)));  // of the world's x in the turned arm
    CHECK(slide.forces.limits.value()[0] == Approx(-0.01));
    CHECK(slide.forces.limits.value()[1] == Approx(0.005));
    CHECK(slide.forces.preload == 3);
    CHECK(slide.collide);
    CHECK(m.joints[2].pitch == Approx(0.0015));
    CHECK(m.joints[2].a.point.isApprox(Vector3(0, 0.05, 0)));  // where the block's is
    CHECK(m.joints[3].ratio == Approx(0.4));
    CHECK(m.joints[4].ratio == Approx(0.012));
    REQUIRE(m.springs.size() == 3);
    CHECK(m.springs[0].forces.rest.value() == Approx(0.04));
    CHECK(m.springs[1].forces.rest.value() == Approx(10 * degree));
    CHECK(m.springs[2].forces.damping == 7);
    REQUIRE(m.motors.size() == 3);
    CHECK(m.motors[0].curve.kind == scene::CurveKind::cubic);
    CHECK(scene::curve_value(m.motors[0].curve, 1) == Approx(100 * degree));
    CHECK(m.motors[1].curve.rate == Approx(0.02));
    CHECK(m.motors[2].kind == scene::MotorKind::effort);
    CHECK(m.motors[2].curve.values.at(0) == 0.5);
    CHECK(m.loads.at(0).force == Vector3(1, 2, 3));
    CHECK(m.loads.at(0).point.isApprox(Vector3(0.001, 0, 0)));
}

TEST_CASE("faults of mechanisms are told with their places", "[mechanism]") {
    const Workshop shop;
    struct Wrong {
        json scene;
        ErrorCode code;
        std::string where, message;
    };
    const std::vector<Wrong> faults{
        {with_value("/joints/0/tpye", 1), ErrorCode::unknown_key, "#/joints/0", "type"},
        {with_value("/joints/0/type", "revolut"), ErrorCode::out_of_range, "#/joints/0/type", "revolute"},
        {with_value("/joints/0/b", "amr"), ErrorCode::out_of_range, "#/joints/0/b", "arm"},
        {with_value("/joints/1/b", "arm"), ErrorCode::inconsistent, "#/joints/1/b", "same body"},
        {with_value("/joints/0/axis", {0, 0, 0}), ErrorCode::out_of_range, "#/joints/0/axis", "length greater than 0"},
        {with_value("/joints/0/point_a", {0, 0, 0}), ErrorCode::inconsistent, "#/joints/0", "either `point`"},
        {with_value("/joints/0/limits", {45, -90}), ErrorCode::out_of_range, "#/joints/0/limits", "less than"},
        {with_value("/joints/0", {{"name", "ball"}, {"type", "ball"}, {"b", "arm"}, {"point", {0, 0, 0}}, {"axis", {0, 0, 1}}}),
         ErrorCode::inconsistent, "#/joints/0/axis", "`swing`"},
        {with_value("/joints/0", {{"name", "ball"}, {"type", "ball"}, {"b", "arm"}, {"point", {0, 0, 0}}, {"swing", 30}}),
         ErrorCode::missing_key, "#/joints/0", "`axis`"},
        {with_value("/joints/0",
                    {{"name", "ball"}, {"type", "ball"}, {"b", "arm"}, {"point", {0, 0, 0}}, {"axis", {0, 0, 1}}, {"swing", 180}}),
         ErrorCode::out_of_range, "#/joints/0/swing", "less than 180 degrees"},
        {with_value("/joints/0/swing", 30), ErrorCode::unknown_key, "#/joints/0", "swing"},
        {with_value("/joints/1/name", "hinge"), ErrorCode::inconsistent, "#/joints/1/name", "already"},
        {with_value("/joints/3/of", {"hinge", "thraed"}), ErrorCode::out_of_range, "#/joints/3/of/1", "thread"},
        {with_value("/joints/3/teeth", {20, 0}), ErrorCode::out_of_range, "#/joints/3/teeth", "not 0"},
        {with_value("/springs/0/preload", 3), ErrorCode::inconsistent, "#/springs/0/preload", "either `rest` or `preload`"},
        {with_value("/motors/1/angle", 3), ErrorCode::inconsistent, "#/motors/1", "`travel`"},
        {with_value("/motors/0/angle/times", {0, 3, 1}), ErrorCode::out_of_range, "#/motors/0/angle/times/2", "increase"},
        {with_value("/motors/0/angle/profile", "control_points"), ErrorCode::inconsistent, "#/motors/0/angle", "at least 4"},
        {with_value("/loads/0/body", "box"), ErrorCode::out_of_range, "#/loads/0/body", ""},
    };
    for (const Wrong& wrong : faults) {
        const auto result = shop.read(wrong.scene);
        CAPTURE(wrong.where, wrong.message);
        const bool found = std::any_of(result.errors().begin(), result.errors().end(), [&](const base::Error& e) {
            UNSCOPED_INFO(e.where << ": " << e.message);
            return e.code == wrong.code && contains(e.where, wrong.where) && contains(e.message, wrong.message);
        });
        CHECK(found);
    }
}

TEST_CASE("curves run through their entries, smoothly where they say so", "[mechanism]") {
    scene::Curve curve;
    curve.times = {1, 2, 4};
    curve.values = {3, 5, 4};
    for (const scene::CurveKind kind : {scene::CurveKind::linear, scene::CurveKind::cubic, scene::CurveKind::trapezoid}) {
        curve.kind = kind;
        CAPTURE(static_cast<int>(kind));
        for (std::size_t k = 0; k < 3; ++k) CHECK(scene::curve_value(curve, curve.times[k]) == Approx(curve.values[k]).epsilon(1e-14));
        CHECK(scene::curve_value(curve, 0) == 3);
        CHECK(scene::curve_value(curve, 9) == 4);
        const double h = 1e-6;
        for (const double t : {1.0, 1.4, 2.0, 2.7, 4.0}) {
            const double before = (scene::curve_value(curve, t) - scene::curve_value(curve, t - h)) / h,
                         after = (scene::curve_value(curve, t + h) - scene::curve_value(curve, t)) / h;
            if (kind != scene::CurveKind::linear) CHECK(std::abs(before - after) < 1e-4);
        }
    }
    curve.kind = scene::CurveKind::trapezoid;
    CHECK(scene::curve_value(curve, 1.5) == Approx(4));
    CHECK((scene::curve_value(curve, 1.51) - scene::curve_value(curve, 1.49)) / 0.02 == Approx(3));  // 1.5 times the mean speed
    // A cubic B-spline's weights at the middle of 5 control points: knots 0 0 0 0 1 2 2 2 2.
    curve.kind = scene::CurveKind::control_points;
    curve.times = {0, 2};
    curve.values = {0, 1, 4, 2, 7};
    CHECK(scene::curve_value(curve, 0) == Approx(0).margin(1e-15));
    CHECK(scene::curve_value(curve, 2) == Approx(7));
    CHECK(scene::curve_value(curve, 1) == Approx(0.25 * 1 + 0.5 * 4 + 0.25 * 2));
    for (const double t : {0.0, 0.3, 1.0, 1.9, 2.0}) {
        const std::vector<double> weights = scene::curve_weights(curve, t);
        double sum = 0;
        for (const double w : weights) {
            CHECK(w >= 0);
            sum += w;
        }
        CHECK(sum == Approx(1).epsilon(1e-14));
    }
    curve = {};
    curve.rate = 2;
    curve.stop_time = 3;
    CHECK(scene::curve_value(curve, 1.5) == 3);
    CHECK(scene::curve_value(curve, 7) == 6);
}

}  // namespace fettle::core::scene_files::mechanism_reader_test
