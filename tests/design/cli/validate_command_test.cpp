// SPDX-License-Identifier: MIT
// The facts and doubts that validate shows, and what the program says to files and options that it cannot take.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::validate_command_test {

namespace {

using Json = nlohmann::json;
using fettle::Vector3;
using fettle::core::geometry::Mesh;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using Folder = fettle::tests::support::TemporaryFolder;

std::string obj_of(const Mesh& mesh) {
    std::string text;
    for (int i = 0; i < mesh.vertices.cols(); ++i) {
        const Vector3 x = mesh.vertices.col(i);
        text += "v " + std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z()) + "\n";
    }
    for (const auto& t : mesh.triangles)
        text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return text;
}

std::string scene_of(const std::string& units, const std::string& density) {
    return R"({"fettle_scene": 1, "units": ")" + units + R"(", "bodies": [{"name": "part", "mesh": "part.obj", "density": )" + density +
           "}]}";
}

bool mentions(const Json& warnings, const std::string& part) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const Json& warning) { return warning.get<std::string>().find(part) != std::string::npos; });
}

const Mesh part = fettle::tests::box_mesh({0, 0, 0}, {60, 40, 12});

}  // namespace

TEST_CASE("validate: size, volume and mass of each body, in the file's unit") {
    const Folder folder;
    folder.write("part.obj", obj_of(part));
    const Answer good = run("validate " + folder.write("a.scene.json", scene_of("mm", "1240")));
    CHECK(good.code == 0);
    CHECK(good.says("60 x 40 x 12"));
    CHECK(good.says("size [mm]"));
    CHECK(good.says("28800"));
    CHECK(good.says("35.71 g"));
    const Json json = run("validate --json " + folder.file("a.scene.json")).json();
    REQUIRE(json.at("parts").size() == 1);
    CHECK(json["parts"][0].at("mass").get<double>() == Approx(0.035712));
    CHECK(json["parts"][0].at("volume").get<double>() == Approx(2.88e-5));
    CHECK(json["warnings"].empty());
}

TEST_CASE("validate: what can hardly be meant is doubted") {
    const Folder folder;
    folder.write("part.obj", obj_of(part));
    const Json metres = run("validate --json " + folder.write("m.scene.json", scene_of("m", "1240"))).json();
    CHECK(metres.at("status") == "ok");
    CHECK(mentions(metres["warnings"], "body `part`: its size is 60 m and its mass 3.57e+07 kg, which is hardly meant"));
    const std::string two = folder.write("two.scene.json", R"({"fettle_scene": 1, "units": "m", "bodies": [
        {"name": "part", "type": "static", "mesh": "part.obj"},
        {"name": "other", "type": "static", "mesh": "part.obj", "position": [100, 0, 0]}]})");
    CHECK(
        mentions(run("clearance --json --minimum 0.3mm " + two).json().at("warnings"), two + "#/bodies/0: body `part`: its size is 60 m"));
    const Json light = run("validate --json " + folder.write("l.scene.json", scene_of("mm", "1.24"))).json();
    CHECK(mentions(light.at("warnings"), "a density of 1.24 kg/m^3 is hardly meant"));
}

TEST_CASE("validate: a mesh without a unit is not told in metres") {
    const Folder folder;
    Mesh open = part;
    const auto box = folder.write("part.obj", obj_of(part));
    const Answer answer = run("validate " + box);
    CHECK(answer.code == 0);
    CHECK(answer.says("size 60 x 40 x 12, volume 28800; the file states no unit"));
    CHECK(run("validate --json " + box).json().at("unit").is_null());
    CHECK(run("validate --unit cm " + box).says("size 600 x 400 x 120 mm, volume 2.88e+07 mm^3"));
    CHECK(run("validate --unit cm --json " + box).json().at("unit") == "mm");
    CHECK(run("validate --unit mn " + box, true).says("--unit"));
    const std::string scene = folder.write("a.scene.json", scene_of("mm", "1240"));
    CHECK(run("validate --unit mm " + scene, true).says("is for meshes"));
    open.triangles.resize(6);
    const Answer faulty = run("validate --json " + folder.write("open.obj", obj_of(open)));
    CHECK(faulty.code == 3);
    CHECK(faulty.says("the surface is open"));
    CHECK_FALSE(faulty.says(") m"));
}

TEST_CASE("validate, clearance: a mesh file in a unit that is hardly meant is doubted") {
    const Folder folder;
    Mesh other = part;
    other.vertices.row(0).array() += 100;
    const std::string a = folder.write("a.obj", obj_of(part)), b = folder.write("b.obj", obj_of(other));  // 60 long
    for (const std::string unit : {"cm", "in", "m"}) {
        CAPTURE(unit);
        CHECK(run("validate --unit " + unit + " " + a, true).says("and would be 60 mm in mm; is --unit " + unit + " right?"));
        const Answer answer = run("clearance --minimum 0.1mm --unit " + unit + " " + a + " " + b, true);
        CHECK(answer.code == 0);
        CHECK((answer.says("body `a`: its longest side is") || answer.says("body `a`: its size is 60 m")));
    }
    CHECK(run("validate --unit mm --json " + a).json().at("warnings").empty());
    CHECK(run("validate --json " + a).json().at("warnings").empty());
    other.vertices *= 1000;
    const std::string large = folder.write("large.obj", obj_of(other));
    CHECK(
        mentions(run("validate --json " + large).json().at("warnings"), "if the file is in mm, as most are: its longest side is 6e+04 mm"));
    CHECK(mentions(run("validate --json --unit mm " + large).json().at("warnings"), "is --unit mm right?"));
}

TEST_CASE("validate: real meshes pass with warnings, and not when strict") {
    const Folder folder;
    const auto twins = fettle::tests::joined(part, fettle::tests::box_mesh({30, 20, 6}, {90, 60, 18}));
    const std::string file = folder.write("part.obj", obj_of(twins));
    const Answer tolerant = run("validate --json " + file);
    CHECK(tolerant.code == 0);
    CHECK(mentions(tolerant.json().at("warnings"), "triangles intersect"));
    CHECK(run("validate --strict --json " + file).code == 3);
    const std::string scene = folder.write("a.scene.json", scene_of("mm", "1240"));
    const Answer in_scene = run("validate --json " + scene);
    CHECK(in_scene.code == 0);
    CHECK(mentions(in_scene.json().at("warnings"), "triangles intersect"));
    CHECK(run("simulate " + scene + " --steps 1", true).says("triangles intersect"));
    CHECK(run("validate --strict --json " + scene).code == 3);
}

TEST_CASE("files of other kinds are told what is read") {
    const Folder folder;
    const std::string mesh = folder.write("part.stl", "solid a\nendsolid a\n");
    const Answer stl = run("simulate " + mesh, true);
    CHECK(stl.code == 3);
    CHECK(stl.says("is a mesh, not a scene or design"));
    for (const char* name : {"a.scad", "a.sldprt", "a.csv"}) {
        const Answer other = run("validate " + folder.write(name, "<cube/>"), true);
        CHECK(other.code == 3);
        CHECK(
            other.says("is not read; scenes, designs and trajectories are JSON (.json); meshes, which a scene names, are .stl .obj .off "
                       ".ply .3mf .dae .gltf .glb .3ds .amf"));
        CHECK_FALSE(other.says("not valid JSON"));
    }
}

TEST_CASE("options out of range are told in words") {
    const Answer words = run("simulate a.scene.json --steps five", true);
    CHECK(words.code == 3);
    CHECK(words.says("--steps: a whole number is expected, found \"five\""));
    CHECK(words.out.size() < 200);
    CHECK(run("simulate a.scene.json --time 1e160", true).says("--time: 1e160 is out of range: a number of at most 1e30"));
    CHECK(run("simulate a.scene.json --time nan", true).code == 3);
    CHECK(run("--threads 9999 validate a", true).says("--threads: 9999 is not allowed: 1 to 4096 is"));
}

TEST_CASE("a body without density has no mass to sum") {
    using namespace fettle::tests::design_support;
    const DesignFolder folder(
        replaced(small_design, R"("mass", "bodies": ["cube"], "weight": 1)", R"("mass", "bodies": ["wall"], "weight": 1)"));
    const Answer answer = run("validate " + folder.design(), true);
    CHECK(answer.code == 3);
    CHECK(answer.says("has no density in its scene"));
}

TEST_CASE("the README of scenes shows keys that are read") {
    const std::string text = contents("core/scene_files/README.md");
    const std::size_t begin = text.find("```json\n") + 8, end = text.find("```", begin);
    REQUIRE(end != std::string::npos);
    const Folder folder;
    for (const char* name : {"frame.stl", "crank.stl", "gripper.stl"}) {
        std::string stl = "solid a\n";
        for (const auto& t : part.triangles) {
            stl += "facet normal 0 0 0\nouter loop\n";
            for (const int v : t) {
                const Vector3 x = part.vertices.col(v) + Vector3(name[0] * 100.0, 0, 0);
                stl += "vertex " + std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z()) + "\n";
            }
            stl += "endloop\nendfacet\n";
        }
        folder.write(name, stl + "endsolid a\n");
    }
    const Answer answer = run("validate " + folder.write("a.scene.json", text.substr(begin, end - begin)), true);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
}

TEST_CASE("validate: a part file is a part") {
    const Folder folder;
    const std::string file = folder.write("rod.part.json", R"({"fettle_part": 1, "dimensions": {"long": 5},
        "solid": {"extrude": {"circle": 1}, "to": "= long"}})");
    CHECK(run("validate " + file).says(": a valid part"));
    CHECK(run("validate --json " + file).json().at("kind") == "part");
    // Its faults are at places of the file, which has no bodies.
    const std::string faulty = folder.write("faulty.part.json", R"({"fettle_part": 1, "dimensions": {"long": 5},
        "solid": {"extrude": {"circle": 1}}})");
    const std::string broken = folder.write("broken.part.json", "{\"fettle_part\": 1,");
    const std::vector<std::string> commands{"validate ", "draw --out " + folder.file("x.svg") + " ", "clearance --minimum 1mm "};
    for (const std::string& command : commands) {
        const Answer answer = run(command + faulty, true);
        CAPTURE(answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says(faulty + "#/solid: "));
        CHECK_FALSE(answer.says("/bodies"));
        const Answer unread = run(command + broken, true);
        CHECK(unread.code == 3);
        CHECK(unread.says(broken + ":"));
        CHECK_FALSE(unread.says("/bodies"));
    }
}

// A certificate of each kind: its subject, in text and JSON, and its worth without the file that it was made from.
TEST_CASE("validate: a certificate says over what it is, and of which scene") {
    Folder folder;
    const std::string scene =
        folder.write("arm.scene.json", R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "variables": {"far": "40 mm"},
        "bodies": [
          {"name": "arm", "density": 1000, "position": [10, 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 4, "size_z": 4}}},
          {"name": "post", "type": "static", "position": ["= far", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}],
        "joints": [{"name": "elbow", "type": "revolute", "b": "arm", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [-50, 30]}],
        "motors": [{"name": "drive", "joint": "elbow", "angle": {"times": [0, 0.5], "values": [0, 20]}}]})json");
    const std::string design = folder.write("arm.design.json", R"json({"fettle_design": 1, "scene": "arm.scene.json", "units": "mm",
        "parameters": [{"name": "far", "lower": 30, "upper": 50}], "objective": [{"type": "mass", "bodies": ["arm"]}],
        "tolerances": {"far": {"lower": -0.25, "upper": 0.125}}})json");
    struct Kind {
        std::string name, file, options, over;
        std::vector<std::string> lines;
        bool states_its_domain;
    };
    const std::string elbow = "joints: elbow -50 to 30 deg\n", far = "tolerances: far -0.25 to +0.125 mm\n";
    const std::vector<Kind> kinds{
        {"assembled", scene, "", "as assembled", {}, false},
        {"path", scene, "--kinematic --steps 5", "over the motion, for joints met at all times", {"motion: ", " steps, 0.5 s\n"}, false},
        {"ranges", scene, "--ranges", "over all positions of the joints", {elbow}, true},
        {"tolerances", design, "--tolerances", "as assembled, within tolerances", {far}, true},
        {"both", design, "--tolerances --ranges", "over all positions of the joints, within tolerances", {far, elbow}, true},
        {"prescribed",
         design,
         "--tolerances --kinematic --time 0.5",
         "over the prescribed motion, within tolerances",
         {far, "prescribed motion: 0.5 s from the start\n", "joints: elbow "},
         true}};
    for (const Kind& kind : kinds) {
        INFO(kind.name);
        const std::string file = folder.file(kind.name + ".certificate.json");
        REQUIRE(run("clearance " + kind.file + " " + kind.options + " --pairs arm:post --minimum 1mm --certificate " + file).code == 0);
        const Answer text = run("validate " + file + " --minimum 1mm"), answer = run("validate " + file + " --minimum 1mm --json");
        CHECK(text.code == 0);
        CHECK(text.says(kind.over));
        for (const std::string& line : kind.lines) CHECK(text.says(line));
        const Json domain = answer.json()["domain"];
        CHECK(domain["over"] == kind.over);
        CHECK(answer.json()["source"] == (kind.file == scene ? "arm.scene.json" : "arm.design.json"));
        if (kind.name == "both") {
            CHECK(domain["tolerances"] == Json::array({{{"of", "far"}, {"lower", -0.25e-3}, {"upper", 0.125e-3}}}));
            CHECK(domain["joints"][0]["joint"] == "elbow");
            CHECK(domain["joints"][0]["low"].get<double>() == Approx(-50 * M_PI / 180));
        }
        // Without its source it is a proof of nothing but what it states itself.
        Json unbound = Json::parse(contents(file));
        unbound.erase("source");
        const std::string path = " --trajectory " + folder.file(kind.name + ".trajectory.json") + " --minimum 1mm",
                          bare = folder.write("bare.certificate.json", unbound.dump()) + path;
        const Answer alone = run("validate " + bare), of_scene = run("validate " + bare + " --source " + kind.file + " --json");
        CHECK(alone.code == (kind.states_its_domain ? 2 : 0));
        CHECK(alone.says("accepted"));
        CHECK(alone.says(kind.states_its_domain ? "of no scene or design: --source FILE" : "it names no scene or design"));
        CHECK(run("validate " + bare + " --json").json()["source"].is_null());
        CHECK(of_scene.code == 0);
        CHECK(of_scene.json()["source"] == kind.file);
        unbound["source"] = "gone.scene.json";  // nor of what is not there
        CHECK(run("validate " + folder.write("bare.certificate.json", unbound.dump()) + path).code == (kind.states_its_domain ? 2 : 0));
    }
    // The scene as it is now is not the one that was proven.
    folder.write("arm.scene.json", fettle::tests::support::replaced(contents(scene), "[-50, 30]", "[-50, 31]"));
    CHECK(run("validate " + folder.file("ranges.certificate.json")).says("stale: the joints of arm.scene.json"));
    CHECK(run("validate " + folder.file("both.certificate.json")).says("stale: the tolerances of arm.design.json"));
    CHECK(run("validate " + folder.file("ranges.certificate.json") + " --source nowhere.json").code == 3);
    CHECK(run("validate " + scene + " --source " + scene, true).says("--source: is for a certificate"));
}

TEST_CASE("validate: a certificate of another scenario than the first is not called stale without the way to check it") {
    Folder folder;
    folder.write("two.scene.json", R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "variables": {"far": "40 mm"}, "bodies": [
        {"name": "a", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 4, "size_z": 4}}},
        {"name": "b", "density": 1000, "position": ["= far", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}],
        "joints": [{"name": "slide", "type": "prismatic", "b": "b", "point": [0, 0, 0], "axis": [1, 0, 0], "limits": ["-5 mm", "5 mm"]}]})json");
    const std::string design = folder.write("two.design.json", R"json({"fettle_design": 1, "scene": "two.scene.json", "units": "mm",
        "parameters": [{"name": "far", "lower": 30, "upper": 50}], "objective": [{"type": "mass", "bodies": ["b"]}],
        "simulation": {"steps": 2}, "scenarios": [{"name": "one"}, {"name": "two", "set": {"/joints/slide/limits/1": "6 mm"}}]})json");
    const std::string file = folder.file("two.certificate.json");
    const Answer made = run("clearance " + design + " --scenario two --ranges --pairs a:b --minimum 1mm --certificate " + file);
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    CHECK(Json::parse(contents(file))["scenario"] == "two");
    CHECK(run("validate " + file).code == 0);
    CHECK(run("validate " + file + " --scenario two").code == 0);
    CHECK(run("validate " + file + " --scenario one").says("stale"));
    // One of an older version does not say it.
    Json older = Json::parse(contents(file));
    older.erase("scenario");
    folder.write("two.certificate.json", older.dump());
    const Answer stale = run("validate " + file);
    CAPTURE(stale.out);
    CHECK(stale.code == 1);
    CHECK(stale.says("another scenario than the first, which was read: --scenario one, --scenario two"));
    CHECK(run("validate " + file + " --scenario two").code == 0);
    CHECK_FALSE(run("validate " + file + " --scenario one").says("another scenario"));
}

TEST_CASE("validate: a certificate within tolerances remembers the process that it was made for") {
    Folder folder;
    folder.write("fit.scene.json", R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "variables": {"far": "40 mm"}, "bodies": [
        {"name": "a", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 4, "size_z": 4}}},
        {"name": "b", "density": 1000, "position": ["= far", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}]})json");
    const std::string design = folder.write("fit.design.json", R"json({"fettle_design": 1, "scene": "fit.scene.json", "units": "mm",
        "parameters": [{"name": "far", "lower": 30, "upper": 50}], "objective": [{"type": "mass", "bodies": ["b"]}],
        "simulation": {"steps": 2}, "tolerances": {"far": "length"}})json");
    const std::string file = folder.file("fit.certificate.json"), ask = "clearance " + design + " --tolerances --certificate " + file;
    CHECK(run(ask + " --minimum 1mm", true).says("--process fdm"));
    const Answer made = run(ask + " --process fdm --minimum 1mm");
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    const Answer valid = run("validate " + file);
    CAPTURE(valid.out);
    CHECK(valid.code == 0);
    Json other = Json::parse(contents(file));
    CHECK(other["process"] == "fdm");
    other["process"] = "sla";
    folder.write("fit.certificate.json", other.dump());
    CHECK(run("validate " + file).says("stale"));
}

}  // namespace fettle::design::cli::validate_command_test
