// SPDX-License-Identifier: MIT
// Commands that are given a STEP file (written by tests/core/step_importer/step_samples.cpp).
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::step_command_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

#ifndef FETTLE_STEP_SAMPLES
#define FETTLE_STEP_SAMPLES ""
#endif
bool has_open_cascade() { return std::string(FETTLE_STEP_SAMPLES) != ""; }

struct Samples : TemporaryFolder {
    Samples() { REQUIRE(std::system(("'" FETTLE_STEP_SAMPLES "' write '" + path.string() + "' >/dev/null 2>&1").c_str()) == 0); }
};

}  // namespace

TEST_CASE("STEP commands: without Open CASCADE each says what to install") {
    if (has_open_cascade()) return;
    const TemporaryFolder folder;
    const std::string file = folder.write("a.step", "ISO-10303-21;");
    for (const std::string& command : std::vector<std::string>{"validate ", "clearance ", "draw --out " + folder.file("a.png") + " ",
                                                               "import --to " + folder.file("x.scene.json") + " "}) {
        const Answer answer = run(command + file, true);
        CAPTURE(answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says("apt-get install libocct-data-exchange-dev"));
    }
}

TEST_CASE("STEP commands: validate lists solids, and what the deviations rest on") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const Samples samples;
    const Answer text = run("validate " + samples.file("assembly.step"));
    CAPTURE(text.out);
    CHECK(text.code == 0);
    CHECK(text.says("pin#4"));
    CHECK(text.says("tolerances that the file declares"));
    const nlohmann::json json = run("validate " + samples.file("assembly.step") + " --json").json();
    REQUIRE(json.at("items").size() == 5);
    const nlohmann::json pin = json.at("items").at(1);
    CHECK(pin.at("name") == "pin");
    CHECK(pin.at("colour") == "#0000ff");
    CHECK(pin.at("faces") == nlohmann::json{{"cylinder", 1}, {"plane", 2}});
    CHECK(pin.at("deviation").at("out_is_proven") == true);
    CHECK(pin.at("deviation").at("declared").get<double>() > 0);
    CHECK(run("validate " + samples.file("assembly.step") + " --facets 1um --json").json().at("items").at(1).at("deviation").at("out") <
          pin.at("deviation").at("out"));
    CHECK(run("validate " + samples.file("open_shell.step"), true).code == 3);
}

TEST_CASE("STEP commands: clearance of an assembly's solids, of the true surfaces") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const Samples samples;
    const Answer answer = run("clearance " + samples.file("assembly.step") + " --minimum 0.4mm --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    const nlohmann::json above = answer.pair("plate", "pin");
    CHECK(above.at("lower").get<double>() == Approx(0.5e-3).margin(2e-6));
    const nlohmann::json beside = answer.pair("pin", "pin#2").at("true_surfaces");
    CHECK(beside.at("lower").get<double>() <= 6e-3);
    CHECK(beside.at("upper").get<double>() >= 6e-3);
    CHECK(beside.at("upper").get<double>() - beside.at("lower").get<double>() < 10e-6);
    CHECK(beside.at("lower_is_proven") == true);
    CHECK(answer.json().at("deviations").at("pin").at("declared").get<double>() > 0);
    CHECK(run("clearance " + samples.file("assembly.step") + " --minimum 0.6mm").code == 1);
}

TEST_CASE("STEP commands: import makes a scene whose bodies are the solids") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const Samples samples;
    const std::string scene = samples.file("assembly.scene.json");
    const Answer made = run("import " + samples.file("assembly.step") + " --to " + scene, true);
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    const nlohmann::json bodies = nlohmann::json::parse(fettle::tests::support::contents(scene)).at("bodies");
    REQUIRE(bodies.size() == 5);
    CHECK(bodies.at(2).at("mesh") == "assembly.step");
    CHECK(bodies.at(2).at("mesh_item") == "pin#2");
    const Answer answer = run("clearance " + scene + " --pairs plate:pin#3 --minimum 0.4mm --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(run("draw " + samples.file("assembly.step") + " --out " + samples.file("a.png")).code == 0);
    CHECK(std::filesystem::file_size(samples.file("a.png")) > 1000);
    const std::string wrong = samples.write(
        "wrong.scene.json",
        R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "a", "type": "static", "mesh": "assembly.step", "mesh_item": "bolt"}]})");
    const Answer refused = run("validate " + wrong, true);
    CHECK(refused.code == 3);
    CHECK(refused.says("`pin#2`"));
}

}  // namespace fettle::design::cli::step_command_test
