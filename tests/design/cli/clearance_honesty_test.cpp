// SPDX-License-Identifier: MIT
// fettle clearance and fettle validate, where they used to say more than was known: nothing judged, clashes between poses, bodies inside
// others, certificates of something else.
#include <catch2/catch.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::clearance_honesty_test {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;

std::string box_body(const std::string& name, const std::string& type, const std::string& size, const std::string& position) {
    return R"({ "name": ")" + name + R"(", "type": ")" + type + R"(", "shape": { "part": "box", "dimensions": { "size_x": )" + size +
           R"(, "size_y": 10, "size_z": 10 } }, "position": )" + position + " }";
}

std::string scene_of(const std::vector<std::string>& bodies) {
    std::string text = R"({ "fettle_scene": 1, "units": "mm", "timestep": 0.1, "end_time": 1, "bodies": [)";
    for (const std::string& body : bodies) text += (text.back() == '[' ? "" : ",\n") + body;
    return text + "] }";
}

// Two static blocks 1 mm in each other, and a kinematic one far away.
struct OverlapFolder : DesignFolder {
    OverlapFolder()
        : DesignFolder(small_design, scene_of({box_body("a", "static", "10", "[0, 0, 0]"), box_body("b", "static", "10", "[9, 0.2, 0.1]"),
                                               box_body("c", "kinematic", "10", "[40, 0, 0]")})) {}
    std::string scene() const { return file("small.scene.json"); }
};

const std::string head = "time,body,px[mm],py[mm],pz[mm],rx,ry,rz\n";

}  // namespace

TEST_CASE("clearance: static assemblies are judged, with and without a motion of the others") {
    const OverlapFolder folder;
    const std::string command = "clearance " + folder.scene() + " --json --minimum 0.3mm ";
    const std::string one = folder.write("one.csv", head + "0,c,40,0,0,0,0,0\n");
    const std::string constant = folder.write("constant.csv", head + "0,c,40,0,0,0,0,0\n1,c,40,0,0,0,0,0\n");
    for (const std::string& how : {std::string(), std::string("--pairs '*:*'"), "--poses " + one, "--poses " + constant,
                                   std::string("--motion --steps 0"), std::string("--motion"), std::string("--kinematic")}) {
        CAPTURE(how);
        const Answer answer = run(command + how);
        CHECK(answer.code == 1);
        CHECK(answer.json()["status"] == "violated");
        const Json pair = answer.pair("a", "b");
        REQUIRE(pair.is_object());
        CHECK(pair.at("finding") == "clash");
        CHECK(pair.at("depth").at("lower").get<double>() <= 1e-3 * (1 + 1e-9));
        CHECK(pair.at("depth").at("lower").get<double>() > 0.9e-3);
        CHECK(pair.at("depth").at("upper").get<double>() >= 1e-3 * (1 - 1e-9));
        const double volume = 1e-9 * 1 * 9.8 * 9.9;
        CHECK(pair.at("volume").at("lower").get<double>() <= volume * (1 + 1e-9));
        CHECK(pair.at("volume").at("upper").get<double>() >= volume * (1 - 1e-9));
    }
    CHECK(run(command + "--motion --steps 0").json()["motion"] == false);
}

TEST_CASE("clearance: where nothing was judged nothing is clear") {
    const OverlapFolder folder;
    for (const std::string& how : {std::string("--ignore '*:*'"), std::string("--motion --ignore '*:*'")}) {
        const Answer answer = run("clearance " + folder.scene() + " --json --minimum 0.3mm " + how);
        CHECK(answer.code == 2);
        CHECK(answer.json()["status"] == "undecided");
        CHECK(answer.json()["pairs"].empty());
        CHECK(answer.json()["uncovered"].size() == 3);
        CHECK(answer.json()["message"].get<std::string>().find("nothing was judged") != std::string::npos);
    }
    const DesignFolder lonely(small_design, scene_of({box_body("a", "static", "10", "[0, 0, 0]")}));
    CHECK(run("clearance " + lonely.file("small.scene.json") + " --minimum 0.3mm").code == 2);
}

TEST_CASE("clearance: why nothing was judged is told, joints or groups") {
    const auto message = [](const std::string& group, const std::string& joints) {
        const DesignFolder folder(small_design,
                                  R"({ "fettle_scene": 1, "units": "mm", "bodies": [{ "name": "a", "type": "static",)" + group +
                                      R"("shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } } },
                                         { "name": "b",)" +
                                      group +
                                      R"("position": [11, 0, 0], "density": 1000,
            "shape": { "part": "box", "dimensions": { "size_x": 10, "size_y": 10, "size_z": 10 } } }])" +
                                      joints + " }");
        return run("clearance " + folder.file("small.scene.json") + " --minimum 0.3mm --json").json().value("message", "");
    };
    const std::string joint =
        R"(, "joints": [{ "name": "pin", "type": "revolute", "a": "a", "b": "b", "point": [5.5, 0, 0], "axis": [0, 0, 1] }])";
    CHECK(message(R"("group": 1, )", "") == "nothing was judged: all bodies are of one group");
    CHECK(message("", joint) == "nothing was judged: a joint joins the bodies of every pair");
}

TEST_CASE("clearance: no earlier certificate stays where nothing is proven, and none is written without its trajectory") {
    const DesignFolder folder;
    const std::string proof = folder.file("fit.certificate.json"), path = folder.file("fit.trajectory.json");
    const std::string command = "clearance " + folder.file("small.scene.json") + " --minimum 1mm --pairs cube:wall --json --certificate ";
    REQUIRE(run(command + proof).code == 0);
    REQUIRE(fs::exists(proof));
    REQUIRE(fs::exists(path));
    const Answer nothing = run(command + proof + " --ignore '*:*'");
    CHECK(nothing.code == 2);
    CHECK(nothing.json().at("certificate").is_null());
    CHECK_FALSE(fs::exists(proof));
    CHECK_FALSE(fs::exists(path));
    const std::string theirs = folder.write("theirs.json", "{}");
    CHECK(run(command + theirs + " --ignore '*:*'").code == 2);
    CHECK(fs::exists(theirs));
    fs::create_directory(path);  // which no trajectory can replace
    const Answer unwritten = run(command + proof);
    CHECK(unwritten.code == 3);
    CHECK(unwritten.json().at("status") == "clear");
    CHECK_FALSE(fs::exists(proof));
}

TEST_CASE("clearance: a plate passed through between two poses is a clash, told with its first instant") {
    const DesignFolder folder(
        small_design, scene_of({box_body("plate", "static", "1", "[0, 0, 0]"), box_body("block", "kinematic", "2", "[-20, 1, 1]")}));
    const std::string csv = folder.write("through.csv", head + "0,block,-20,1,1,0,0,0\n1,block,30,1,1,0,0,0\n");
    const Answer answer = run("clearance " + folder.file("small.scene.json") + " --json --minimum 0.1mm --poses " + csv);
    CHECK(answer.code == 1);
    const Json pair = answer.pair("plate", "block");
    CHECK(pair.at("finding") == "clash");
    const double first = (20 - 1.5) / 50;
    CHECK(pair.at("time").get<double>() == Approx(first).margin(1e-5));
    CHECK(pair.at("clash_not_before").get<double>() <= first + 1e-12);
    CHECK(pair.at("clash_not_before").get<double>() > first - 1e-5);
    CHECK(run("clearance " + folder.file("small.scene.json") + " --minimum 0.1mm --explain --poses " + csv).says("passes through") ==
          false);
    CHECK(
        run("clearance " + folder.file("small.scene.json") + " --minimum 0.1mm --explain --poses " + csv).says("pass through each other"));
}

TEST_CASE("clearance: without a minimum distances are told, and clashes all the same") {
    const OverlapFolder folder;
    const Answer apart = run("clearance " + folder.scene() + " --json --pairs 'c:*'");
    CHECK(apart.code == 0);
    CHECK(apart.json()["minimum"].is_null());
    CHECK(apart.pair("c", "b")["minimum"].is_null());
    CHECK(apart.pair("c", "b")["upper"].get<double>() == Approx(0.021).margin(1e-5));
    CHECK(apart.pair("c", "b")["solids"] == "disjoint");
    CHECK(apart.json()["uncovered"] == Json::array({"a:b"}));
    CHECK(run("clearance " + folder.scene()).code == 1);
}

TEST_CASE("clearance: files that are none of what it reads are refused with a list of what is") {
    const OverlapFolder folder;
    for (const char* name : {"part.iges", "part.scad", "part.sldprt", "part.csv"}) {
        const Answer answer = run("clearance " + folder.write(name, "solid part\nendsolid part\n") + " --minimum 1mm", true);
        CAPTURE(name, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says("scenes, designs and trajectories are JSON (.json)"));
        CHECK(!answer.says("valid JSON"));
    }
    const std::string mesh = "clearance " + folder.write("part.stl", "solid part\nendsolid part\n") + " --minimum 1mm";
    CHECK(run(mesh, true).says("the file states no unit of length"));
    CHECK(run(mesh + " --unit mm").code == 3);  // a mesh without a triangle
}

TEST_CASE("clearance: one that is interrupted is undecided, never violated") {
    const DesignFolder folder;
    // The signal comes while the motion of many steps is simulated.
    const std::string program = std::getenv("FETTLE_PROGRAM") != nullptr ? std::getenv("FETTLE_PROGRAM") : FETTLE_PROGRAM;
    const std::string out = folder.file("out.json");
    const std::string command = "timeout --foreground -s INT 1 '" + program + "' clearance " + folder.file("small.scene.json") +
                                " --minimum 30mm --motion --steps 200000 --json > " + out + " 2>/dev/null";
    const int status = std::system(command.c_str());
    CAPTURE(status, contents(out));
    const Json json = Json::parse(contents(out), nullptr, false);
    REQUIRE(json.is_object());
    CHECK(json.at("status") == "undecided");
    CHECK(json.at("message").get<std::string>().find("interrupted: interrupted") == std::string::npos);
}

TEST_CASE("A certificate says what it covers, is judged by a minimum, and is stale where path or meshes have changed") {
    const DesignFolder folder(small_design,
                              scene_of({box_body("a", "static", "10", "[0, 0, 0]"), box_body("b", "static", "10", "[10.5, 0, 0]"),
                                        box_body("c", "kinematic", "10", "[40, 0, 0]")}));
    const std::string scene = folder.file("small.scene.json"), file = folder.file("fit.certificate.json");
    REQUIRE(run("clearance " + scene + " --minimum 0.3mm --pairs a:b --certificate " + file).code == 0);
    CHECK(Json::parse(contents(file))["source"] == "small.scene.json");  // from the certificate's folder
    const Answer judged = run("validate " + file + " --minimum 0.3mm --json");
    CHECK(judged.code == 0);
    CHECK(judged.json()["judgement"] == "clear");
    CHECK(judged.json()["pairs"][0]["solids"] == "disjoint");
    CHECK(judged.json()["uncovered"] == Json::array({"a:c", "b:c"}));
    CHECK(run("validate " + file + " --minimum 0.3mm").says("not covered: a:c, b:c"));
    CHECK(run("validate " + file + " --minimum 0.6mm").code == 1);
    CHECK(run("validate " + file + " --minimum 0.5mm --json").json()["judgement"] == "undecided");
    CHECK(run("validate " + file + " --minimum 0.5mm").code == 2);
    CHECK(run("validate " + file + " --minimum 0.5").code == 3);
    // Text shows the scene's unit, lower bounds rounded down.
    CHECK(run("validate " + file).says(" mm; disjoint solids"));

    const std::string path = folder.file("fit.trajectory.json"), whole = contents(path);
    auto moved = nlohmann::ordered_json::parse(whole);
    moved["poses"][1][9] = moved["poses"][1][9].get<double>() + 1e-3;  // farther: the bounds hold, but are of something else
    folder.write("fit.trajectory.json", moved.dump());
    const Answer stale = run("validate " + file + " --json");
    CHECK(stale.code == 1);
    CHECK(stale.json()["status"] == "stale");
    folder.write("fit.trajectory.json", whole);
    CHECK(run("validate " + file).code == 0);
    folder.write("small.scene.json", replaced(contents(scene), "\"size_x\": 10", "\"size_x\": 9"));
    const Answer changed = run("validate " + file + " --json");
    CHECK(changed.code == 1);
    CHECK(changed.json()["status"] == "stale");
    CHECK(changed.says("have changed since"));

    folder.write("small.scene.json", replaced(contents(scene), "\"size_x\": 9", "\"size_x\": -9"));
    const Answer unreadable = run("validate " + file + " --json");
    CHECK(unreadable.code == 1);
    CHECK(unreadable.json()["status"] == "stale");
    CHECK(unreadable.says("can no longer be read"));

    auto empty = nlohmann::ordered_json::parse(contents(file));
    empty["pairs"] = Json::array();
    empty["source"] = "";
    const Answer nothing = run("validate " + folder.write("empty.certificate.json", empty.dump()) + " --json --trajectory " + path);
    CHECK(nothing.code == 1);
    CHECK(nothing.json()["status"] == "rejected");
}

TEST_CASE("A certificate of a design states what the design requires of each pair, and is judged by that") {
    const auto folder_of = [](const std::string& minimum) {
        return DesignFolder(R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "place", "value": 40, "lower": 35, "upper": 45}, {"name": "need", "value": 2, "lower": 1, "upper": 3}],
            "set": {"/bodies/c/position/0": "= place"}, "scenarios": [{"name": "first"}, {"name": "second", "set": {"/gravity": [0, 0, -1]}}],
            "objective": [{"type": "play", "a": "b", "b": "c", "weight": 1}],
            "constraints": [{"type": "clearance", "a": "a", "b": "b", "minimum": )" +
                                minimum + R"(},
                            {"type": "clearance", "a": "b", "b": "a", "minimum": 9, "motion": true},
                            {"type": "clearance", "a": "c", "b": "b", "minimum": "= 2 * need"}]})",
                            scene_of({box_body("a", "static", "10", "[0, 0, 0]"), box_body("b", "static", "10", "[10.5, 0, 0]"),
                                      box_body("c", "kinematic", "10", "[40, 0, 0]")}));
    };
    const DesignFolder folder = folder_of("0.3");
    const std::string file = folder.file("fit.certificate.json");
    const Answer made = run("clearance " + folder.design() + " --pairs a:b,b:c,a:c --certificate " + file);
    CHECK(made.says("about the scenario `first` alone; not looked at: `second` (--scenario)"));
    const Answer met = run("validate " + file + " --json");
    CAPTURE(met.out);
    CHECK(met.code == 0);
    CHECK(met.json()["judgement"] == "clear");
    CHECK(met.pair("a", "b")["minimum"].get<double>() == Approx(3e-4));
    CHECK(met.pair("a", "b")["status"] == "clear");
    CHECK(met.pair("b", "c")["minimum"].get<double>() == Approx(4e-3));
    CHECK_FALSE(met.pair("a", "c").contains("minimum"));  // nothing is required of these
    CHECK_FALSE(met.json().contains("minimum"));
    CHECK(run("validate " + file).says("; required 0.3 mm: clear"));
    CHECK(run("validate " + file).says("at the minima that it states: clear"));
    // The command line goes before them; a certificate that states none is judged by that alone.
    CHECK(run("validate " + file + " --minimum 0.6mm").code == 1);
    auto older = nlohmann::ordered_json::parse(contents(file));
    for (auto& pair : older["pairs"]) pair.erase("minimum");
    folder.write("fit.certificate.json", older.dump());
    CHECK(run("validate " + file + " --json").code == 0);
    CHECK_FALSE(run("validate " + file + " --json").json().contains("judgement"));

    const DesignFolder tight = folder_of("0.6");
    run("clearance " + tight.design() + " --pairs a:b,b:c --certificate " + tight.file("fit.certificate.json"));
    const Answer violated = run("validate " + tight.file("fit.certificate.json") + " --json");
    CHECK(violated.code == 1);
    CHECK(violated.json()["status"] == "accepted");
    CHECK(violated.json()["judgement"] == "violated");
    CHECK(violated.pair("b", "c")["status"] == "clear");
    // What is not proven is not judged.
    auto changed = nlohmann::ordered_json::parse(contents(tight.file("fit.certificate.json")));
    changed["pairs"][0]["lower"] = 1;
    tight.write("fit.certificate.json", changed.dump());
    const Answer rejected = run("validate " + tight.file("fit.certificate.json") + " --json");
    CHECK(rejected.json()["status"] == "rejected");
    CHECK_FALSE(rejected.json().contains("judgement"));
    CHECK_FALSE(rejected.json()["pairs"][0].contains("status"));
}

TEST_CASE("No certificate of a body inside another is accepted") {
    const DesignFolder folder(small_design,
                              scene_of({box_body("block", "static", "30", "[0, 0, 0]"), box_body("ball", "static", "1", "[0, 0, 0]"),
                                        box_body("far", "static", "1", "[40, 0, 0]")}));
    std::string text = contents(folder.file("small.scene.json"));
    text = replaced(text, "\"size_x\": 1, \"size_y\": 10, \"size_z\": 10", "\"size_x\": 1, \"size_y\": 1, \"size_z\": 1");
    folder.write("small.scene.json", text);
    const std::string file = folder.file("in.certificate.json");
    CHECK(run("clearance " + folder.file("small.scene.json") + " --minimum 0.3mm --pairs block:ball --certificate " + file).code == 1);
    const Answer answer = run("validate " + file + " --json");
    CHECK(answer.code == 1);
    CHECK(answer.json()["status"] == "rejected");
}

TEST_CASE("Margin curves: printed bounds are bounds") {
    const DesignFolder folder(
        small_design, scene_of({box_body("plate", "static", "1", "[0, 0, 0]"), box_body("block", "kinematic", "2", "[-20, 1, 1]")}));
    const std::string csv = folder.write("p.csv", head + "0,block,-20,1,1,0,0,0\n1,block,-10.1,1,1,0,0,0.1\n2,block,-7.7,1,1,0.2,0,0.1\n");
    const Answer answer =
        run("clearance " + folder.file("small.scene.json") + " --json --minimum 0.1mm --poses " + csv + " --csv " + folder.file("m.csv"));
    const Json pair = answer.pair("plate", "block");
    std::istringstream table(contents(folder.file("m.csv")));
    std::string line;
    std::getline(table, line);
    double least = 1e9;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        std::string field;
        for (int i = 0; i < 7; ++i) std::getline(fields, field, ',');
        least = std::min(least, std::stod(field));
    }
    CHECK(static_cast<double>(static_cast<long double>(least) * 1e-3L) <= pair.at("lower").get<double>() * (1 + 1e-3));
    CHECK(least > 0);
}

}  // namespace fettle::design::cli::clearance_honesty_test
