// SPDX-License-Identifier: MIT
// free_range_end.hpp: closed forms of value and derivative, differences, what nothing stops.
#include "design/quantities/free_range_end.hpp"

#include <catch2/catch.hpp>

#include "tests/design/quantities/file_problem.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::quantities::free_range_end_test {

using problem::DesignEvaluation;
using problem::DesignProblem;
using tests::design_support::check_gradient;
using tests::design_support::problem_of;

namespace {

// A lid of 50 x 20 x 4 mm, 1 mm above its base, on a hinge behind it, under a frame; and a drawer on a rail before a wall.
const char* const scene = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "bodies": [
    {"name": "lid", "density": 1000, "position": [25, 0, 3], "shape": {"part": "box", "dimensions": {"size_x": 50, "size_y": 20, "size_z": 4}}},
    {"name": "frame", "type": "static", "position": [0, 0, 40], "shape": {"part": "box", "dimensions": {"size_x": 90, "size_y": 30, "size_z": 20}}},
    {"name": "base", "type": "static", "position": [0, 0, -5], "shape": {"part": "box", "dimensions": {"size_x": 90, "size_y": 30, "size_z": 10}}},
    {"name": "drawer", "density": 1000, "position": [0, 60, 0], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 10, "size_z": 10}}},
    {"name": "wall", "type": "static", "position": [60, 60, 0], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 30, "size_z": 30}}}],
    "joints": [{"name": "hinge", "type": "revolute", "a": "base", "b": "lid", "point": [-5, 0, 0], "axis": [0, -1, 0], "limits": [0, 20]},
               {"name": "rail", "type": "prismatic", "b": "drawer", "point": [0, 60, 0], "axis": [1, 0, 0]}]})";

std::string design(const std::string& constraints) {
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "simulation": {"steps": 1},
        "parameters": [{"name": "high", "value": 40, "lower": 35, "upper": 60}, {"name": "long", "value": 50, "lower": 40, "upper": 60},
                       {"name": "behind", "value": -5, "lower": -8, "upper": -2}, {"name": "lift", "value": 3, "lower": 2.5, "upper": 5},
                       {"name": "wall", "value": 60, "lower": 50, "upper": 70}],
        "set": {"/bodies/frame/position/2": "= high", "/bodies/lid/shape/dimensions/size_x": "= long", "/joints/hinge/point/0": "= behind",
                "/bodies/lid/position/2": "= lift", "/bodies/wall/position/0": "= wall"},
        "constraints": [)" +
           constraints + "]}";
}

const char* const ends = R"({"type": "free_range", "joint": "hinge", "end": "above", "lower": "10 deg"},
    {"type": "free_range", "joint": "hinge", "end": "below", "clearance": 0.2, "upper": "0 deg"},
    {"type": "free_range", "joint": "rail", "end": "above", "clearance": 0.5, "lower": 5},
    {"type": "free_range", "joint": "rail", "end": "below", "upper": 5})";

// The corner at (x, z) from the hinge is so high when it has turned by this much.
double angle_of(double x, double z, double height) { return std::asin(height / std::hypot(x, z)) - std::atan2(z, x); }

}  // namespace

TEST_CASE("free_range: how far a lid opens and closes, and a drawer goes, by hand; and their derivatives") {
    const DesignProblem problem = problem_of(scene, design(ends));
    const DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
    REQUIRE(at.usable);
    // Upwards the upper corner (55, 5) mm from the hinge meets the frame at 30 mm, downwards the lower face, 1 mm above it, the base's
    // edge: a joint joins these two, which keep a micrometre whatever the clearance.
    CHECK(at.constraints[0].value == Approx(angle_of(0.055, 0.005, 0.03 - 1e-6)).epsilon(1e-9));
    CHECK(at.constraints[1].value == Approx(-std::asin(0.999e-3 / 0.05)).epsilon(1e-9));
    CHECK(at.constraints[2].value == Approx(0.0395).epsilon(1e-9));
    CHECK(at.constraints[3].value == Approx(-1));  // nothing is there
    for (int i = 0; i < 4; ++i) {
        CHECK(at.constraints[i].is_proven);
        CHECK(at.constraints[i].lower <= at.constraints[i].value);
        CHECK(at.constraints[i].value <= at.constraints[i].upper);
        CHECK(at.constraints[i].upper - at.constraints[i].lower <= 1e-4);
    }
    CHECK(at.jacobian(0, 0) == Approx(1 / std::sqrt(0.055 * 0.055 + 0.005 * 0.005 - 0.03 * 0.03)).epsilon(1e-4));
    CHECK(at.jacobian(2, 4) == Approx(1));
    CHECK(at.jacobian.row(3).isZero(0));
    check_gradient(problem, 1e-6);
}

TEST_CASE("free_range: faults name the joint, the end, the clearance") {
    const auto refused = [](const std::string& constraint) {
        const tests::design_support::DesignFolder folder(design(constraint), scene);
        const auto file = reading::read_design(folder.design());
        std::string told;
        for (const Error& error : file.errors()) told += error.where + ": " + error.message + "\n";
        return told;
    };
    CHECK(refused(R"({"type": "free_range", "joint": "hing", "end": "above", "lower": "1 deg"})").find("hinge") != std::string::npos);
    CHECK(refused(R"({"type": "free_range", "joint": "hinge", "end": "up", "lower": "1 deg"})").find("above, below") != std::string::npos);
    CHECK(refused(R"({"type": "free_range", "joint": "hinge", "end": "above", "clearance": 0, "lower": "1 deg"})").find("clearance") !=
          std::string::npos);
}

}  // namespace fettle::design::quantities::free_range_end_test
