// SPDX-License-Identifier: MIT
// What fettle clearance and simulate say of pairs that a joint joins, and of pairs that the scene ignores.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "core/parts/solid_cut.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/skip.hpp"

namespace fettle::design::cli::clearance_joined_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

// A wheel of 48 x 48 x 10 that a motor turns about z on `frame`, and a block far away. `more` stands in the scene beside them.
std::string wheel_scene(const std::string& frame, const std::string& wheel, const std::string& more = "", const char* type = "revolute") {
    return R"({"fettle_scene": 1, "units": "mm", "variables": {"far": "200mm"}, "timestep": 0.01, "end_time": 0.05, "bodies": [
        {"name": "frame", "type": "static", )" +
           frame + R"(}, {"name": "wheel", "density": 1240, )" + wheel + R"(},
        {"name": "block", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 5, "size_y": 5, "size_z": 5}},
         "position": ["= far", 0, 0]}],
        "joints": [{"name": "j", "type": ")" +
           type + R"(", "a": "frame", "b": "wheel", "point": [0, 0, 0])" + (type == std::string("fixed") ? "" : R"(, "axis": [0, 0, 1])") +
           (type == std::string("revolute") ? R"(, "limits": [-5, 90]}], "motors": [{"name": "m", "joint": "j", "speed": 360}])" : "}]") +
           more + "}";
}

const char* const design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
    "parameters": [{"name": "far", "value": 200, "lower": 150, "upper": 250}], "tolerances": {"far": "+-0.1 mm"},
    "objective": [{"type": "mass", "bodies": ["wheel"], "weight": 1}]})";

const std::string leg = R"("shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 60}}, "position": [0, 18, 0])";
const std::string short_leg = R"("shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 60}}, "position": [0, 40, 0])";
const std::string disc = R"("shape": {"part": "box", "dimensions": {"size_x": 48, "size_y": 48, "size_z": 10}})";
const std::string axle = R"("shape": {"part": "cylinder", "dimensions": {"radius": 3, "length": 20}}, "rotation": [0, 0, 2])";
const std::string hub =
    R"("shape": {"part": "plate_with_hole", "dimensions": {"size_x": 40, "size_y": 40, "thickness": 8, "hole_radius": 3}})";

const char* const all_questions[] = {"", "--motion", "--kinematic", "--ranges", "--tolerances", "--pairs '*:*'"};

Answer asked(const DesignFolder& folder, const std::string& question) {
    const std::string file = question == "--tolerances" ? folder.design() : folder.file("small.scene.json");
    return run("clearance --json " + file + " " + question);
}

}  // namespace

TEST_CASE("clearance: a frame through the wheel that it carries is a clash, whatever is asked") {
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const DesignFolder folder(design, wheel_scene(leg, disc));
    // One figure of the depth: a move of 26 mm at most parts them, and their common part is 4 mm thick.
    const Answer told = run("clearance " + folder.file("small.scene.json"));
    CAPTURE(told.out);
    CHECK(told.says("at least 3.98 mm deep, 160 mm^3 shared"));
    CHECK(told.says("160 mm^3 shared  joined by joint j"));
    for (const char* question : all_questions) {
        const Answer answer = asked(folder, question);
        CAPTURE(question, answer.out);
        CHECK(answer.code == 1);
        const Json pair = answer.pair("frame", "wheel");
        REQUIRE(!pair.is_null());
        CHECK(pair["finding"] == "clash");
        CHECK(pair["joined_by"] == "joint j");
        CHECK(pair["volume"]["upper"].get<double>() == Approx(160e-9));
        const Json joined = answer.json()["joined"];
        REQUIRE(joined.size() == 1);
        CHECK(joined[0]["found"] == "clash");
        CHECK(joined[0]["joints"] == Json::array({"j"}));
    }
    for (const char* type : {"fixed", "planar"}) {
        const DesignFolder other(design, wheel_scene(leg, disc, "", type));
        CHECK(run("clearance " + other.file("small.scene.json")).code == 1);
    }
}

TEST_CASE("clearance: of bodies that a joint joins it is told that they are apart, or what the joint explains") {
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const DesignFolder apart(design, wheel_scene(short_leg, disc)), pinned(design, wheel_scene(axle, hub));
    for (const char* question : all_questions) {
        const Answer answer = asked(apart, question);
        CAPTURE(question, answer.out);
        CHECK(answer.code == 0);
        CHECK(answer.json()["joined"][0]["found"] == "apart");
        CHECK(answer.json()["joined"][0]["lower"].get<double>() > 0);
        const Answer pin = asked(pinned, question);
        CAPTURE(pin.out);
        CHECK(pin.code == 0);
        const Json joined = pin.json()["joined"][0];
        CHECK(joined["found"] == "explained");
        CHECK(joined["volume"]["upper"].get<double>() < 5e-9);
    }
    CHECK(run("clearance " + apart.file("small.scene.json")).says("apart there: 1 pair of bodies: frame:wheel"));
    CHECK(run("clearance " + pinned.file("small.scene.json"))
              .says("frame:wheel share material as a pin and its bore, which joint j explains"));
    // Named, they are judged as any other pair is.
    CHECK(run("clearance --json --pairs frame:wheel " + pinned.file("small.scene.json")).code == 1);
}

TEST_CASE("clearance: a trajectory does not say which joint explains an overlap, so that it is undecided") {
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const DesignFolder folder(design, wheel_scene(axle, hub));
    REQUIRE(run("simulate " + folder.file("small.scene.json") + " --out " + folder.file("run")).code == 0);
    const Answer answer = run("clearance --json " + folder.file("run"));
    CAPTURE(answer.out);
    CHECK(answer.code == 2);
    CHECK(answer.pair("frame", "wheel")["reason"].get<std::string>().find("give its scene or design") != std::string::npos);
}

TEST_CASE("a scene ignores pairs by name: in contact, and in every answer, which lists them") {
    const std::string inside = R"(, "ignore": ["wheel:frame"])";
    const DesignFolder folder(design, wheel_scene(leg, disc, inside));
    for (const char* question : all_questions) {
        const Answer answer = asked(folder, question);
        CAPTURE(question, answer.out);
        CHECK(answer.code == 0);
        CHECK(answer.pair("frame", "wheel").is_null());
        CHECK(answer.json()["ignored_by_scene"] == Json::array({"frame:wheel"}));
        CHECK(answer.json()["joined"].empty());
    }
    CHECK(run("clearance " + folder.file("small.scene.json")).says("ignored by the scene: 1 pair of bodies: frame:wheel"));
    CHECK(run("clearance --json --pairs frame:wheel " + folder.file("small.scene.json")).pair("frame", "wheel")["finding"] == "clash");
    const Answer simulated = run("simulate --json " + folder.file("small.scene.json") + " --out " + folder.file("run"));
    CAPTURE(simulated.out);
    CHECK(simulated.code == 0);
    CHECK(simulated.json()["left_out"]["ignored"] == Json::array({"frame:wheel"}));
    const Answer stored = run("clearance --json " + folder.file("run"));
    CHECK(stored.code == 0);
    CHECK(stored.json()["ignored_by_scene"] == Json::array({"frame:wheel"}));
    // Two bodies that no joint joins, one in the other.
    const auto loose = [](const std::string& ignore) {
        return R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.05, "bodies": [
            {"name": "a", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 9, "size_y": 9, "size_z": 9}}},
            {"name": "b", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 9, "size_y": 9, "size_z": 9}}, "position": [4, 0, 0]}])" +
               ignore + "}";
    };
    const DesignFolder refused(design, loose("")), taken(design, loose(R"(, "ignore": ["a:b"])"));
    const Answer no = run("simulate " + refused.file("small.scene.json"), true);
    CHECK(no.code == 3);
    CHECK(no.says("list \"a:b\" in the scene's `ignore`"));
    const Answer yes = run("simulate " + taken.file("small.scene.json"));
    CHECK(yes.code == 0);
    CHECK(yes.says("left out: ignored by the scene: a:b"));
}

TEST_CASE("simulate: the proof says whom it leaves out, and validate warns of an overlap that no joint explains") {
    const DesignFolder folder(design, wheel_scene(leg, disc));
    const Answer answer = run("simulate " + folder.file("small.scene.json"), true);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.says("left out: joined by joints: frame:wheel (j); among bodies that are not dynamic: frame, block"));
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const char* const warning = "`frame` and `wheel` share 160 mm^3 of material at the start, which j between them does not explain";
    CHECK(answer.says(warning));
    CHECK(run("validate " + folder.file("small.scene.json"), true).says(warning));
    const DesignFolder pinned(design, wheel_scene(axle, hub));
    CHECK_FALSE(run("validate " + pinned.file("small.scene.json"), true).says("of material at the start"));
}

}  // namespace fettle::design::cli::clearance_joined_test
