// SPDX-License-Identifier: MIT
// fettle ranges FILE from outside: text, JSON, refusals.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::ranges_command_test {

using Json = nlohmann::json;
using fettle::tests::support::Answer;
using Folder = fettle::tests::support::TemporaryFolder;
using fettle::tests::support::replaced;
using fettle::tests::support::run;

namespace {

// A lid on a frame: it meets the frame's wall at the angle where its upper edge, 4 mm above the hinge, is 30 mm high.
const char* const lid_scene = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "bodies": [
    {"name": "lid", "density": 1000, "position": [25, 0, 2], "shape": {"part": "box", "dimensions": {"size_x": 50, "size_y": 20, "size_z": 4}}},
    {"name": "frame", "type": "static", "position": [0, 0, 40], "shape": {"part": "box", "dimensions": {"size_x": 90, "size_y": 30, "size_z": 20}}},
    {"name": "base", "type": "static", "position": [0, 0, -5], "shape": {"part": "box", "dimensions": {"size_x": 90, "size_y": 30, "size_z": 10}}}],
    "joints": [{"name": "hinge", "type": "revolute", "a": "base", "b": "lid", "point": [-5, 0, 0], "axis": [0, -1, 0], "limits": [0, 60]}]})json";

double hinge_end() { return std::asin(30 / std::hypot(55.0, 4.0)) - std::atan2(4.0, 55.0); }

}  // namespace

TEST_CASE("ranges: a lid is free from the base that it lies on to the frame above it") {
    const Folder folder;
    const std::string scene = folder.write("lid.scene.json", lid_scene);
    const Answer answer = run("ranges " + scene + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    const Json hinge = answer.json().at("joints").at(0);
    CHECK(hinge["joint"] == "hinge");
    CHECK(hinge["unit"] == "rad");
    CHECK(hinge["free"]["upper"].get<double>() <= hinge_end());
    CHECK(hinge["above"]["at"].get<double>() >= hinge_end());
    CHECK(hinge["above"]["at"].get<double>() - hinge["free"]["upper"].get<double>() < 1.8e-4);
    CHECK(hinge["above"]["finding"] == "blocked");
    CHECK(hinge["above"]["b"] == "frame");
    CHECK(hinge["above"]["depth"]["upper"].get<double>() < 2e-5);
    CHECK(hinge["free"]["lower"] == 0);
    CHECK(hinge["below"]["b"] == "base");
    CHECK(hinge["touching"] == Json::array({"lid:base"}));
    CHECK(hinge["limits"][1].get<double>() == Approx(M_PI / 3));
    const Answer text = run("ranges " + scene);
    CAPTURE(text.out);
    CHECK(text.says("hinge: free from 0 to 28.7"));
    CHECK(text.says("above: at 28.8"));
    CHECK(text.says("its limits, 0 to 60 deg, go beyond"));
    const std::string line = text.out.substr(text.out.find("\"limits\": ["), text.out.find("]\n") - text.out.find("\"limits\": [") + 1);
    const std::string limited = folder.write("limited.scene.json", replaced(lid_scene, "\"limits\": [0, 60]", line));
    CHECK(run("ranges " + limited).says("deg, lie within"));
    CHECK(text.says("lid:base: they touch as assembled, and come apart"));
    const Answer kept = run("ranges " + scene + " --minimum 1mm --tolerance 0.001deg --ignore lid:base");
    CAPTURE(kept.out);
    CHECK(kept.says("closer than 1 mm"));
    CHECK(kept.says("not looked at: "));
    // Bodies that a joint joins are always near each other: the minimum is of the others, these do not meet.
    const std::string raised = folder.write("raised.scene.json", replaced(lid_scene, "[25, 0, 2]", "[25, 0, 2.3]"));
    const Answer near = run("ranges " + raised + " --minimum 5mm --json");
    CAPTURE(near.out);
    CHECK(near.code == 0);
    const Json below = near.json().at("joints").at(0).at("below"), above = near.json().at("joints").at(0).at("above");
    CHECK((below["a"] == "base" || below["b"] == "base"));
    CHECK(below["distance"].get<double>() < 1e-6);
    CHECK((above["a"] == "frame" || above["b"] == "frame"));
    CHECK(above["distance"].get<double>() == Approx(5e-3).epsilon(2e-3));
}

TEST_CASE("ranges: what is asked for is looked at, and nothing else is taken") {
    const Folder folder;
    const std::string scene = folder.write("lid.scene.json", lid_scene);
    CHECK(run("ranges " + scene + " --joint hinge").code == 0);
    CHECK(run("ranges " + scene + " --joint hing", true).says("did you mean \"hinge\""));
    CHECK(run("ranges " + scene + " --tolerance 0deg").code == 3);
    CHECK(run("ranges " + scene + " --tolerance 3").code == 3);
    CHECK(run("ranges " + scene + " --minimum=-1mm").code == 3);
    // A body in the frame from the start on is free nowhere.
    const std::string clash = folder.write("clash.scene.json", replaced(lid_scene, "[0, 0, 40]", "[0, 0, 12]"));
    const Answer answer = run("ranges " + clash);
    CAPTURE(answer.out);
    CHECK(answer.code == 1);
    CHECK(answer.says("free nowhere: lid:frame, they meet as assembled"));
    CHECK(run("ranges " + scene + " --minimum 40mm").says("free nowhere: lid:frame, closer than 40 mm as assembled"));
}

TEST_CASE("ranges: a stud swings in its socket as far as its neck lets it, and turns all round") {
    const Folder folder;
    const std::string scene = folder.write("ball.scene.json", R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "bodies": [
        {"name": "socket", "type": "static", "shape": {"part": "ball_socket", "dimensions": {"clearance": 0.4}}},
        {"name": "stud", "density": 1000, "shape": {"part": "ball_stud"}}],
        "joints": [{"name": "ball", "type": "ball", "a": "socket", "b": "stud", "point": [0, 0, 0], "axis": [0, 0, 1], "swing": 10}]})json");
    const Answer answer = run("ranges " + scene + " --tolerance 1deg --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    const Json joints = answer.json()["joints"];
    REQUIRE(joints.size() == 2);
    // Between the neck's line, 2.5 mm from its axis, and the corner of the mouth, 2.5 mm below the middle and 4.79 mm beside it.
    const double end = std::atan2(std::sqrt(5.4 * 5.4 - 2.5 * 2.5), 2.5) - std::asin(2.5 / 5.4);
    CHECK(joints[0]["joint"] == "ball");
    CHECK(joints[0]["free"]["lower"] == 0);
    CHECK(joints[0]["free"]["upper"].get<double>() == Approx(end).margin(0.08));
    CHECK(joints[0]["limits"][1].get<double>() == Approx(M_PI / 18));
    CHECK(joints[1]["joint"] == "ball (turn)");
    CHECK(joints[1]["turns_freely"] == true);
    const Answer text = run("ranges " + scene + " --tolerance 1deg --joint ball");
    CAPTURE(text.out);
    CHECK(text.says("ball: free from 0 to "));
    CHECK(text.says("its limits, 0 to 10 deg, lie within"));
}

TEST_CASE("ranges: the two-armed robot's joints, one at a time and with the others anywhere") {
    const std::string robot = "ranges examples/two_arm/two_arm.scene.json --json";
    const Json alone = run(robot).json();
    CHECK(alone["status"] == "ok");
    CHECK(alone["joints"].size() == 4);
    const Json anywhere = run(robot + " --anywhere --joint left_shoulder --tolerance 0.5deg").json();
    REQUIRE(anywhere["joints"].size() == 1);
    CHECK(anywhere["others"] == "anywhere within their limits");
    for (const Json& joint : alone["joints"])
        if (joint["joint"] == "left_shoulder") {
            CHECK(anywhere["joints"][0]["free"]["upper"].get<double>() <= joint["free"]["upper"].get<double>() + 0.01);
            CHECK(anywhere["joints"][0]["free"]["lower"].get<double>() >= joint["free"]["lower"].get<double>() - 0.01);
        }
}

}  // namespace fettle::design::cli::ranges_command_test
