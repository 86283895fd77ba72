// SPDX-License-Identifier: MIT
// fettle clearance from outside: sources of motion, pairs, presets, reports.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::clearance_command_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;

// Cubes of 10 mm in a row, 0.5 mm, 0.2 mm and 3 mm apart; `slide` moves along the row, `spin` turns about its own axis.
const char* row_scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.1, "end_time": 1,
  "bodies": [
    { "name": "slide", "type": "kinematic", "shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } },
      "prescribed": { "px": { "rate": -1 } } },
    { "name": "pin1", "type": "static", "shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } },
      "position": [10.5, 0, 0] },
    { "name": "pin2", "type": "static", "shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } },
      "position": [20.7, 0, 0] },
    { "name": "spin", "type": "kinematic", "shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } },
      "position": [33.7, 0, 0], "prescribed": { "rz": { "rate": 90 } } }
  ]
})";

struct RowFolder : DesignFolder {
    RowFolder() : DesignFolder(small_design, row_scene) {}
    std::string scene() const { return file("small.scene.json"); }
};

}  // namespace

TEST_CASE("clearance: pairs by name, wildcard and group, ignored, each with its minimum") {
    const RowFolder folder;
    const std::string command = "clearance " + folder.scene() + " --json ";
    // As assembled every pair, whatever types it has: also pin1 against pin2, which are both static. Worst first.
    const Answer all = run(command + "--minimum 0.6mm");
    CHECK(all.code == 1);
    REQUIRE(all.json()["pairs"].size() == 6);
    CHECK(all.json()["pairs"][0]["a"] == "pin1");
    CHECK(all.json()["pairs"][1]["b"] == "pin1");
    CHECK(all.json()["pairs"][1]["finding"] == "below threshold");
    CHECK(all.json()["pairs"][1]["lower"].get<double>() == Approx(0.0005).margin(1e-6));
    CHECK(all.json()["uncovered"].empty());
    CHECK(run(command + "--motion --minimum 0.6mm").json()["pairs"].size() == 5);  // over a motion those of which one moves
    CHECK(all.pair("spin", "pin2")["status"] == "clear");
    CHECK(all.json()["minimum"] == 6e-4);
    const Answer named = run(command + "--minimum 0.1mm --pairs pin1:pin2");
    CHECK(named.code == 0);
    CHECK(named.pair("pin1", "pin2")["upper"].get<double>() == Approx(0.0002).margin(1e-6));
    const Answer wild = run(command + "--minimum 0.1mm --pairs 's*:pin*,slide:pin1=0.4mm'");
    CHECK(wild.json()["pairs"].size() == 4);
    CHECK(wild.pair("slide", "pin1")["minimum"] == 4e-4);
    CHECK(wild.pair("slide", "pin1")["required_by"] == "--pairs");
    CHECK(wild.pair("slide", "pin2")["minimum"] == 1e-4);
    CHECK(run(command + "--pairs slide:pin1=0.4mm").code == 0);
    CHECK(run(command + "--pairs slide:pin1=0.51mm").code == 1);
    const Answer ignored = run(command + "--minimum 0.6mm --ignore pin1:*");
    CHECK(ignored.code == 0);
    CHECK(ignored.json()["pairs"].size() == 3);
    CHECK(ignored.json()["ignored"].size() == 3);
    CHECK(ignored.json()["uncovered"].size() == 3);
    // The pins as one rigid set: one row, that of the nearest; not against each other.
    const Answer group = run(command + "--minimum 0.6mm --group frame=pin1,pin2");
    CHECK(group.json()["pairs"].size() == 3);
    const Json row = group.pair("frame", "slide");
    CHECK((row.value("body_a", "") == "pin1" || row.value("body_b", "") == "pin1"));
    CHECK(row.at("upper").get<double>() == Approx(0.0005).margin(1e-6));
    CHECK(group.pair("frame", "spin")["upper"].get<double>() == Approx(0.003).margin(1e-6));
    CHECK(run(command + "--minimum 0.6mm --group frame=pin1,pin2 --pairs frame:spin").code == 0);
}

TEST_CASE("clearance: usage that is wrong is refused with what to do") {
    const RowFolder folder;
    const auto refused = [&](const std::string& arguments, const std::string& says) {
        const Answer answer = run("clearance " + folder.scene() + " " + arguments, true);
        CAPTURE(arguments, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says(says));
    };
    refused("--minimum 0.3", "--minimum");
    refused("--minimum -1mm", "a clearance is not negative");
    refused("--process fdn", "did you mean \"fdm\"?");
    refused("--minimum 1mm --pairs slide-pin1", "is not a pair");
    refused("--minimum 1mm --pairs slide:pin3", "did you mean \"pin1\"?");
    refused("--minimum 1mm --pairs 'x*:pin1'", "no name matches");
    refused("--minimum 1mm --pairs slide:slide", "with itself");
    refused("--minimum 1mm --pairs slide:pin1=1", "without a unit");
    refused("--minimum 1mm --group frame", "write name=a,b,c");
    refused("--minimum 1mm --group slide=pin1", "is a body's name already");
    refused("--minimum 1mm --group f=pin1 --group g=pin1", "is in both");
    refused("--minimum 1mm --motion --kinematic", "");
    refused("--minimum 1mm --poses " + folder.file("none.csv"), "none.csv");
    refused("--minimum 1mm --baseline " + folder.file("none.json"), "none.json");
}

TEST_CASE("clearance --explain of a trajectory says why no line is about round surfaces") {
    const RowFolder folder;
    REQUIRE(run("simulate " + folder.scene() + " --steps 2 --out " + folder.file("run")).code == 0);
    const std::string why = "no line is about round surfaces: a trajectory holds the meshes alone; give the scene or design";
    CHECK(run("clearance " + folder.file("run") + " --explain").says(why));
    CHECK_FALSE(run("clearance " + folder.file("run")).says(why));
    CHECK_FALSE(run("clearance " + folder.scene() + " --explain").says(why));
}

TEST_CASE("clearance: a pair without a minimum beside one that has its own is measured") {
    const RowFolder folder;
    const Answer answer = run("clearance " + folder.scene() + " --json --pairs slide:pin1=0.1mm,pin1:pin2");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.pair("slide", "pin1")["minimum"] == 1e-4);
    CHECK(answer.pair("pin1", "pin2")["minimum"].is_null());
    CHECK(answer.pair("pin1", "pin2")["lower"].get<double>() == Approx(2e-4).margin(1e-6));
}

TEST_CASE("clearance: pairs that a design is about are judged, whatever joins them") {
    const char* const joined_scene = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "end_time": 1, "bodies": [
        {"name": "slide", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10}}},
        {"name": "pin1", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10}}, "position": [10.5, 0, 0]},
        {"name": "pin2", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10}}, "position": [20.7, 0, 0]},
        {"name": "spin", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10}}, "position": [33.7, 0, 0]}],
        "joints": [{"name": "axle", "type": "revolute", "a": "pin1", "b": "slide", "point": [5, 0, 0], "axis": [0, 0, 1]},
                   {"name": "other", "type": "revolute", "a": "pin2", "b": "spin", "point": [30, 0, 0], "axis": [0, 0, 1]}]})";
    const auto design_of = [](const std::string& constraint) {
        return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "place", "value": 33.7, "lower": 33, "upper": 35}], "set": {"/bodies/3/position/0": "= place"},
            "quantities": {"gap": {"type": "play", "a": "slide", "b": "pin1"}},
            "objective": [{"type": "play", "a": "pin1", "b": "pin2", "weight": 1}], "constraints": [)" +
               constraint + "]}";
    };
    for (const char* constraint : {R"({"type": "clearance", "a": "slide", "b": "pin1", "minimum": 0.1})",
                                   R"({"type": "expression", "name": "twice", "expression": "2 * gap", "lower": "0.1mm"})"}) {
        const DesignFolder folder(design_of(constraint), joined_scene);
        const Answer answer = run("clearance --json " + folder.design());
        CAPTURE(answer.out);
        CHECK(answer.pair("slide", "pin1")["lower"].get<double>() == Approx(5e-4).margin(1e-6));
        const Json uncovered = answer.json()["uncovered"];
        CHECK(uncovered.size() == 1);  // the other joint's
        CHECK(run("clearance --json " + folder.file("small.scene.json")).json()["uncovered"].size() == 2);
    }
}

TEST_CASE("clearance: process presets, per side, by size of the parts") {
    const RowFolder folder;
    const Answer sla = run("clearance " + folder.scene() + " --process sla --pairs 'slide:*,spin:*' --json");
    CHECK(sla.code == 0);
    CHECK(sla.pair("slide", "pin1")["minimum"].get<double>() == Approx(0.375e-3));
    CHECK(sla.pair("slide", "pin1")["required_by"] == "--process sla");
    const Answer fdm = run("clearance " + folder.scene() + " --process fdm --json");
    CHECK(fdm.code == 1);
    CHECK(fdm.pair("slide", "pin1")["minimum"].get<double>() == Approx(0.7e-3));
    CHECK(run("clearance " + folder.scene() + " --process fdm --minimum 0.3mm --json").pair("slide", "pin1")["minimum"] == 3e-4);
    CHECK(run("clearance " + folder.scene() + " --process fdm --minimum 0.3mm").says("--minimum applies"));
    CHECK(run("clearance --help").says("per side"));
}

TEST_CASE("clearance: over scripted motion, and over the same motion as poses") {
    const RowFolder folder;
    const std::string command = "clearance " + folder.scene() + " --minimum 0.4mm --json ";
    const Answer scripted = run(command + "--motion");
    CHECK(scripted.code == 0);
    CHECK(scripted.json()["motion"] == true);
    CHECK(scripted.json()["steps"] == 10);
    CHECK(scripted.json()["source"].get<std::string>().find("scripted") != std::string::npos);
    // A corner of the turning cube comes within 13 - 5 - 5 sqrt 2 mm of the pin, half way: between two samples.
    const double corner = 1e-3 * (13 - 5 - 5 * std::sqrt(2));
    const Json spin = scripted.pair("spin", "pin2");
    CHECK(spin.at("lower").get<double>() <= corner + 1e-12);
    CHECK(spin.at("upper").get<double>() >= corner - 1e-12);
    CHECK(spin.at("gap").get<double>() <= 4e-7 * (1 + 1e-9));
    CHECK(spin.at("time").get<double>() == Approx(0.5).margin(1e-6));
    CHECK(spin.at("sampled").get<double>() >= spin.at("upper").get<double>() - 1e-12);
    CHECK(spin.at("pose_a").at("rotation").size() == 3);

    // Slide 1 mm away, spin 90 degrees, at uneven times; a body that is not named stays.
    const std::string csv = folder.write("p.csv",
                                         "time,body,px[mm],py[mm],pz[mm],rx[deg],ry[deg],rz[deg]\n"
                                         "0,slide,0,0,0,0,0,0\n0,spin,33.7,0,0,0,0,0\n"
                                         "0.2,slide,-0.2,0,0,0,0,0\n0.2,spin,33.7,0,0,0,0,18\n"
                                         "1,slide,-1,0,0,0,0,0\n1,spin,33.7,0,0,0,0,90\n");
    const Answer poses = run(command + "--poses " + csv);
    CHECK(poses.code == 0);
    CHECK(poses.json()["steps"] == 2);
    CHECK(poses.pair("spin", "pin2")["time"].get<double>() == Approx(0.5).margin(1e-6));
    CHECK(poses.pair("spin", "pin2")["upper"].get<double>() == Approx(corner).margin(1e-9));
    CHECK(poses.pair("spin", "pin2")["sampled"].get<double>() > corner + 1e-4);  // what sampling misses
    CHECK(poses.pair("slide", "pin1")["upper"].get<double>() == Approx(0.5e-3).margin(1e-6));
    CHECK(poses.says("not in"));
    CHECK(run("clearance " + folder.scene() + " --minimum 0.4mm --time 0.2 --motion --json").json()["steps"] == 2);
}

TEST_CASE("simulate --poses writes what clearance --poses reads") {
    const RowFolder folder;
    for (const char* name : {"out.csv", "out.json"}) {
        REQUIRE(run("simulate " + folder.scene() + " --steps 4 --poses " + folder.file(name)).code == 0);
        const Answer read = run("clearance " + folder.scene() + " --minimum 0.4mm --json --poses " + folder.file(name));
        CHECK(read.code == 0);
        CHECK(read.json()["steps"] == 4);
        CHECK(read.json()["notes"].empty());
        CHECK(read.pair("slide", "pin1")["upper"].get<double>() == Approx(0.5e-3).margin(1e-6));
    }
    const Answer validated = run("validate " + folder.file("out.json"), true);
    CHECK(validated.code == 3);
}

TEST_CASE("clearance: a clash is told, between surfaces and of a body inside another") {
    const RowFolder folder;
    const std::string command = "clearance " + folder.scene() + " --minimum 0.1mm --json --pairs slide:pin1 --poses ";
    const std::string head = "time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz\n";
    const Answer clash = run(command + folder.write("c.csv", head + "0,slide,0,0,0,1,0,0,0\n1,slide,3,0.3,0.2,1,0,0,0\n"));
    CHECK(clash.code == 1);
    CHECK(clash.json()["pairs"][0]["status"] == "violated");
    CHECK(clash.json()["pairs"][0]["finding"] == "clash");
    CHECK(clash.json()["pairs"][0]["lower"] == 0);
    // As assembled, a scene whose bodies pass through each other gets a report too.
    const DesignFolder crossing(small_design, replaced(row_scene, "[10.5, 0, 0]", "[9.5, 0.2, 0.1]"));
    const Answer assembled = run("clearance " + (crossing.path / "small.scene.json").string() + " --minimum 0.1mm --json");
    CHECK(assembled.code == 1);
    CHECK(assembled.pair("slide", "pin1")["finding"] == "clash");
    // Inside: surfaces 2 mm apart at least, and no room at all.
    const DesignFolder inside(
        small_design, replaced(replaced(row_scene, "[10.5, 0, 0]", "[1, 0, 0]"), "{ \"size_x\": 10, \"size_y\": 10, \"size_z\": 10 }",
                               "{ \"size_x\": 30, \"size_y\": 30, \"size_z\": 30 }"));
    const Answer nested = run("clearance " + (inside.path / "small.scene.json").string() + " --minimum 0.1mm --json --pairs slide:pin1");
    CHECK(nested.code == 1);
    CHECK(nested.json()["pairs"][0]["finding"] == "clash");
    CHECK(nested.json()["pairs"][0]["upper"] == 0);
    CHECK(nested.says("lies inside"));
}

TEST_CASE("clearance: bodies that dynamics lets touch are in contact, and judged when named") {
    const DesignFolder folder;
    const std::string command = "clearance " + (folder.path / "small.scene.json").string() + " --minimum 0.5mm --motion --steps 12 --json";
    const Answer all = run(command);
    CHECK(all.code == 0);
    const Json cube = all.pair("cube", "table");
    CHECK(cube.at("status") == "contact");
    CHECK(cube.at("finding") == "contact");
    CHECK(cube.at("upper").get<double>() < 1e-4);
    CHECK(cube.at("upper").get<double>() > 0);
    CHECK(all.pair("cube", "wall")["status"] == "clear");
    CHECK(all.json()["left_out"] == Json::array({"table:wall"}));
    const Answer named = run(command + " --pairs cube:table");
    CHECK(named.code == 1);
    CHECK(named.pair("cube", "table")["status"] == "violated");
}

TEST_CASE("clearance --certificate writes a proof that validate accepts, and rejects once it is changed") {
    const RowFolder folder;
    const std::string file = folder.file("row.certificate.json");
    const Answer written =
        run("clearance " + folder.scene() + " --minimum 0.4mm --pairs spin:pin2,slide:pin1 --motion --json --certificate " + file);
    CHECK(written.code == 0);
    CHECK(written.json()["certificate"]["trajectory"] == folder.file("row.trajectory.json"));
    const Answer accepted = run("validate " + file + " --json");
    CAPTURE(accepted.out);
    CHECK(accepted.code == 0);
    CHECK(accepted.json()["status"] == "accepted");
    CHECK(accepted.json()["pairs"].size() == 2);
    CHECK(accepted.json()["pairs"][0]["lower"] == written.pair("spin", "pin2")["lower"]);
    CHECK(accepted.json()["faults"].empty());
    const nlohmann::json stated = accepted.json()["pairs"];
    for (const auto& pair : stated) CHECK(pair["minimum"] == 0.4e-3);  // what was asked for is stated

    // Other programs write the keys in another order.
    const std::string sorted = folder.write("sorted.certificate.json", nlohmann::json::parse(contents(file)).dump());
    std::istringstream lines(contents(folder.file("row.trajectory.json")));
    std::string sorted_lines;
    for (std::string line; std::getline(lines, line);) sorted_lines += nlohmann::json::parse(line).dump() + "\n";
    folder.write("sorted.trajectory.json", sorted_lines);
    CHECK(run("validate " + sorted + " --json").json()["status"] == "accepted");
    CHECK(run("validate " + folder.file("sorted.trajectory.json") + " --json").json()["kind"] == "trajectory");

    auto changed = nlohmann::ordered_json::parse(contents(file));
    changed["pairs"][0]["lower"] = changed["pairs"][0]["lower"].get<double>() + 1e-5;
    const Answer rejected = run("validate " + folder.write("changed.certificate.json", changed.dump()) + " --json --trajectory " +
                                folder.file("row.trajectory.json"));
    CHECK(rejected.code == 1);
    CHECK(rejected.json()["status"] == "rejected");
    CHECK(!rejected.json()["faults"].empty());
    changed["pairs"][0].erase("lower");
    folder.write("changed.certificate.json", changed.dump());
    CHECK(run("validate " + folder.file("changed.certificate.json") + " --trajectory " + folder.file("row.trajectory.json")).code == 1);
    CHECK(run("validate " + folder.file("changed.certificate.json")).code == 3);  // no trajectory beside it
    // No second trajectory is written for a trajectory.
    const Answer again = run("clearance " + folder.file("row.trajectory.json") + " --minimum 0.4mm --pairs spin:pin2 --certificate " +
                             folder.file("again.certificate.json"));
    CHECK(again.code == 0);
    CHECK(again.says("--trajectory"));
    CHECK(run("validate " + folder.file("again.certificate.json") + " --trajectory " + folder.file("row.trajectory.json")).code == 0);
}

TEST_CASE("clearance: explanation, margin curves and a comparison with an earlier report") {
    const RowFolder folder;
    const std::string command = "clearance " + folder.scene() + " --motion ";
    const Answer text = run(command + "--minimum 0.6mm --explain 1 --csv " + folder.file("m.csv"));
    CHECK(text.code == 1);
    CHECK(text.says("slide:pin1"));
    CHECK(text.says("below threshold"));
    CHECK(text.says("1. slide:pin1: below threshold"));
    CHECK(!text.says("\n2. "));
    CHECK(text.says("what sampling sees"));
    CHECK(text.says("overall: violated"));
    CHECK(run(command + "--minimum 0.6mm --explain").says("\n3. "));

    std::istringstream csv(contents(folder.file("m.csv")));
    std::string line;
    REQUIRE(std::getline(csv, line));
    CHECK(line == "a,b,step,segment,time_start[s],time_end[s],lower[mm],upper[mm]");
    int rows = 0;
    double least = 1e9;
    while (std::getline(csv, line)) {
        std::istringstream fields(line);
        std::vector<std::string> f;
        for (std::string field; std::getline(fields, field, ',');) f.push_back(field);
        REQUIRE(f.size() == 8);
        CHECK(std::stod(f[6]) <= std::stod(f[7]));
        CHECK(std::stod(f[5]) - std::stod(f[4]) == Approx(0.1));
        if (f[0] == "slide" && f[1] == "pin1") {
            ++rows;
            least = std::min(least, std::stod(f[6]));
        }
    }
    CHECK(rows == 10);
    CHECK(least == Approx(0.5).margin(1e-3));

    const auto report = [&](const std::string& minima) { return run(command + "--pairs " + minima + " --json"); };
    const std::string before = folder.write("before.json", report("slide:pin1=0.6mm,spin:pin2=2mm,slide:pin2=0.1mm,slide:spin=30mm").out);
    const Answer after = run(command + "--pairs slide:pin1=0.1mm,spin:pin2=2mm,slide:pin2=20mm --json --baseline " + before);
    CHECK(after.code == 1);
    CHECK(after.pair("slide", "pin1")["change"] == "resolved");
    CHECK(after.pair("slide", "pin1")["before"]["status"] == "violated");
    CHECK(after.pair("spin", "pin2")["change"] == "existing");
    CHECK(after.pair("slide", "pin2")["change"] == "new");
    const Json baseline = after.json()["baseline"];
    CHECK(baseline.at("new") == 1);
    CHECK(baseline.at("existing") == 1);
    CHECK(baseline.at("resolved") == 1);
    CHECK(baseline.at("missing") == Json::array({"slide:spin"}));
    const std::string broken = folder.write("broken.json", R"({"pairs": [{"a": "x"}]})");
    CHECK(run(command + "--minimum 1mm --baseline " + broken).code == 3);
}

TEST_CASE("Bounds have the same bits with any instructions of the processor") {
    const std::string command =
        "clearance examples/slider_crank/slider_crank.scene.json --motion --steps 40 --tolerance 1um --explain --json";
    const Answer wide = run(command);
    REQUIRE(wide.code <= 2);
    REQUIRE(::setenv("FETTLE_BASELINE_INSTRUCTIONS", "1", 1) == 0);
    const Answer narrow = run(command);
    ::unsetenv("FETTLE_BASELINE_INSTRUCTIONS");
    CHECK(wide.json().at("pairs").size() > 3);
    CHECK(narrow.out == wide.out);
}

}  // namespace fettle::design::cli::clearance_command_test
