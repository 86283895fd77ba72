// SPDX-License-Identifier: MIT
// The same mechanism by joints and by contact: the slider-crank's stroke and torque with pins in bores of three plays, extrapolated to
// none, and with revolute and prismatic joints in their places.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/examples/example_scene.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::examples::slider_crank_joints_test {

namespace {

using Json = nlohmann::json;
using tests::design_support::scene_of_example;
constexpr double r = 0.0135, l = 0.045, force = 20;
constexpr int steps = 205;

// The turn after the first tenth, in which play is taken up. Torques are means: pins and bores of 64 flats let them ripple by 8%.
struct Turn {
    double stroke = 0;                  // [m]
    double way_out = 0, back = 0;       // mean torque of the crank's motor while the piston goes out, and most of its way back [N m]
    std::array<double, 4> strongest{};  // and over tenths of the turn about its extremes
};

std::vector<std::vector<std::string>> rows_of(const std::string& path) {
    std::ifstream in(path);
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(in, line);) {
        std::vector<std::string> fields;
        std::stringstream stream(line);
        for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
        rows.push_back(fields);
    }
    return rows;
}

// @param torque_column  of the table's rows that are the drive's.
Turn simulated(const Json& scene, const std::string& table, const std::string& drive, std::size_t torque_column) {
    const tests::support::TemporaryFolder folder;
    std::ofstream(folder.file("a.scene.json")) << scene;
    const auto answer = tests::support::run("simulate " + folder.file("a.scene.json") + " --steps " + std::to_string(steps) +
                                                " --quiet --out " + folder.file("out") + " --poses " + folder.file("poses.csv"),
                                            true);
    INFO(answer.out);
    REQUIRE(answer.code == 0);
    Turn turn;
    constexpr double settled = 0.1;
    double low = 1e9, high = -1e9;
    for (const auto& row : rows_of(folder.file("poses.csv"))) {
        if (row.size() < 3 || row[1] != "piston" || std::stod(row[0]) < settled) continue;
        low = std::min(low, std::stod(row[2]));
        high = std::max(high, std::stod(row[2]));
    }
    turn.stroke = (high - low) * 1e-3;  // the poses are in the scene's mm
    std::vector<std::pair<double, double>> torques;
    for (const auto& row : rows_of(folder.file("out/" + table)))
        if (row.size() > torque_column && row[1] == drive) torques.emplace_back(std::stod(row[0]), std::stod(row[torque_column]));
    REQUIRE(torques.size() == steps);
    const auto mean = [&](double from, double to) {
        double sum = 0;
        int count = 0;
        for (const auto& [time, torque] : torques) {
            if (!(time > from + 1e-6 && time < to + 1e-6)) continue;
            sum += torque;
            ++count;
        }
        return sum / count;
    };
    turn.way_out = mean(0.5, 1);
    turn.back = mean(settled, 0.45);
    turn.strongest = {mean(0.15, 0.25), mean(0.2, 0.3), mean(0.65, 0.75), mean(0.7, 0.8)};
    return turn;
}

Json loaded_scene() {
    Json scene = scene_of_example("slider_crank");
    scene["integrator"] = "quasi_static";
    scene.erase("loads");  // the force below is all that acts
    scene["bodies"][3]["force"] = {-force, 0, 0};
    return scene;
}

// Pins thinner than their bores by `play` [mm] in radius.
Turn by_contact(double play) {
    Json scene = loaded_scene();
    scene["contact"]["dhat"] = 0.8 * play;
    for (Json& body : scene["bodies"]) body["shape"]["counts"] = {{"segments", 64}};
    scene["bodies"][1]["shape"]["dimensions"]["journal_radius"] = 5.4 - play;
    scene["bodies"][1]["shape"]["dimensions"]["crank_pin_radius"] = 4.4 - play;
    scene["bodies"][3]["shape"]["dimensions"]["wrist_pin_radius"] = 3.4 - play;
    scene["bodies"][3]["shape"]["dimensions"]["piston_radius"] = 10 - play;
    return simulated(scene, "drives.csv", "crank", 7);
}

Json jointed_scene() {
    Json scene = loaded_scene();
    for (Json& body : scene["bodies"]) body["group"] = "all";
    scene["bodies"][1].erase("prescribed");
    const auto joint = [](const char* name, const char* type, const Json& point, const Json& axis) {
        return Json{{"name", name}, {"type", type}, {"point", point}, {"axis", axis}};
    };
    Json main = joint("main", "revolute", {0, 0, 0}, {0, 0, 1}), big = joint("big", "revolute", {13.5, 0, 0}, {0, 0, 1}),
         small = joint("small", "revolute", {58.5, 0, 0}, {0, 0, 1}), guide = joint("guide", "prismatic", {58.5, 0, 0}, {1, 0, 0});
    main["b"] = "crank";
    big["a"] = "crank";
    big["b"] = "rod";
    small["a"] = "rod";
    small["b"] = "piston";
    guide["b"] = "piston";
    scene["joints"] = Json::array({main, big, small, guide});
    scene["motors"] = Json::array({Json{{"name", "drive"}, {"joint", "main"}, {"speed", 360}}});
    return scene;
}

Turn by_joints() { return simulated(jointed_scene(), "joints.csv", "drive", 8); }

// The value at 0 of the parabola through f(p), f(p/2), f(p/4).
double at_none(double whole, double half, double quarter) { return (8 * quarter - 6 * half + whole) / 3; }

}  // namespace

TEST_CASE("the slider-crank by joints is trigonometry's") {
    const Turn ideal = by_joints();
    CHECK(ideal.stroke == Approx(2 * r).epsilon(1e-9));
    // Virtual work: the torque is F dx/dt, x = r cos t + sqrt(l^2 - (r sin t)^2), here at each step's end.
    const auto torque = [&](double t) {
        const double s = std::sin(t), c = std::cos(t);
        return -force * (r * s + r * r * s * c / std::sqrt(l * l - r * r * s * s));
    };
    double out = 0, strongest = 0;
    for (int i = 101; i <= 200; ++i) out += torque(2 * M_PI * i / 200) / 100;
    for (int i = 31; i <= 50; ++i) strongest += torque(2 * M_PI * i / 200) / 20;
    CHECK(ideal.way_out == Approx(out).epsilon(1e-6));
    CHECK(ideal.strongest[0] == Approx(strongest).epsilon(1e-6));
}

TEST_CASE("the slider-crank's loop is followed without dynamics, as with") {
    const tests::support::TemporaryFolder folder;
    std::ofstream(folder.file("a.scene.json")) << jointed_scene();
    const std::string command = "clearance " + folder.file("a.scene.json") + " --json --steps 60 --pairs crank:piston,block:rod ";
    const auto kinematic = tests::support::run(command + "--kinematic"), simulated = tests::support::run(command + "--motion");
    for (const auto& [a, b] : {std::pair<const char*, const char*>{"crank", "piston"}, {"block", "rod"}}) {
        const Json one = kinematic.pair(a, b), other = simulated.pair(a, b);
        REQUIRE(!one.is_null());
        REQUIRE(!other.is_null());
        CHECK(one["upper"].get<double>() == Approx(other["upper"].get<double>()).margin(2e-5));  // of steps of 1.8 degrees
        CHECK(one["lower"].get<double>() > 0);
    }
    bool told = false;
    const Json report = kinematic.json();
    for (const Json& note : report.at("notes")) {
        const auto text = note.get<std::string>();
        told = told || (text.find("part by at most") != std::string::npos &&
                        text.find("bounds hold for joints met at all times") != std::string::npos);
    }
    CHECK(told);
    CHECK(kinematic.pair("crank", "piston")["joint_charge"].get<double>() > 0);
}

TEST_CASE("the slider-crank by contact of less and less play is that by joints, within 1%", "[slow]") {
    const Turn ideal = by_joints(), whole = by_contact(0.2), half = by_contact(0.1), quarter = by_contact(0.05);
    const auto agrees = [&](double by_joint, double at_whole, double at_half, double at_quarter) {
        CAPTURE(by_joint, at_whole, at_half, at_quarter);
        CHECK(at_none(at_whole, at_half, at_quarter) == Approx(by_joint).epsilon(0.01));
    };
    agrees(ideal.stroke, whole.stroke, half.stroke, quarter.stroke);
    agrees(ideal.way_out, whole.way_out, half.way_out, quarter.way_out);
    agrees(ideal.back, whole.back, half.back, quarter.back);
    for (std::size_t i = 0; i < 4; ++i) agrees(ideal.strongest[i], whole.strongest[i], half.strongest[i], quarter.strongest[i]);
}

}  // namespace fettle::design::examples::slider_crank_joints_test
