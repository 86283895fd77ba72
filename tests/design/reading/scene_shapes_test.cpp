// SPDX-License-Identifier: MIT
#include "design/reading/scene_shapes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "core/scene/place.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::reading::scene_shapes_test {

namespace {

using tests::support::TemporaryFolder;

const std::string ring =
    R"({"fettle_part": 1, "units": "mm", "dimensions": {"bore": 3, "wall": 2}, "relations": [{"check": "wall > 1", "or": "it breaks"}],
    "solid": {"extrude": {"holes": {"circle": "= bore"}, "in": {"circle": "= bore + wall"}}, "to": 2}})";

std::string scene(const std::string& shape, const std::string& variables = "{}") {
    return R"({"fettle_scene": 1, "units": "mm", "variables": )" + variables + R"(, "bodies": [{"name": "it", "density": 1000, "shape": )" +
           shape + "}]}";
}

Result<core::scene::Scene> read(const TemporaryFolder& folder, const std::string& text) {
    return core::scene_files::read_scene(folder.write("a.scene.json", text), scene_read_options());
}

bool is_told(const Result<core::scene::Scene>& scene, const std::string& where, const std::string& words) {
    return std::any_of(scene.errors().begin(), scene.errors().end(),
                       [&](const Error& error) { return error.where.ends_with(where) && error.message.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE("scene shapes: parts by name, by file beside the scene, and written into it") {
    const TemporaryFolder folder;
    folder.write("ring.part.json", ring);
    const auto library =
        read(folder, scene(R"({"part": "dovetail_slide", "dimensions": {"flank_angle": "= alpha", "neck": 12}})", R"({"alpha": "25deg"})"));
    REQUIRE(library);
    CHECK(library->bodies[0].shape->dimensions.at("flank_angle") == Approx(25 * std::numbers::pi / 180));
    REQUIRE(library->numbers.size() == 1);
    CHECK(library->numbers[0].place == "/bodies/0/shape/dimensions/flank_angle");
    const auto place = core::scene::find_place(*library, library->numbers[0].place);
    REQUIRE(place);
    CHECK(core::scene::dimension_at(*library, *place) == core::base::Dimension::angle);

    const auto coarse = read(folder, scene(R"({"part": "ring.part.json", "dimensions": {"bore": "4mm"}, "counts": {"segments": 12}})"));
    const auto fine = read(folder, scene(R"({"part": "ring.part.json", "facets": "0.001mm"})"));
    REQUIRE(coarse);
    REQUIRE(fine);
    CHECK(coarse->bodies[0].mesh.triangles.size() < fine->bodies[0].mesh.triangles.size());

    const auto written = read(folder, scene(R"({"profiles": {"ring": {"holes": {"circle": "= bore"}, "in": {"circle": "= wide"}}},
                                                "solid": {"extrude": "ring", "to": 2}})",
                                            R"({"bore": "3mm", "wide": "= 2 * bore", "other": 1})"));
    REQUIRE(written);
    CHECK(written->bodies[0].shape->dimensions == std::map<std::string, double>{{"bore", 0.003}, {"wide", 0.006}});
    CHECK(written->numbers.size() == 2);
    CHECK(read(folder, scene(R"({"solid": {"extrude": {"circle": 2}, "to": 2}})")));
}

TEST_CASE("scene shapes: how many there are follows from variables that no parameter moves") {
    const TemporaryFolder folder;
    const auto posts = [&](const std::string& count) {
        return read(folder, scene(R"({"solid": {"extrude": {"repeat": {"circle": 2, "centre": [9, 0]}, "count": "= posts"},
                                                "to": "= factor * 4 mm"}})",
                                  R"({"posts": )" + count + R"(, "factor": 0.5})"));
    };
    const auto one = posts("1"), three = posts("3");
    REQUIRE(one);
    REQUIRE(three);
    CHECK(three->bodies[0].mesh.triangles.size() == 3 * one->bodies[0].mesh.triangles.size());
    CHECK(three->bodies[0].shape->dimensions == std::map<std::string, double>{{"factor", 0.5}});
    const auto gear = read(folder, scene(R"({"part": "spur_gear", "counts": {"teeth": "= 2 * teeth"}})", R"({"teeth": 9})"));
    REQUIRE(gear);
    CHECK(gear->bodies[0].shape->counts.at("teeth") == 18);
    CHECK(is_told(read(folder, scene(R"({"part": "spur_gear", "counts": {"teeth": "= teeth / 2"}})", R"({"teeth": 9})")), "/counts/teeth",
                  "whole number"));

    folder.write("a.scene.json", scene(R"({"part": "spur_gear", "dimensions": {"module": "= m"}, "counts": {"teeth": "= teeth"}})",
                                       R"({"teeth": 18, "m": "2mm"})"));
    const auto design = [&](const std::string& parameter) {
        return parse_design(R"({"fettle_design": 1, "scene": "a.scene.json", "units": "mm", "parameters": [)" + parameter +
                                R"(], "variables": {"two": 2}, "objective": [{"type": "mass", "bodies": ["it"]}]})",
                            folder.file("a.design.json"));
    };
    CHECK(design(R"({"name": "m", "value": 2, "lower": 1.9, "upper": 3})"));
    const auto moved = design(R"({"name": "teeth", "unit": "1", "value": 18, "lower": 12, "upper": 20})");
    REQUIRE(!moved);
    CHECK(std::any_of(moved.errors().begin(), moved.errors().end(), [](const Error& error) {
        return error.where.ends_with("/counts/teeth") && error.message.find("follow from `teeth`") != std::string::npos;
    }));
}

TEST_CASE("scene shapes: faults of parts, with their place") {
    const TemporaryFolder folder;
    folder.write("ring.part.json", ring);
    CHECK(is_told(read(folder, scene(R"({"part": "wascher"})")), "/shape/part", "washer"));
    CHECK(is_told(read(folder, scene(R"({"part": "rong.part.json"})")), "/shape/part", "part file \"rong.part.json\" was not found"));
    CHECK(is_told(read(folder, scene(R"({"part": "ring.part.json", "dimensions": {"boar": 1}})")), "/shape", "there are bore, wall"));
    CHECK(is_told(read(folder, scene(R"({"part": "ring.part.json", "dimensions": {"wall": 0.5}})")), "/shape", "or it breaks"));
    CHECK(is_told(read(folder, scene(R"({"part": "ring.part.json", "counts": {"teeth": 5}})")), "/shape/part", "no count `teeth`"));
    CHECK(is_told(read(folder, scene(R"({"part": "ring.part.json", "counts": {"segments": 5}})")), "/shape", "from 8 to 720"));
    CHECK(is_told(read(folder, scene(R"({"part": "ring.part.json", "counts": {"segments": 8}, "facets": 1})")), "/shape", "`facets`"));
    CHECK(is_told(read(folder, scene(R"({"solid": {"extrude": {"circle": "= bor"}, "to": 5}})", R"({"bore": "3mm"})")), "/shape",
                  "/solid/extrude/circle: "));
}

TEST_CASE("scene shapes: the key of former generators is told what to write instead") {
    const TemporaryFolder folder;
    for (const auto& [name, words] : std::vector<std::pair<std::string, std::string>>{
             {"box", R"(write "part": "box")"},
             {"pin", R"(write "part": "cylinder")"},
             {"plate_with_hole", R"(write "part": "plate_with_hole")"},
             {"base_plate", R"(copy examples/four_bar/base.part.json to this file's folder and write "part": "base.part.json")"},
             {"crank", "copy examples/slider_crank/crank.part.json"},
             {"mine", "fettle shapes lists them"}}) {
        const auto scene_of_old = read(folder, scene(R"({"generator": ")" + name + R"(", "dimensions": {"size_x": 4}})"));
        CHECK(scene_of_old.errors().size() == 1);
        CHECK(is_told(scene_of_old, "/shape/generator", words));
    }
    for (const char* file : {"slider_crank/block", "slider_crank/crank", "slider_crank/rod", "slider_crank/piston", "four_bar/base",
                             "four_bar/arm", "four_bar/coupler", "follower/eccentric", "follower/follower"})
        CHECK(std::filesystem::exists(FETTLE_SOURCE_DIR "/examples/" + std::string(file) + ".part.json"));
}

TEST_CASE("scene shapes: a design moves a part's dimensions") {
    const TemporaryFolder folder;
    folder.write("ring.part.json", ring);
    folder.write("a.scene.json", scene(R"({"part": "ring.part.json", "dimensions": {"bore": "= bore"}})", R"({"bore": "3mm"})"));
    const auto design = read_design(folder.write("a.design.json", R"({"fettle_design": 1, "units": "mm", "scene": "a.scene.json",
        "parameters": [{"name": "bore", "lower": "2mm", "upper": "5mm", "value": "4mm"}],
        "objective": [{"type": "mass", "bodies": ["it"]}]})"));
    for (const Error& error : design.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(design);
    REQUIRE(design->design.shapes.size() == 1);
    REQUIRE(design->design.shapes[0]);
    CHECK(design->design.shapes[0]->dimensions()[0].value == Approx(4e-3));
    CHECK(design->design.shapes[0]->dimensions()[1].value == 2e-3);
}

}  // namespace fettle::design::reading::scene_shapes_test
