// SPDX-License-Identifier: MIT
// A run that is killed leaves what it did, and goes on with the same bits; progress and log.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::growing_trajectory_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

/// Whole ones: a run that is killed may leave a part of a line.
int steps_in(const std::filesystem::path& path) {
    const std::string text = contents(path);
    int count = 0;
    for (std::size_t at = text.find("{\"nodes\""); at != std::string::npos; at = text.find("{\"nodes\"", at + 1))
        if (text.find('\n', at) != std::string::npos) ++count;
    return count;
}

std::string scene(const TemporaryFolder& folder) {
    return folder.write("spin.scene.json", R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.001, "bodies": [
        {"name": "ground", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 200, "size_y": 200}}, "position": [0, 0, -10.1]},
        {"name": "pin", "density": 1000, "shape": {"part": "cylinder"}, "position": [0, 0, 10.5], "angular_velocity": [40, 10, 5]}]})");
}

/// Starts the program and kills it once its running file has this many steps. @return false if it ended before.
bool killed_after(int steps, const std::vector<std::string>& arguments, const std::filesystem::path& file) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::vector<char*> words{const_cast<char*>(FETTLE_PROGRAM)};
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        ::execv(FETTLE_PROGRAM, words.data());
        ::_exit(127);
    }
    int status = 0;
    while (steps_in(file) < steps) {
        if (::waitpid(child, &status, WNOHANG) == child) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

}  // namespace

TEST_CASE("simulate: a killed run leaves its steps, and goes on with the same bits") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), whole = folder.file("whole"), cut = folder.file("cut");
    REQUIRE(run("simulate " + in + " --steps 150 --out " + whole).code == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path / "whole/trajectory.running.json"));
    const auto running = folder.path / "cut/trajectory.running.json";
    REQUIRE(killed_after(40, {"simulate", in, "--steps", "100000", "--out", cut, "--quiet", "--json"}, running));
    CHECK_FALSE(std::filesystem::exists(folder.path / "cut/trajectory.json"));
    const Answer usable = run("validate " + running.string() + " --json");
    CAPTURE(usable.out);
    CHECK(usable.json()["kind"] == "trajectory");
    CHECK(usable.json()["steps"].get<int>() >= 40);
    const int done = usable.json()["steps"].get<int>();

    // A run of its own in this folder keeps what the killed one left.
    std::filesystem::copy(cut, folder.file("other"));
    REQUIRE(run("simulate " + in + " --steps 3 --out " + folder.file("other")).code == 0);
    CHECK(steps_in(folder.path / "other/trajectory.running.1.json") == done);
    CHECK_FALSE(std::filesystem::exists(folder.path / "other/trajectory.running.json"));

    // Killed again on its way, it goes on from there.
    REQUIRE(killed_after(done + 40, {"simulate", in, "--steps", "100000", "--out", cut, "--continue", cut, "--quiet", "--json"}, running));
    CHECK_FALSE(std::filesystem::exists(folder.path / "cut/trajectory.running.1.json"));
    const std::string goal = std::to_string(std::max(150, steps_in(running)));
    REQUIRE(run("simulate " + in + " --steps " + goal + " --out " + cut + " --continue " + cut).code == 0);
    REQUIRE(run("simulate " + in + " --steps " + goal + " --out " + whole).code == 0);
    CHECK(contents(folder.path / "cut/trajectory.json") == contents(folder.path / "whole/trajectory.json"));
    CHECK(contents(folder.path / "cut/motion.glb") == contents(folder.path / "whole/motion.glb"));
    // Its tables begin where it was taken up, for a killed run leaves none; what is there is the same.
    const std::string steps = contents(folder.path / "whole/steps.csv"), taken_up = contents(folder.path / "cut/steps.csv");
    const std::string rows = taken_up.substr(taken_up.find('\n') + 1);
    CHECK(rows.size() > 100);
    CHECK(steps.ends_with(rows));
    CHECK(static_cast<int>(std::count(steps.begin(), steps.end(), '\n')) == std::stoi(goal) + 1);
    CHECK_FALSE(std::filesystem::exists(running));
    // A folder whose run is whole is continued from its trajectory.
    CHECK(run("simulate " + in + " --steps " + std::to_string(std::stoi(goal) + 5) + " --out " + cut + " --continue " + cut).code == 0);
    CHECK(steps_in(folder.path / "cut/trajectory.json") == std::stoi(goal) + 5);
}

TEST_CASE("simulate: a killed run that goes on does not take over the tables of another run in its folder") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), out = folder.file("out");
    REQUIRE(run("simulate " + in + " --steps 20 --out " + out).code == 0);
    const std::filesystem::path running = folder.path / "out/trajectory.running.json";
    REQUIRE(killed_after(40, {"simulate", in, "--steps", "100000", "--out", out, "--quiet", "--json"}, running));
    REQUIRE(run("simulate " + in + " --steps " + std::to_string(steps_in(running) + 5) + " --out " + out + " --continue " + out).code == 0);
    const std::string steps = contents(folder.path / "out/steps.csv");
    CHECK(std::stod(steps.substr(steps.find('\n') + 1)) > 0.03);  // seconds: from the checkpoint on, without the other run's first steps
}

TEST_CASE("simulate: --log has the narration, --quiet or not; elsewhere than on a terminal there is no bar") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), log = folder.file("logs/a.txt");
    const Answer answer = run("simulate " + in + " --steps 3 --quiet --log " + log, true);
    CHECK(answer.code == 0);
    CHECK_FALSE(answer.says("certifying"));
    CHECK_FALSE(answer.says("\r"));
    CHECK(contents(log).find("certifying the path") != std::string::npos);
    CHECK(run("simulate " + in + " --steps 3 --log " + folder.path.string()).code == 3);
}

}  // namespace fettle::design::cli::growing_trajectory_test
