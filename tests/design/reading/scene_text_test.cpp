// SPDX-License-Identifier: MIT
// A design that leaves as a scene has the numbers and the parts that the design has; that it can be simulated, and leave as a robot.
#include "design/reading/scene_text.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/scene_files/scene_reader.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::reading::scene_text_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contains;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using nlohmann::json;

}  // namespace

TEST_CASE("a design leaves as a scene with its numbers, its formulas and its parts, into another folder") {
    const DesignFolder folder(replaced(replaced(small_design, "\"value\": 10, \"lower\": 6", "\"value\": 11.7, \"lower\": 6"), "\"set\": {",
                                       "\"variables\": {\"gap\": \"0.12mm\"}, \"set\": {\"/bodies/wall/position\": [41, \"= gap\", 0],"),
                              replaced(small_scene, R"("part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 })",
                                       R"("part": "cube.part.json", "dimensions": { "size_x": 20, "size_z": 10 })"));
    folder.write("cube.part.json", R"({"fettle_part": 1, "dimensions": {"size_x": 20, "size_z": 10},
        "solid": {"extrude": {"rectangle": ["= size_x", 12]}, "from": "= -size_z / 2", "to": "= size_z / 2"}})");
    const std::string out = folder.file("out/tuned.scene.json");
    const Answer answer = run("export " + folder.design() + " --to " + out, true);
    INFO(answer.out);
    REQUIRE(answer.code == 0);
    const json text = json::parse(contents(out));
    CHECK(text["variables"]["height"] == "11.7 mm");
    CHECK(text["bodies"][1]["position"][2] == "= height / 2 + 0.12");
    CHECK(text["bodies"][1]["shape"]["part"] == "../cube.part.json");
    const auto scene = core::scene_files::read_scene(out, scene_read_options());
    REQUIRE(scene);
    CHECK(scene->bodies[1].pose.position.z() == Approx((11.7 / 2 + 0.12) * 1e-3));
    CHECK(scene->bodies[1].mesh.vertices.row(2).maxCoeff() == Approx(11.7e-3 / 2));
    CHECK(scene->bodies[2].pose.position.y() == Approx(0.12e-3));
    CHECK(run("simulate " + out + " --steps 2").code == 0);
    CHECK(run("export " + folder.file("small.scene.json") + " --to " + folder.file("other.scene.json"), true).says("is not a design"));

    const Answer robot = run("export " + folder.design() + " --to " + folder.file("tuned.urdf") + " --json");
    REQUIRE(robot.code == 0);
    CHECK(contains(robot.json()["warnings"].dump(), "`prescribed`, `fixed` and `script` of the bodies \\\"table\\\""));
    CHECK(contains(contents(folder.file("tuned.urdf")), "<mass value=\"" + json(1e-9 * 1000 * 20 * 12 * 11.7).dump().substr(0, 6)));
}

TEST_CASE("of a design with scenarios the first leaves as a scene, with what takes up its play") {
    const DesignFolder folder(replaced(small_design, "\"objective\": [",
                                       R"("scenarios": [{"name": "pressed", "play": "both", "along": [2, 0, 0], "press": 3,
                                           "set": {"/bodies/cube/angular_velocity": [5, 0, 0]}}], "objective": [)"));
    const std::string out = folder.file("out.scene.json");
    const Answer answer = run("export " + folder.design() + " --to " + out, true);
    INFO(answer.out);
    REQUIRE(answer.code == 0);
    CHECK(json::parse(contents(out))["gravity"] == json({3.0, 0.0, -9.81}));
    CHECK(json::parse(contents(out))["bodies"][1]["angular_velocity"] == json({5, 0, 0}));
}

TEST_CASE("the scenario that is asked for leaves, as a scene and as a robot; none of another name") {
    const DesignFolder folder(replaced(small_design, "\"objective\": [",
                                       R"("scenarios": [{"name": "one", "set": {"/timestep": 0.002}},
                                           {"name": "taken up", "play": "both", "along": [2, 0, 0], "press": 3},
                                           {"name": "last", "set": {"/timestep": 0.0025}}], "objective": [)"));
    const std::string there = "cd '" + folder.path.string() + "' && ";
    const std::map<std::string, double> steps{{"", 0.002}, {"--scenario one ", 0.002}, {"--scenario last ", 0.0025}};
    for (const auto& [asked, step] : steps) {
        const Answer answer = run(asked + "export " + folder.design() + " --to out.scene.json", true, there);
        INFO(asked << answer.out);
        REQUIRE(answer.code == 0);
        CHECK(json::parse(contents(folder.file("out.scene.json")))["timestep"] == json(step));
        std::filesystem::remove(folder.file("out.scene.json"));
    }
    const Answer backwards = run("--scenario 'taken up backwards' export " + folder.design() + " --to out.scene.json", true, there);
    INFO(backwards.out);
    REQUIRE(backwards.code == 0);
    CHECK(json::parse(contents(folder.file("out.scene.json")))["gravity"][0] == json(-3.0));
    for (const char* to : {"x.scene.json", "x.urdf"})
        CHECK(run("--scenario nosuch export " + folder.design() + " --to " + folder.file(to), true).code == 3);
}

TEST_CASE("what a scene cannot say of a design is refused by its place") {
    // The 1 of a design's variable counts in its unit, inches; in the scene it would be a millimetre.
    std::string design =
        replaced(replaced(small_design, "\"units\": \"mm\"", "\"units\": \"in\", \"variables\": {\"far\": \"= place + 1\"}"), "\"set\": {",
                 "\"set\": {\"/bodies/wall/position/1\": \"= far\",");
    for (const char* upper : {"14", "30", "20"})
        design = replaced(design, "\"upper\": " + std::string(upper) + " }", "\"upper\": " + std::string(upper) + ", \"unit\": \"mm\" }");
    const DesignFolder folder(design);
    const Answer answer = run("export " + folder.design() + " --to " + folder.file("out.scene.json"), true);
    INFO(answer.out);
    CHECK(answer.code == 3);
    CHECK(answer.says("#/bodies/2/position/1: differs from what the design has there"));
}

}  // namespace fettle::design::reading::scene_text_test
