// SPDX-License-Identifier: MIT
// What `simulate` says and leaves behind: "ok" for a proven path only, steps that are never lost, and refusals before the work.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::simulate_command_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::run;

const char* const cube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";

struct SceneFolder : fettle::tests::support::TemporaryFolder {
    SceneFolder() { write("cube.obj", cube); }
    /// A cube that falls past another; `more` bodies.
    std::string scene(const std::string& more = "", const std::string& gravity = "-10", const std::string& name = "fall.scene.json") const {
        return write(name, R"({"fettle_scene": 1, "units": "m", "gravity": [0, 0, )" + gravity +
                               R"(], "timestep": 0.3, "end_time": 1, "bodies": [
            {"name": "cube", "type": "dynamic", "mesh": "cube.obj", "density": 1000},
            {"name": "below", "type": "static", "mesh": "cube.obj", "position": [5, 0, -50]})" +
                               more + "]}");
    }
    std::string contents(const std::string& name) const { return fettle::tests::support::contents(path / name); }
    int steps(const std::string& name) const {
        std::ifstream stream(path / name);
        int count = 0;
        for (std::string line; std::getline(stream, line);) count += nlohmann::json::parse(line).contains("nodes") ? 1 : 0;
        return count;
    }
};

}  // namespace

TEST_CASE("simulate: the answer of many bodies is written as that of few") {
    const SceneFolder folder;
    std::string more;
    for (int i = 0; i < 150; ++i) {
        more += R"(, {"name": "\"many \u00e9 )" + std::to_string(i) + R"(", "type": "static", "mesh": "cube.obj", "position": [)" +
                std::to_string(10 + 3 * i) + ", 0, 0.1]}";
    }
    const Answer answer = run("simulate " + folder.scene(more) + " --steps 1 --json");
    const auto json = nlohmann::ordered_json::parse(answer.out);
    REQUIRE(json["bodies"].size() == 152);
    CHECK(json["bodies"][151]["name"] == "\"many \u00e9 149");
    CHECK(answer.out == json.dump(2) + "\n");
}

TEST_CASE("simulate: steps cover the end time, and the times of all it did are told") {
    const SceneFolder folder;
    const Answer answer = run("simulate " + folder.scene() + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.json()["steps"] == 4);
    CHECK(answer.json()["certification"] == "proven");
    CHECK(answer.json()["minimum_distance"].get<double>() > 0);
    for (const char* key : {"start_seconds", "wall_seconds", "certify_seconds"}) CHECK(answer.json()[key].get<double>() >= 0);
    CHECK(run("simulate " + folder.scene() + " --time 1 --json").json()["steps"] == 4);
}

TEST_CASE("simulate: in a cup without a lid surfaces are proven apart, and what that does not say is said") {
    const SceneFolder folder;
    const std::string faces = std::string(cube).substr(0, std::string(cube).find("f 5 6 8")) + "f 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\n" +
                              "f 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
    folder.write("cup.obj", faces);
    const std::string scene = folder.write("cup.scene.json", R"({"fettle_scene": 1, "units": "m", "timestep": 0.01, "end_time": 0.05,
        "gravity": [0, 0, -10], "bodies": [
        {"name": "cube", "type": "dynamic", "mesh": "cube.obj", "density": 1000, "position": [0.5, 0.5, 0.1]},
        {"name": "cup", "type": "static", "mesh": "cup.obj", "scale": 2}]})");
    const Answer answer = run("simulate " + scene + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.json()["status"] == "ok");
    CHECK(answer.json()["certification"] == "surfaces proven");
    CHECK(answer.json()["minimum_distance"].get<double>() > 0.05);
    CHECK(answer.json()["message"].get<std::string>().find("of \"cube\" and \"cup\": whether one lies inside the other") !=
          std::string::npos);
    CHECK(run("simulate " + scene).says("smallest distance of two surfaces over the path: at least"));
}

TEST_CASE("simulate: where no pair may collide there is no least distance, and that is said") {
    const SceneFolder folder;
    const std::string scene = folder.write("alone.scene.json", R"({"fettle_scene": 1, "units": "m", "timestep": 0.1, "end_time": 0.2,
        "bodies": [{"name": "cube", "type": "dynamic", "mesh": "cube.obj", "density": 1000}]})");
    const Answer answer = run("simulate " + scene + " --json");
    CHECK(answer.code == 0);
    CHECK(answer.json()["status"] == "ok");
    CHECK(answer.json()["minimum_distance"].is_null());
    CHECK(answer.json()["certification"] == "no pair may collide");
    CHECK(run("simulate " + scene).says("no two bodies may collide"));
}

TEST_CASE("simulate: bodies that nothing keeps apart are warned of") {
    const SceneFolder folder;
    const std::string clash =
        R"(, {"name": "gate", "type": "kinematic", "mesh": "cube.obj", "position": [5.5, 0.5, -50.5], "prescribed": {"px": {"rate": 1}}})";
    const Answer answer = run("simulate " + folder.scene(clash) + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    REQUIRE(answer.json()["warnings"].size() == 1);
    CHECK(answer.json()["warnings"][0].get<std::string>().find("gate") != std::string::npos);
    CHECK_FALSE(run("simulate " + folder.scene("", "0") + " --json").json().contains("warnings"));
    // Four steps of implicit Euler take a fifth of what a fall of a second gives.
    const nlohmann::json fall = run("simulate " + folder.scene() + " --json").json();
    REQUIRE(fall["warnings"].size() == 1);
    CHECK(fall["warnings"][0].get<std::string>().find("the time integration has lost 1.8e+04 J, 20% of") == 0);
    CHECK(fall["status"] == "ok");
}

TEST_CASE("simulate: a run is taken up, never back") {
    const SceneFolder folder;
    const std::string scene = folder.scene(), out = folder.file("run"), stored = out + "/trajectory.json";
    CHECK(run("simulate " + scene + " --steps 40 --out " + out).code == 0);
    CHECK(folder.steps("run/trajectory.json") == 40);
    const Answer back = run("simulate " + scene + " --continue " + stored + " --steps 10 --out " + out, true);
    CHECK(back.code == 3);
    CHECK(back.says("has 40 steps"));
    CHECK(folder.steps("run/trajectory.json") == 40);
    CHECK(run("simulate " + scene + " --continue " + stored + " --steps 45 --out " + out).code == 0);
    CHECK(folder.steps("run/trajectory.json") == 45);
    CHECK(run("simulate " + scene + " --steps 45 --out " + folder.file("whole")).code == 0);
    CHECK(folder.contents("run/trajectory.json") == folder.contents("whole/trajectory.json"));

    // A shorter run of its own does not cost the longer one.
    CHECK(run("simulate " + scene + " --steps 3 --out " + out).code == 0);
    CHECK(folder.steps("run/trajectory.json") == 3);
    CHECK(folder.steps("run/trajectory.1.json") == 45);

    folder.write("old/trajectory.json", "{\"fettle_trajectory\": 1,\n\"steps\": []}\n");  // of unknown length
    CHECK(run("simulate " + scene + " --steps 3 --out " + folder.file("old")).code == 0);
    CHECK(folder.contents("old/trajectory.1.json").find("\"steps\": []") != std::string::npos);

    const Answer other = run(
        "simulate " + folder.scene("", "-5", "other.scene.json") + " --continue " + folder.file("whole/trajectory.json") + " --steps 50",
        true);
    CHECK(other.code == 3);
    CHECK(other.says("gravity"));
}

TEST_CASE("simulate: a run that was killed in the middle of a line is taken up") {
    const SceneFolder folder;
    const std::string scene = folder.scene(), out = folder.file("run");
    CHECK(run("simulate " + scene + " --steps 40 --out " + out).code == 0);
    const std::string whole = folder.contents("run/trajectory.json");
    // As if written step by step: the checkpoint after its step, and the last line cut off.
    const std::size_t checkpoint = whole.find("{\"checkpoint\"");
    std::string text = whole.substr(0, checkpoint);
    std::string killed = whole.substr(checkpoint), lines = text.substr(0, text.size() - 100);
    std::size_t at = lines.find('\n');
    for (int step = 0; step < 32; ++step) at = lines.find('\n', at + 1);
    lines.insert(at + 1, killed);
    folder.write("killed.json", lines);
    const Answer answer =
        run("simulate " + scene + " --continue " + folder.file("killed.json") + " --steps 40 --out " + folder.file("again"), true);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.says("ends in the middle of a line"));
    CHECK(folder.contents("again/trajectory.json") == whole);
}

TEST_CASE("simulate: a folder that cannot be written to is told before the work") {
    const SceneFolder folder;
    folder.write("file", "");
    for (const std::string& option :
         {"--out " + folder.file("file") + "/run", "--poses " + folder.file("file") + "/poses.csv", "--poses " + folder.path.string()}) {
        const Answer answer = run("simulate " + folder.scene() + " --steps 1000000000 " + option + " --json");
        CHECK(answer.code == 3);
        CHECK(answer.json()["errors"][0]["code"] == "file_unwritable");
    }
}

}  // namespace fettle::design::cli::simulate_command_test
