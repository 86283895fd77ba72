// SPDX-License-Identifier: MIT
// Moves of joints, springs, motors, loads, gravity, friction and turns as a design file writes them.
#include "fettle/design/reading/move_reader.hpp"

#include <catch2/catch.hpp>

#include "fettle/design/reading/design_reader.hpp"
#include "fettle/tests/design/small_design.hpp"

namespace fettle::design::reading::move_reader_test {

namespace {

using namespace fettle::tests::design_support;
using description::Move;

const char* scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.1,
  "materials": { "steel": { "mu": 0.2 }, "brass": {} },
  "friction": { "mu": 0.3, "pairs": [{ "a": "steel", "b": "brass", "mu": 0.1 }] },
  "bodies": [
    { "name": "arm", "density": 1000, "shape": { "generator": "box", "dimensions": { "size_x": 20, "size_y": 4, "size_z": 4 } } },
    { "name": "rack", "density": 1000, "position": [50, 0, 0],
      "shape": { "generator": "box", "dimensions": { "size_x": 20, "size_y": 4, "size_z": 4 } } }
  ],
  "joints": [
    { "name": "hinge", "type": "revolute", "b": "arm", "point": [0, 0, 0], "axis": [0, 0, 1], "stiffness": 2, "preload": 1, "limits": [-90, 90] },
    { "name": "slide", "type": "prismatic", "b": "rack", "point": [50, 0, 0], "axis": [1, 0, 0], "stiffness": 300, "rest": 2 },
    { "name": "pinion", "type": "rack", "of": ["hinge", "slide"], "radius": 10 }
  ],
  "springs": [{ "name": "across", "a": "arm", "b": "rack", "point_a": [5, 0, 0], "point_b": [-5, 3, 0], "stiffness": 100 }],
  "dampers": [{ "name": "dash", "joint": "slide", "damping": 4 }],
  "motors": [{ "name": "push", "joint": "hinge", "torque": { "times": [0, 0.1], "values": [1, 2] } }],
  "loads": [{ "name": "pull", "body": "arm", "point": [10, 0, 0], "force": [0, 1, 0] }]
})";

std::string design_of(const std::string& move, const std::string& unit) {
    return R"({ "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [{ "name": "p", "value": 1, "lower": 0.5, "upper": 2, "unit": ")" +
           unit + R"(", "moves": [)" + move + R"(] }],
  "objective": [{ "type": "motor_effort", "motor": "push" }, { "type": "joint_force", "joint": "hinge", "over": "mean" },
                { "type": "energy", "of": "total" }] })";
}

std::vector<Move> read_all(const std::string& move, const std::string& unit) {
    const DesignFolder folder(design_of(move, unit), scene);
    const auto file = read_design(folder.design());
    if (!file) UNSCOPED_INFO(file.errors()[0].where << ": " << file.errors()[0].message);
    REQUIRE(file);
    return file->design.parameters[0].moves;
}

Move read(const std::string& move, const std::string& unit) {
    const std::vector<Move> moves = read_all(move, unit);
    REQUIRE(moves.size() == 1);
    return moves[0];
}

std::string refused(const std::string& move, const std::string& unit) {
    const DesignFolder folder(design_of(move, unit), scene);
    const auto file = read_design(folder.design());
    REQUIRE_FALSE(file);
    return file.errors()[0].message;
}

constexpr double degree = 3.14159265358979323846 / 180;

}  // namespace

TEST_CASE("moves of a mechanism: what they move, and in which unit") {
    const std::vector<Move> point = read_all(R"({ "joint": "hinge", "point_b": [1, 0, 2], "scale": 3, "offset": ["1mm", 0, 4] })", "mm");
    REQUIRE(point.size() == 2);
    CHECK((point[0].place == "/joints/0/point_b/0" && point[0].scale == 3 && point[0].offset == Approx(1e-3).epsilon(1e-15)));
    CHECK((point[1].place == "/joints/0/point_b/2" && point[1].scale == 6 && point[1].offset == Approx(4e-3).epsilon(1e-15)));
    const Move stiffness = read(R"({ "spring": "across", "stiffness": true, "scale": 2, "offset": "1 N/mm" })", "N/m");
    CHECK(stiffness.place == "/springs/0/stiffness");
    CHECK((stiffness.scale == 2 && stiffness.offset == 1000));
    CHECK(read(R"({ "damper": "dash", "damping": true })", "1").place == "/dampers/0/damping");
    // Of a parameter without unit the scale is in the target's: degrees, lengths of the file, SI.
    CHECK(read(R"({ "joint": "hinge", "lower_limit": true })", "1").scale == Approx(degree));
    CHECK(read(R"({ "joint": "slide", "rest": true })", "1").scale == Approx(1e-3));
    CHECK(read(R"({ "joint": "pinion", "radius": true })", "mm").place == "/joints/2/radius");
    CHECK(read(R"({ "joint": "hinge", "preload": true })", "N mm").scale == 1);
    CHECK(read(R"({ "motor": "push", "value": 1 })", "Nm").place == "/motors/0/torque/values/1");
    CHECK(read(R"({ "load": "pull", "force": [0, 1, 0] })", "N").place == "/loads/0/force/1");
    CHECK(read(R"({ "gravity": [0, 0, -1] })", "m/s^2").place == "/gravity/2");
    const Move pair = read(R"({ "materials": ["brass", "steel"], "mu": true, "scale": 0.5, "offset": 0.1 })", "1");
    CHECK(pair.place == "/friction/pairs/0/mu");
    CHECK((pair.scale == 0.5 && pair.offset == 0.1));
    CHECK(read(R"({ "material": "steel", "mu": true })", "1").place == "/materials/steel/mu");
    CHECK(read(R"({ "body": "rack", "mu": true })", "1").place == "/bodies/1/mu");
    CHECK(read(R"({ "mu": true })", "1").place == "/friction/mu");
    const Move turn = read(R"({ "body": "rack", "turn": [1, 0, 0] })", "deg");
    CHECK((turn.place == "/bodies/1/turn/0" && turn.scale == 1));
    CHECK(read(R"({ "body": "arm", "velocity": [1, 0, 0] })", "mm/s").place == "/bodies/0/linear_velocity/0");
    const Move dmin = read(R"({ "dmin": true, "scale": 2, "offset": 0.5 })", "mm");
    CHECK((dmin.place == "/contact/dmin" && dmin.scale == 2 && dmin.offset == Approx(5e-4)));
    const Move torque = read(R"({ "body": "rack", "torque": [0, 0, 2], "offset": [0, 0, "3 N mm"] })", "N mm");
    CHECK((torque.place == "/bodies/1/torque/2" && torque.scale == 2 && torque.offset == Approx(3e-3).epsilon(1e-15)));
}

TEST_CASE("moves of a mechanism that mean nothing are refused with what is wrong") {
    for (const auto& [message, part] :
         {std::pair(refused(R"({ "joint": "hing", "point_a": [1, 0, 0] })", "mm"), "no joint \"hing\""),
          std::pair(refused(R"({ "joint": "hinge", "stiffness": true })", "mm"), "not a measure of what it moves"),
          std::pair(refused(R"({ "joint": "hinge", "rest": true })", "deg"), "`hinge` has a `preload`"),
          std::pair(refused(R"({ "joint": "pinion", "point_a": [1, 0, 0] })", "mm"), "`pinion` has no point"),
          std::pair(refused(R"({ "spring": "across", "point_a": [1, 0, 0], "rest": true })", "mm"), "says one thing"),
          std::pair(refused(R"({ "motor": "push", "value": 2 })", "Nm"), "no such value"),
          std::pair(refused(R"({ "material": "brass", "mu": true })", "1"), "`brass` has no `mu`"),
          std::pair(refused(R"({ "materials": ["steel"], "mu": true })", "1"), "two materials"),
          std::pair(refused(R"({ "body": "arm", "material": "steel", "mu": true })", "1"), "says whose `mu`"),
          std::pair(refused(R"({ "mu": true })", "mm"), "not a measure of what it moves"),
          std::pair(refused(R"({ "body": "arm", "torque": [1, 0, 0] })", "N"), "not a measure of what it moves"),
          std::pair(refused(R"({ "load": "pull", "force": [0, 0, 0] })", "N"), "this moves nothing"),
          std::pair(refused(R"({ "load": "pull", "force": [0, 1, 0], "offset": [1, 0, 0] })", "N"), "coefficient is 0")}) {
        CAPTURE(message);
        CHECK(message.find(part) != std::string::npos);
    }
}

}  // namespace fettle::design::reading::move_reader_test
