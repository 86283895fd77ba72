// SPDX-License-Identifier: MIT
// Scenes with a number far from any that a mechanism has: every command ends in an answer or a refusal with words, never in an assertion
// (exit code 4) or a signal.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::extreme_numbers_test {

namespace {

using fettle::tests::design_support::DesignFolder;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

// A pin that slides in a block on a spring, a load, and a bar that lies free beside them.
const char* const scene = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
  "contact": { "dhat": 0.1, "kappa": 1e5 }, "friction": { "mu": 0.2 },
  "bodies": [
    { "name": "floor", "type": "static", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 40, "size_y": 40, "size_z": 4 } } },
    { "name": "pin", "density": 1000, "shape": { "part": "cylinder", "dimensions": { "radius": 3, "length": 20 } }, "position": [0, 0, 14] },
    { "name": "bar", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 8, "size_y": 8, "size_z": 8 } },
      "position": [60, 0, 7], "linear_velocity": [1, 0, 0], "angular_velocity": [5, 0, 1] }
  ],
  "joints": [{ "name": "slide", "type": "cylindrical", "b": "pin", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [-5, 5] }],
  "springs": [{ "name": "spring", "joint": "slide", "stiffness": 10, "damping": 0.1 }],
  "motors": [{ "name": "turn", "joint": "slide", "torque": 0.1 }],
  "loads": [{ "name": "push", "body": "bar", "force": [0.01, 0, 0], "point": [0, 0, 0] }]
})";

const char* const design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [{ "name": "length", "value": 20, "lower": 18, "upper": 22 }, { "name": "height", "value": 14, "lower": 13, "upper": 15 }],
  "set": { "/bodies/pin/shape/dimensions/length": "= length", "/bodies/pin/position/2": "= height" },
  "objective": [{ "type": "mass", "bodies": ["pin", "bar"] }],
  "constraints": [
    { "type": "clearance", "a": "pin", "b": "floor", "minimum": 0.2 },
    { "type": "marker_position", "body": "bar", "point": [0, 0, 0], "axis": [0, 0, 1], "over": "least", "lower": -5 }
  ]
})";

const std::vector<std::string> places{"/bodies/2/shape/dimensions/size_z",
                                      "/bodies/1/shape/dimensions/radius",
                                      "/bodies/1/density",
                                      "/bodies/2/density",
                                      "/bodies/2/position/0",
                                      "/bodies/2/linear_velocity/0",
                                      "/bodies/2/angular_velocity/1",
                                      "/gravity/2",
                                      "/timestep",
                                      "/end_time",
                                      "/contact/dhat",
                                      "/contact/kappa",
                                      "/friction/mu",
                                      "/joints/0/point/0",
                                      "/joints/0/limits/1",
                                      "/springs/0/stiffness",
                                      "/springs/0/damping",
                                      "/motors/0/torque",
                                      "/loads/0/force/0",
                                      "/loads/0/point/1"};

void check(const std::string& place, double value, const std::string& command) {
    nlohmann::json changed = nlohmann::json::parse(scene);
    changed.at(nlohmann::json::json_pointer(place)) = value;
    const DesignFolder folder(design, changed.dump());
    const Answer answer = run(command + " " + folder.design(), true, "ulimit -t 60; ");
    INFO(command << " with " << place << " = " << value << ": exit code " << answer.code << ", " << answer.out);
    CHECK((answer.code >= 0 && answer.code <= 3));
    CHECK_FALSE(answer.out.empty());
}

}  // namespace

TEST_CASE("a bar of 1e12 m has a refusal or a number, of every command") {
    for (const char* command : {"validate", "gradient", "simulate --steps 2"}) check("/bodies/2/shape/dimensions/size_z", 1e15, command);
    check("/bodies/2/density", 1e30, "gradient");
    check("/springs/0/stiffness", 1e30, "gradient");
}

TEST_CASE("every number of a scene with every extreme: each command answers, or refuses with words", "[slow]") {
    for (const std::string& place : places)
        for (const double value : {0.0, 1e-30, 1e-12, 1e9, 1e15, 1e22, 1e30, -1e15})
            for (const char* command : {"validate", "gradient", "simulate --steps 2"}) check(place, value, command);
}

}  // namespace fettle::design::cli::extreme_numbers_test
