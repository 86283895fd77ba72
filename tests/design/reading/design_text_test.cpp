// SPDX-License-Identifier: MIT
#include "fettle/design/reading/design_text.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "fettle/tests/design/small_design.hpp"

namespace fettle::design::reading::design_text_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::representable;
using fettle::design::description::values_of;

std::string all(const Errors& errors) {
    std::string text;
    for (const Error& error : errors) text += error.where + ": " + error.message + "\n";
    return text;
}

}  // namespace

TEST_CASE("a rewritten design reads back bit for bit, from another folder, and has the same hash but for its values") {
    const DesignFolder folder;
    const Result<DesignFile> design = read_design(folder.design());
    REQUIRE(design);
    VectorX values(5);
    values << 0.0123456789012345678, 0.2 / 11, -1e-3 / 3, 1234.5678901234567, 0.98765432109876543;
    for (Eigen::Index k = 0; k < 5; ++k) values[k] = representable(values[k], design->design.parameters[k].unit);
    values[2] = design->design.parameters[2].upper;
    const auto out = folder.path / "out";
    std::filesystem::create_directories(out);
    const std::string path = (out / "design.final.json").string();
    std::ofstream(path) << design_text(*design, values, out.string());
    const Result<DesignFile> again = read_design(path);
    INFO(all(again.errors()));
    REQUIRE(again);
    for (Eigen::Index k = 0; k < 5; ++k) CHECK(again->design.parameters[k].value == values[k]);
    CHECK(design_hash(*again) != design_hash(*design));
    std::ofstream(path) << design_text(*design, values_of(design->design.parameters), out.string());
    CHECK(design_hash(*read_design(path)) == design_hash(*design));

    const DesignFolder moved(small_design, replaced(small_scene, "\"size_y\": 12", "\"size_y\": 12.5"));
    CHECK(design_hash(*read_design(moved.design())) != design_hash(*design));
    const DesignFolder other_optimiser(replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 9"));
    CHECK(design_hash(*read_design(other_optimiser.design())) == design_hash(*design));
}

TEST_CASE("a design's hash is another when its part says something else, even if what is drawn at the start is the same") {
    const auto hash_of = [](const std::string& side) {
        const DesignFolder folder(small_design,
                                  replaced(small_scene, R"("part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 })",
                                           R"("part": "cube.part.json", "dimensions": { "size_x": 20, "size_z": 10 })"));
        folder.write("cube.part.json", R"({"fettle_part": 1, "dimensions": {"size_x": 20, "size_z": 10},
            "solid": {"extrude": {"rectangle": ["= size_x", ")" +
                                           side + R"("]}, "from": "= -size_z / 2", "to": "= size_z / 2"}})");
        const Result<DesignFile> design = read_design(folder.design());
        INFO(all(design.errors()));
        REQUIRE(design);
        return design_hash(*design);
    };
    CHECK(hash_of("= 12") == hash_of("= 12"));
    CHECK(hash_of("= 12") != hash_of("= 2 + size_z"));
}

}  // namespace fettle::design::reading::design_text_test
