// SPDX-License-Identifier: MIT
// Quasi-static motion of a whole mechanism: the motor's work over a turn is the piston's force times the way that geometry says, crank
// radius r and rod length l, x(t) = r cos t + sqrt(l^2 - (r sin t)^2), but for the motion lost in the play of the joints.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/examples/example_scene.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::examples::slider_crank_force_test {

namespace {

using Json = nlohmann::json;
using tests::design_support::scene_of_example;

struct Drive {
    double time, torque;
};

// The crank's torque about z, from drives.csv (time, body, fx, fy, fz, tx, ty, tz).
std::vector<Drive> crank_drives(const std::string& path) {
    std::ifstream in(path);
    std::vector<Drive> drives;
    std::string line, field;
    while (std::getline(in, line)) {
        std::vector<std::string> fields;
        std::stringstream stream(line);
        while (std::getline(stream, field, ',')) fields.push_back(field);
        if (fields.size() == 8 && fields[1] == "crank") drives.push_back({std::stod(fields[0]), std::stod(fields[7])});
    }
    return drives;
}

}  // namespace

TEST_CASE("the slider-crank's torque does the work of the piston's force, within the play of its joints", "[slow]") {
    const tests::support::TemporaryFolder folder;
    Json scene = scene_of_example("slider_crank");
    const double r = 0.0135, l = 0.045, force = 20;
    // Twice the fits of the three joints that carry the force: how far the piston can be from where exact joints would hold it, and back.
    const double lost = 2 * 3 * 1e-4;
    scene["integrator"] = "quasi_static";
    scene["bodies"][3]["force"] = {-force, 0, 0};
    std::ofstream(folder.file("force.scene.json")) << scene;
    const auto answer =
        tests::support::run("simulate " + folder.file("force.scene.json") + " --steps 205 --quiet --out " + folder.file("out"));
    REQUIRE(answer.code == 0);
    const std::vector<Drive> drives = crank_drives(folder.file("out/drives.csv"));
    REQUIRE(drives.size() == 205);
    const double pi = std::acos(-1.0);
    const auto x = [&](double turn) { return r * std::cos(turn) + std::sqrt(l * l - r * r * std::sin(turn) * std::sin(turn)); };
    double work = 0, last = 0, largest = 0, least = 0;
    for (const Drive& drive : drives) {
        const double turn = 2 * pi * drive.time;
        work += drive.torque * (turn - last);
        last = turn;
        CAPTURE(drive.time, work, force * (x(turn) - x(0)));
        CHECK(std::abs(work - force * (x(turn) - x(0))) <= force * lost);
        largest = std::max(largest, drive.torque);
        least = std::min(least, drive.torque);
    }
    CHECK(largest > 0.9 * force * r);  // the force is carried, both ways
    CHECK(least < -0.9 * force * r);
}

}  // namespace fettle::design::examples::slider_crank_force_test
