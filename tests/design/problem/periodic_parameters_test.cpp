// SPDX-License-Identifier: MIT
#include "design/problem/periodic_parameters.hpp"

#include <catch2/catch.hpp>

#include "design/reading/design_reader.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::problem::periodic_parameters_test {

namespace {

using namespace fettle::tests::design_support;

const char* scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.05, "contact": { "dhat": 0.1 },
  "bodies": [
    { "name": "table", "type": "kinematic", "shape": { "part": "box", "dimensions": { "size_x": 60, "size_y": 60, "size_z": 10 } },
      "position": [0, 0, -5], "prescribed": { "rz": { "rate": 40 } } },
    { "name": "cube", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 } },
      "position": [3, 1, 25], "rotation": [0, 0, 0] }
  ]
})";

// A parameter of a whole turn, and what follows from it; a second parameter for formulas of two.
std::vector<bool> of(const std::string& set, const std::string& more = "", double upper = 360) {
    const std::string design = R"({ "fettle_design": 1, "scene": "small.scene.json", "units": "mm", "parameters": [
        { "name": "angle", "value": 30, "lower": 0, "upper": )" +
                               std::to_string(upper) + R"(, "unit": "deg" },
        { "name": "length", "value": 5, "lower": 1, "upper": 9 } ],
      "set": { )" + set + R"( },
      "objective": [ { "type": "mass", "bodies": ["cube"], "weight": 1 } ])" +
                               more + "}";
    const DesignFolder folder(design, scene);
    const auto file = reading::read_design(folder.design());
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return periodic_parameters(file->design);
}

}  // namespace

TEST_CASE("an angle is periodic where the design at both its bounds is one") {
    const std::vector<bool> turned = of(R"x("/bodies/cube/rotation/2": "= angle", "/bodies/cube/position/0": "= length")x");
    CHECK(turned == std::vector<bool>{true, false});
    CHECK(of(R"x("/bodies/cube/position/0": "= length * cos(angle)", "/bodies/cube/position/1": "= length * sin(angle)")x")[0]);
    CHECK(of(R"x("/bodies/cube/rotation/2": "= 2 * angle", "/bodies/cube/position/0": "= length * cos(3 * angle)")x")[0]);
}

TEST_CASE("an angle is not periodic where something differs at its bounds") {
    CHECK_FALSE(of(R"x("/bodies/cube/rotation/2": "= angle", "/bodies/cube/position/0": "= length")x", "", 300)[0]);
    CHECK_FALSE(of(R"x("/bodies/cube/rotation/2": "= 0.5 * angle", "/bodies/cube/position/0": "= length")x")[0]);
    CHECK_FALSE(of(R"x("/bodies/table/prescribed/rz/rate": "= angle / 1 s", "/bodies/cube/position/0": "= length")x")[0]);
    CHECK_FALSE(of(R"x("/bodies/cube/rotation/2": "= angle", "/bodies/cube/position/0": "= length * cos(angle / 2)")x")[0]);
    // A whole number of turns at the start alone.
    CHECK_FALSE(of(R"x("/bodies/cube/rotation/2": "= angle * length / 5 mm", "/bodies/cube/position/0": "= length")x")[0]);
    CHECK_FALSE(of(
        R"x("/bodies/cube/rotation/2": "= angle", "/bodies/cube/position/0": "= length")x",
        R"x(, "constraints": [ { "type": "relation", "name": "r", "expression": "angle", "lower": "0 deg", "upper": "400 deg" } ])x")[0]);
}

}  // namespace fettle::design::problem::periodic_parameters_test
