// SPDX-License-Identifier: MIT
// `fettle gradient --check` of designs that a file can ask for, as users have it.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::gradient_command_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

// A wheel that a motor's torque and one of its own turn on an axle against a stop, and a body that tumbles freely.
const std::string turned_scene = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.12, "integrator": "implicit_euler",
  "contact": { "dhat": 3 },
  "bodies": [
    { "name": "wheel", "density": 1000, "torque": [0, 0, 0.002],
      "shape": { "part": "box", "dimensions": { "size_x": 80, "size_y": 20, "size_z": 10 } } },
    { "name": "rotor", "density": 1000, "torque": [0.001, 0, 0], "position": [0, 0, 200], "angular_velocity": [90, 200, 30],
      "shape": { "part": "box", "dimensions": { "size_x": 60, "size_y": 30, "size_z": 10 } } }
  ],
  "joints": [{ "name": "axle", "type": "revolute", "b": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [-90, 6],
               "friction": 0.0005 }],
  "motors": [{ "name": "drive", "joint": "axle", "torque": { "times": [0, 0.12], "values": [0.001, 0.003] } }]
})";

const std::string turned_design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [
    { "name": "own", "value": 2, "lower": 1, "upper": 3, "unit": "N mm" },
    { "name": "free", "value": 1, "lower": 0, "upper": 2, "unit": "N mm" },
    { "name": "driven", "value": 3, "lower": 2, "upper": 4, "unit": "N mm" },
    { "name": "length", "value": 80, "lower": 60, "upper": 90 },
    { "name": "stop", "value": 6, "lower": 5.5, "upper": 7, "unit": "deg" }
  ],
  "set": {
    "/bodies/wheel/torque/2": "= own",
    "/bodies/rotor/torque": ["= free + 0.2 N mm", 0, "= free / 2"],
    "/motors/drive/torque/values/1": "= driven",
    "/bodies/wheel/shape/dimensions/size_x": "= length",
    "/joints/axle/limits/1": "= stop"
  },
  "objective": [
    { "type": "marker_speed", "body": "wheel", "point": [30, 0, 0], "over": "mean", "weight": 1 },
    { "type": "energy", "of": "total", "over": "mean", "weight": 1 }
  ],
  "constraints": [
    { "type": "marker_speed", "body": "rotor", "point": [20, 10, 0], "axis": [0, 1, 0], "lower": -1000 },
    { "type": "joint_torque", "joint": "axle", "over": "mean", "upper": 1 }
  ]
})";

// A driven four-bar, its bars written on one another.
const std::string linkage_scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.05, "end_time": 0.5, "integrator": "quasi_static",
  "variables": { "crank": 100, "coupler": 330, "rocker": 250 },
  "bodies": [
    { "name": "crank", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 100, "size_y": 10, "size_z": 5 } }, "group": 1 },
    { "name": "coupler", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 330, "size_y": 10, "size_z": 5 } }, "group": 1 },
    { "name": "rocker", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 250, "size_y": 10, "size_z": 5 } }, "group": 1 }
  ],
  "joints": [
    { "name": "O", "type": "revolute", "b": "crank", "point_a": [0, 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1] },
    { "name": "A", "type": "revolute", "a": "crank", "b": "coupler", "point_a": ["= crank", 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1] },
    { "name": "B", "type": "revolute", "a": "coupler", "b": "rocker", "point_a": ["= coupler", 0, 0], "point_b": ["= rocker", 0, 0],
      "axis": [0, 0, 1], "assemble": { "side": "right" } },
    { "name": "D", "type": "revolute", "b": "rocker", "point_a": [350, -50, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1] }
  ],
  "motors": [{ "name": "drive", "joint": "O", "angle": { "rate": 200, "times": [0], "values": [40] } }]
})";

const std::string linkage_design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [
    { "name": "a", "value": 100, "lower": 50, "upper": 150 },
    { "name": "b", "value": 330, "lower": 100, "upper": 400 },
    { "name": "c", "value": 250, "lower": 20, "upper": 400 }
  ],
  "set": { "/variables/crank": "= a", "/variables/coupler": "= b", "/variables/rocker": "= c" },
  "objective": [
    { "type": "marker_path", "body": "coupler", "point": [150, 60, 0], "points": [[200, 120, 0], [150, 150, 0]], "times": [0.1, 0.4], "weight": 1 }
  ]
})";

}  // namespace

TEST_CASE("gradient --check: a linkage assembled on either side, whatever its poses as written") {
    std::vector<double> values;
    for (const char* side : {"right", "left"}) {
        const DesignFolder folder(linkage_design, replaced(linkage_scene, "right", side));
        const Answer answer = run("gradient " + folder.design() + " --check --json");
        CAPTURE(side, answer.out);
        CHECK(answer.code == 0);
        const nlohmann::json told = answer.json();
        CHECK(told.at("largest_relative_error").get<double>() < 1e-6);
        CHECK(told.count("warnings") == 0);
        values.push_back(told.at("objective").get<double>());
    }
    CHECK(std::abs(values[0] - values[1]) > 0.1 * std::abs(values[0]));
    // Lengths that close on no side.
    const DesignFolder folder(replaced(linkage_design, "\"value\": 250", "\"value\": 30"), linkage_scene);
    const Answer answer = run("gradient " + folder.design() + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 3);
    CHECK(answer.says("the joints cannot be met"));
}

TEST_CASE("simulate: parts whose round surfaces overlap at the start meet with facets, and the user is told") {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string scene = folder.file("cam.scene.json");
    REQUIRE(run("new cam --in " + folder.file("")).code == 0);
    folder.write("cam.scene.json", replaced(fettle::tests::support::contents(scene), "\"gap\": \"0.05mm\"", "\"gap\": \"0.02mm\""));
    const Answer answer = run("simulate " + scene, true);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.says("between `cam` and `follower` contact takes some facets as they are: a gap of 0.0"));
    CHECK(answer.says("finer facets need less"));
}

TEST_CASE("gradient: warns of energy from nowhere as simulate does, and calls computed what is not proven") {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string scene = folder.file("cam.scene.json"), design = folder.file("cam.design.json");
    REQUIRE(run("new cam --in " + folder.file("")).code == 0);
    // A faceted cam that turns fast, by an integrator of second order.
    std::string text =
        replaced(fettle::tests::support::contents(scene), "\"timestep\": 0.005", "\"timestep\": 0.005, \"integrator\": \"bdf2\"");
    text = replaced(replaced(text, "\"rate\": -360", "\"rate\": -1440"), ", \"damping\": 1", "");
    text = replaced(text, "\"end_time\": 0.8", "\"end_time\": 0.4");
    const std::string words = "the motion has gained energy from nowhere";
    folder.write("cam.scene.json", text);
    CHECK_FALSE(run("simulate " + scene, true).says(words));  // round surfaces have no corners to gain it at
    folder.write("cam.scene.json", replaced(text, "\"contact\": { ", "\"contact\": { \"round\": false, "));
    CHECK(run("simulate " + scene, true).says(words));
    const Answer answer = run("gradient " + design, true);
    CAPTURE(answer.out);
    CHECK(answer.says("warning: " + words));
    CHECK(answer.says(" mm, computed, required 7.98 to 8.02 mm"));
    CHECK_FALSE(answer.says("proven"));
    const nlohmann::json told = run("gradient " + design + " --json").json();
    REQUIRE(told.at("warnings").size() == 1);
    CHECK(told.at("warnings")[0].get<std::string>().find(words) == 0);
    CHECK(told.at("constraints")[0].at("proven") == false);
    CHECK(told.at("constraints")[0].at("certified_lower").is_null());
    CHECK(told.at("constraints")[0].at("lower") == Approx(7.98e-3));
    CHECK(told.at("constraints")[0].at("upper") == Approx(8.02e-3));
}

TEST_CASE("gradient, simulate: a linkage that goes over to its other side is a warning") {
    // A double rocker that its rocker drives: coupler and rocker come in line on the way.
    std::string scene =
        replaced(linkage_scene, R"("crank": 100, "coupler": 330, "rocker": 250)", R"("crank": 250, "coupler": 150, "rocker": 250)");
    scene = replaced(scene, "[350, -50, 0]", "[300, 0, 0]");
    scene = replaced(scene, R"("joint": "O", "angle": { "rate": 200, "times": [0], "values": [40] })",
                     R"("joint": "D", "angle": { "times": [0, 0.5], "values": [136, 147] })");
    std::string design = replaced(linkage_design, "\"value\": 100", "\"value\": 250");
    design = replaced(replaced(design, "\"value\": 330", "\"value\": 150"), "\"upper\": 150", "\"upper\": 300");
    const DesignFolder folder(design, scene);
    const Answer gradient = run("gradient " + folder.design() + " --json"), simulate = run("simulate " + folder.design() + " --json");
    for (const Answer& answer : {gradient, simulate}) {
        CAPTURE(answer.out);
        CHECK(answer.code == 0);
        bool told = false;
        const nlohmann::json json = answer.json();
        for (const auto& warning : json.at("warnings"))
            told = told || warning.get<std::string>().find("the linkage has gone over to its other assembly by t = ") == 0;
        CHECK(told);
    }
}

TEST_CASE("gradient --check: torques on a body and of a motor, the size of a part with stops and friction") {
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
        const DesignFolder folder(turned_design, replaced(turned_scene, "implicit_euler", integrator));
        const Answer answer = run("gradient " + folder.design() + " --check --json");
        CAPTURE(integrator, answer.out);
        CHECK(answer.code == 0);
        const nlohmann::json told = answer.json();
        CHECK(told.at("largest_relative_error").get<double>() < 1e-6);
        REQUIRE(told.at("gradient").size() == 5);
        for (const nlohmann::json& slope : told.at("gradient")) CHECK(slope.get<double>() != 0);
        // The table counts in the units of the lines above it.
        for (const nlohmann::json& row : told.at("check"))
            if (row.at("quantity") == "objective")
                CHECK(row.at("adjoint").get<double>() ==
                      Approx(told.at("gradient").at(row.at("parameter").get<std::string>()).get<double>()));
    }
}

TEST_CASE("gradient and optimise warn where a motor turns backwards and its largest effort is asked for, once") {
    const std::string scene = R"({ "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.01, "end_time": 0.1,
      "bodies": [{ "name": "wheel", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 80, "size_y": 20, "size_z": 10 } } }],
      "joints": [{ "name": "axle", "type": "revolute", "b": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1], "damping": 0.001 }],
      "motors": [{ "name": "drive", "joint": "axle", "angle": { "times": [0, 0.1], "values": [0, -20] } }] })";
    const auto design = [](const std::string& over) {
        return R"({ "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
          "parameters": [{ "name": "length", "value": 80, "lower": 60, "upper": 90 }],
          "set": { "/bodies/wheel/shape/dimensions/size_x": "= length" },
          "objective": [{ "type": "motor_effort", "motor": "drive", "over": ")" +
               over +
               R"(" }], "constraints": [{ "type": "motor_effort", "motor": "drive", "over": "peak", "name": "peak", "upper": 5 }] })";
    };
    const auto count = [](const std::string& text) {
        std::size_t n = 0;
        for (std::size_t at = text.find("\"peak\" takes"); at != std::string::npos; at = text.find("\"peak\" takes", at + 1)) ++n;
        return n;
    };
    const DesignFolder backwards(design("largest"), scene), peak(design("peak"), scene);
    for (const std::string& command : {std::string("gradient "), "optimise --no-report --out " + backwards.file("out") + " "}) {
        const Answer text = run(command + backwards.design(), true), json = run(command + backwards.design() + " --json");
        CAPTURE(command, text.out);
        CHECK(count(text.out) == 1);
        REQUIRE(json.json().at("warnings").size() == 1);
        CHECK(json.json().at("warnings").at(0).get<std::string>().starts_with("objective `motor_effort drive`: all steps are negative"));
    }
    const nlohmann::json told = run("gradient --check " + peak.design() + " --json").json();
    CHECK(told.at("status") == "ok");
    CHECK_FALSE(told.contains("warnings"));
    CHECK(told.at("objective").get<double>() > 0);
    CHECK(told.at("constraints").at(0).at("value") == told.at("objective"));
}

TEST_CASE("gradient --check counts in the design's units, as the lines above it do") {
    const DesignFolder folder(turned_design, turned_scene);
    const Answer answer = run("gradient " + folder.design() + " --check");
    CAPTURE(answer.out);
    // "  d/d length    NUMBER per mm" above, "objective    length [mm]    NUMBER ..." in the table.
    const auto number_after = [&](const std::string& first, const std::string& second) {
        const std::size_t line = answer.out.find(first), at = line == std::string::npos ? line : answer.out.find(second, line);
        return at == std::string::npos ? std::nan("") : std::atof(answer.out.c_str() + at + second.size());
    };
    const double above = number_after("  d/d length ", "length "), in_table = number_after("\nobjective  ", "length [mm]");
    CHECK(above != 0);
    CHECK(in_table == Approx(above).epsilon(1e-5));
    CHECK(number_after("\nobjective  ", "stop [deg]") == Approx(number_after("  d/d stop ", "stop ")).epsilon(1e-5));
    CHECK(answer.says(" [mm/s] "));  // a constraint's, in the table and in that of noise and tolerance
}

TEST_CASE("gradient --check ends with its verdict and every cause") {
    const DesignFolder folder(turned_design, turned_scene);
    const Answer passed = run("gradient " + folder.design() + " --check --check-parameters 1");
    CAPTURE(passed.out);
    CHECK(passed.code == 0);
    CHECK(passed.out.ends_with("\ncheck passed (limit 1e-05)\n"));
    const Answer failed = run("gradient " + folder.design() + " --check --check-parameters 1 --check-limit 1e-30 --json");
    CAPTURE(failed.out);
    CHECK(failed.code == 2);
    const nlohmann::json told = failed.json();
    CHECK(told.at("status") == "check_failed");
    REQUIRE_FALSE(told.at("check_faults").empty());
    CHECK(told.at("check_faults").at(0).get<std::string>().find("backwards and forwards differ by ") == 0);
    CHECK(run("gradient --help").says("Exit code 2: "));
}

}  // namespace fettle::design::cli::gradient_command_test
