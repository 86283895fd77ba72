// SPDX-License-Identifier: MIT
// Robust designs and allocations as users have them.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::robust_command_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

const std::string block = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.03,
    "bodies": [{"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";

// 0.1 g/mm: at least 1 g with 3 sigma of 0.01 g and 0.02 g.
const std::string heavy = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
    "parameters": [{"name": "size", "value": 9, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_x": "= size"},
    "objective": [{"type": "mass", "bodies": ["block"]}],
    "constraints": [{"type": "mass", "name": "weight", "bodies": ["block"], "lower": "1 g"}],
    "tolerances": {"size": "+-0.3 mm", "/bodies/block/density": {"lower": -60, "upper": 60}}, "over_tolerances": {"sigma": 3},
    "optimiser": {"max_evaluations": 40}})";

}  // namespace

TEST_CASE("optimise: a robust design, and its check") {
    const DesignFolder folder(heavy, block);
    const Answer told = run("optimise " + folder.design() + " --json --no-report --out " + folder.file("out"));
    INFO(told.out);
    REQUIRE(told.code == 0);
    const auto json = told.json();
    // L: mass L 0.1 g/mm; sigma of size 0.1 mm, of density 2%.
    double length = 10;
    for (int k = 0; k < 50; ++k) length = 10 + 3 * std::hypot(0.1, 0.02 * length);
    CHECK(json.at("parameters").at("size").get<double>() == Approx(length).epsilon(1e-3));
    const auto& weight = json.at("constraints").at(0);
    CHECK(weight.at("value").get<double>() == Approx(1e-3).epsilon(1e-3));
    CHECK_FALSE(weight.at("proven").get<bool>());
    CHECK(weight.at("over_tolerances").at("kind") == "sigma");
    CHECK(weight.at("over_tolerances").at("sigma") == 3);
    CHECK(weight.at("over_tolerances").at("tolerances") == 2);
    CHECK(weight.at("over_tolerances").at("drawn").get<double>() == Approx(length * 1e-4).epsilon(1e-3));
    const Answer text = run("optimise " + folder.design() + " --details --no-report --resume --out " + folder.file("out"));
    CHECK(text.out.find("required at least 1 g at 3 sigma of the tolerances: met: as drawn 1.07") != std::string::npos);
    CHECK(text.out.find("over 2 tolerances, to first order of the derivatives: computed, not proven") != std::string::npos);
    const Answer made = run("tolerance " + folder.file("out/design.final.json") + " --json");
    REQUIRE(made.code == 0);
    CHECK(made.json().at("responses").at(1).at("linear").at("yield").at("ppm_outside").get<double>() == Approx(1350).epsilon(0.02));
    const Answer gradient = run("gradient " + folder.design() + " --check");
    INFO(gradient.out);
    CHECK(gradient.code == 0);
    CHECK(gradient.out.find("as drawn 0.9 g") != std::string::npos);
}

TEST_CASE("tolerance --allocate: as text and as JSON, and its exit codes") {
    std::string room = heavy;
    room.replace(room.find("\"value\": 9"), 10, "\"value\": 11");
    const DesignFolder folder(room, block);
    const Answer told = run("tolerance " + folder.design() + " --allocate --samples 64 --json");
    INFO(told.out);
    REQUIRE(told.code == 0);
    const auto json = told.json();
    CHECK(json.at("status") == "held");
    CHECK(json.at("tolerances").size() == 2);
    CHECK(json.at("tolerances").at(0).at("factor").get<double>() > 1);
    CHECK(json.at("requirements").at(0).at("limiting").get<bool>());
    CHECK(json.at("requirements").at(0).at("predicted_yield").get<double>() == Approx(0.9973).margin(2e-5));
    CHECK(json.at("study").at("samples").at("count") == 64);
    CHECK(json.at("cost").get<double>() < json.at("cost_before").get<double>());
    const Answer text = run("tolerance " + folder.design() + " --allocate --yield 0.99");
    CHECK(text.code == 0);
    CHECK(text.out.find("times as loose") != std::string::npos);
    CHECK(text.out.find("yield of 99%") != std::string::npos);
    CHECK(text.out.find("it limits") != std::string::npos);
    const Answer worst = run("tolerance " + folder.design() + " --allocate --worst-case");
    CHECK(worst.code == 0);
    CHECK(worst.out.find("in the worst case") != std::string::npos);
    CHECK(worst.out.find("simulated 1") != std::string::npos);
    const DesignFolder light(heavy, block);
    const Answer none = run("tolerance " + light.design() + " --allocate");
    CHECK(none.code == 1);
    CHECK(none.out.find("weight: its mean does not lie within its bounds") != std::string::npos);
    CHECK(run("tolerance " + folder.design() + " --yield 0.9").code == 3);
    CHECK(run("tolerance " + folder.design() + " --allocate --yield 0.4").code == 3);
}

}  // namespace fettle::design::cli::robust_command_test
