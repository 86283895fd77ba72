// SPDX-License-Identifier: MIT
// `fettle import` of meshes from outside: bodies, solids, items, joints from fits, refusals. (Robots: tests/design/urdf; STEP:
// step_command_test.)
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/geometry/mesh_transforms.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "tests/core/features/known_parts.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::import_command_test {

using namespace core::features::known_parts;  // NOLINT(google-build-using-namespace)
using core::geometry::Mesh;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;
using Json = nlohmann::json;

namespace {

Mesh mesh_of(const std::function<Result<Solid>(Drawing&)>& part, const std::string& name) { return drawn_mesh(part, Lean::cover, name); }

Mesh box_mesh(const Vector3& low, const Vector3& high) {
    return mesh_of(
        [&](Drawing& drawing) {
            return extruded(drawing, *filled(rectangle({low.x(), low.y()}, high.x() - low.x(), high.y() - low.y(), "box")), low.z(),
                            high.z());
        },
        "box");
}

// A flap that turns on a headed pin in a wall, from 10 degrees before to 90 after where it is drawn: blocks stop it.
struct Flap : TemporaryFolder {
    std::string parts;
    Flap() {
        const Mesh wall = mesh_of(
            [](Drawing& d) {
                const Profile plate =
                    *with_hole(*filled(rectangle({-20 * mm, -20 * mm}, 60 * mm, 40 * mm, "plate")), circle({}, 2.1 * mm, "bore"));
                const Profile stop = *filled(rectangle({12 * mm, 6 * mm}, 6 * mm, 6 * mm, "stop"));
                return stacked(d, {{plate, 0, 5 * mm, {}, {}, "plate"}, {stop, 5 * mm, 12 * mm, {}, {}, "stop"}});
            },
            "wall");
        const Mesh flap = mesh_of(
            [](Drawing& d) {
                const Profile arm = *filled(rectangle({-4 * mm, -4 * mm}, 30 * mm, 8 * mm, "arm"));
                const Profile shaft = *filled(circle({}, 1.9 * mm, "shaft")), head = *filled(circle({}, 4 * mm, "head"));
                return stacked(d, {{head, -3 * mm, -0.3 * mm, {}, {}, "head"},
                                   {shaft, -0.3 * mm, 5.3 * mm, {}, {}, "shaft"},
                                   {arm, 5.3 * mm, 9 * mm, {}, {}, "arm"}});
            },
            "flap");
        parts = write("flap.3mf", *core::mesh_files::threemf_bytes({{"wall", &wall}, {"flap", &flap}}));
    }
};

}  // namespace

TEST_CASE("import --joints: a flap on a pin turns until it meets its stop") {
    const Flap files;
    const std::string scene = files.file("flap.scene.json");
    const auto made = run("import " + files.parts + " --joints --to " + scene + " --json");
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    const Json answer = made.json();
    CHECK(answer["grounds"] == Json({"wall"}));
    CHECK(answer["unjoined"].empty());
    REQUIRE(answer["joints"].size() == 1);
    const Json joint = answer["joints"][0];
    CHECK(joint["type"] == "revolute");
    CHECK(joint["name"] == "wall-flap");
    CHECK(joint["reason"].get<std::string>().find("flap.P2 in wall.B1; held both ways along the axis: ") == 0);
    // The stop's corner (18, 6) mm is met by the arm's edge y = 4 mm: asin(6 / r) - asin(4 / r), r = |(18, 6)| mm.
    const double r = std::hypot(18, 6), expected = (std::asin(6 / r) - std::asin(4 / r)) * 180 / std::numbers::pi;
    REQUIRE(joint["limits"].is_array());
    const double upper = std::stod(joint["limits"][1].get<std::string>()), lower = std::stod(joint["limits"][0].get<std::string>());
    CHECK(upper <= expected);
    CHECK(upper > expected - 0.02);
    CHECK(lower < -90);
    // The scene says the same, and is ready for the next command.
    const Json written = Json::parse(contents(scene));
    CHECK(written["bodies"][0]["mesh"] == "flap.3mf");
    CHECK(written["bodies"][0]["mesh_item"] == "wall");
    CHECK(written["bodies"][0]["type"] == "static");
    CHECK(written["bodies"][1]["density"] == 1240);
    CHECK(written["joints"][0]["limits"] == joint["limits"]);
    CHECK(run("clearance " + scene + " --minimum 0.15mm --pairs flap:wall").code == 0);
    CHECK(run("clearance " + scene + " --minimum 0.25mm --pairs flap:wall").code == 1);
    CHECK(run("simulate " + scene + " --steps 3").code == 0);
    CHECK(run("validate " + scene).code == 0);
    // The user chooses which of the two stands, and the density of the other.
    const auto other = run("import " + files.parts + " --joints --ground flap --density '7.85 g/cm^3' --to " + scene + " --json");
    CHECK(other.json()["grounds"] == Json({"flap"}));
    CHECK(Json::parse(contents(scene))["bodies"][0]["density"] == Approx(7850));
}

TEST_CASE("import: meshes as bodies; items of one name, solids of one mesh") {
    TemporaryFolder files;
    const Mesh a = box_mesh({0, 0, 0}, {10 * mm, 10 * mm, 10 * mm}), b = box_mesh({12 * mm, 0, 0}, {20 * mm, 10 * mm, 10 * mm});
    const std::string scene = files.file("x.scene.json");
    files.write("both.3mf", *core::mesh_files::threemf_bytes({{"box", &a}, {"box", &b}}));
    REQUIRE(run("import " + files.file("both.3mf") + " --to " + scene).code == 0);
    Json bodies = Json::parse(contents(scene))["bodies"];
    REQUIRE(bodies.size() == 2);
    CHECK(bodies[1]["mesh_item"] == "box#2");
    CHECK(run("clearance " + scene + " --minimum 1.9mm").code == 0);
    CHECK(run("clearance " + scene + " --minimum 2.1mm").code == 1);
    // The same, as one mesh of two solids.
    files.write("one.stl", core::mesh_files::stl_bytes({{"a", &a}, {"b", &b}}));
    REQUIRE(run("import " + files.file("one.stl") + " --unit mm --split --to " + scene).code == 0);
    bodies = Json::parse(contents(scene))["bodies"];
    REQUIRE(bodies.size() == 2);
    CHECK(bodies[0]["name"] == "one#1");
    CHECK(bodies[1]["mesh_solid"] == 2);
    CHECK_FALSE(bodies[1].contains("mesh_item"));
    CHECK(run("clearance " + scene + " --minimum 1.9mm").code == 0);
    CHECK(run("clearance " + scene + " --minimum 2.1mm").code == 1);
    const std::string beyond = files.write(
        "beyond.scene.json",
        R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "a", "type": "static", "mesh": "one.stl", "mesh_solid": 3}]})");
    const auto refused = run("validate " + beyond, true);
    CHECK(refused.code == 3);
    CHECK(refused.says("the mesh has 2 solids"));
    // Whole, without a fit: nothing is proposed, and it is said.
    const auto none = run("import " + files.file("both.3mf") + " --joints --to " + scene);
    CHECK(none.code == 0);
    CHECK(none.says("no joints: nothing fits in anything"));
}

TEST_CASE("import --ignore-overlaps: what passes through each other is listed in the scene, which then can be simulated") {
    const Flap files;
    const Mesh block = box_mesh({20 * mm, -2 * mm, 8 * mm}, {24 * mm, 2 * mm, 12 * mm});
    files.write("block.3mf", *core::mesh_files::threemf_bytes({{"block", &block}}));
    const std::string scene = files.file("x.scene.json");
    const std::string import = "import " + files.parts + " " + files.file("block.3mf") + " --joints --to " + scene;
    const auto told = run(import, true);
    CHECK(told.code == 0);
    CHECK(told.says("as assembled 1 pair of bodies pass through each other"));
    CHECK(run("validate " + scene).code == 3);
    const auto ignored = run(import + " --ignore-overlaps", true);
    CHECK(ignored.code == 0);
    CHECK(ignored.says("1 pair of bodies that pass through each other as assembled are ignored"));
    CHECK(Json::parse(contents(scene))["ignore"] == Json({"flap:block"}));
    CHECK(run("validate " + scene).code == 0);
}

TEST_CASE("import: what is refused") {
    const Flap files;
    const std::string to = " --to " + files.file("y.scene.json");
    const std::string robot = files.write("r.urdf", R"(<robot name="r"><link name="base"/></robot>)");
    for (const auto& [arguments, says] : std::vector<std::pair<std::string, std::string>>{
             {files.parts + " --joints --ground lid" + to, "no body is called `lid`"},
             {files.parts + " --joints --density 0g/cm^3" + to, "this is greater than 0"},
             {files.parts + " --joints --density 3mm" + to, "density"},
             {files.parts + " --ground wall" + to, "is for --joints"},
             {files.parts + " --floating" + to, "is for URDF"},
             {robot + " --joints" + to, "is for meshes and STEP files"},
             {robot + " --split" + to, "is for meshes and STEP files"},
             {files.file("no.3mf") + to, "no such file"},
             {files.parts + " --to " + files.file("y.json"), "a scene is X.scene.json"},
         }) {
        const auto answer = run("import " + arguments, true);
        CAPTURE(arguments, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says(says));
        CHECK_FALSE(std::filesystem::exists(files.file("y.scene.json")));
    }
}

}  // namespace fettle::design::cli::import_command_test
