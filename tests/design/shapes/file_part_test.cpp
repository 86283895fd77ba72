// SPDX-License-Identifier: MIT
#include "design/shapes/file_part.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/support/temporary_folder.hpp"

namespace fettle::design::shapes::file_part_test {

using core::geometry::Mesh;
using description::drawn_mesh;

namespace {

double reach(const Mesh& mesh) { return mesh.vertices.topRows<2>().colwise().norm().maxCoeff(); }

}  // namespace

TEST_CASE("a part keeps the dimensions that it was drawn with, and refuses what it does not have") {
    const auto part = FilePart::create("cylinder", {{"radius", 3e-3}}, {.counts = {{"segments", 12}}});
    REQUIRE(part);
    CHECK((*part)->part() == "cylinder");
    CHECK((*part)->dimensions()[0].value == 3e-3);
    CHECK((*part)->is_always_solid());
    // The mesh covers the part: its flats touch the circle.
    CHECK(reach((*part)->at({4e-3, 1e-2})->mesh) == Approx(4e-3 / std::cos(std::numbers::pi / 12)));
    const auto refused = (*part)->at({-1e-3, 1e-2});
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].message == "radius is -1 mm; allowed: above 0 mm");

    const auto fault_of = [](const auto& made) {
        REQUIRE_FALSE(made);
        REQUIRE(made.errors().size() == 1);
        return made.errors().front();
    };
    Error error = fault_of(FilePart::create("cylinder", {{"radios", 3e-3}}));
    CHECK(error.code == ErrorCode::unknown_key);
    CHECK(error.where == "cylinder/radios");
    CHECK(error.message.find("\"radius\"") != std::string::npos);
    CHECK(fault_of(FilePart::create("cilinder")).message.find("\"cylinder\"") != std::string::npos);
    CHECK(fault_of(FilePart::create("cylinder", {}, {.counts = {{"segments", 7}}})).where == "counts/segments");
    CHECK(fault_of(FilePart::create("cylinder", {}, {.counts = {{"segments", 8}}, .chord = 1e-5})).code == ErrorCode::inconsistent);
    CHECK(fault_of(FilePart::create("cylinder", {}, {.counts = {{"teeth", 8}}})).where == "counts/teeth");
}

TEST_CASE("a part's file says how round surfaces are cut, where nothing else is said") {
    const tests::support::TemporaryFolder folder;
    const auto written = [&](const std::string& facets) {
        return folder.write("post.part.json", R"({"fettle_part": 1, "dimensions": {"radius": 5}, )" + facets +
                                                  R"("solid": {"extrude": {"circle": "= radius"}, "to": 2}})");
    };
    const auto drawn = [&](const std::string& facets, const PartOptions& options = {}) {
        const auto part = FilePart::create(written(facets), {}, options);
        REQUIRE(part);
        return drawn_mesh(**part).value();
    };
    const double pi = std::numbers::pi;
    const Mesh plain = drawn(""), within = drawn(R"("facets": {"segments": 24, "lean": "within"}, )"),
               through = drawn(R"("facets": {"segments": 12, "lean": "through"}, )"),
               fine = drawn(R"("facets": {"chord": 0.001, "lean": "within"}, )");
    CHECK(plain.vertices.cols() == 2 * 48);
    CHECK(reach(plain) == Approx(5e-3 / std::cos(pi / 48)));
    CHECK(plain.deviation->out < 1e-15);
    CHECK(within.vertices.cols() == 2 * 24);
    CHECK(reach(within) == Approx(5e-3));
    CHECK(within.deviation->out == Approx(5e-3 * (1 - std::cos(pi / 24))));
    CHECK(within.deviation->in < 1e-15);
    CHECK(through.vertices.cols() == 2 * 12);
    CHECK(fine.deviation->out <= 1.0001e-6);
    // What a scene says goes before.
    const std::string coarse = R"("facets": {"chord": 1, "lean": "within"}, )";
    CHECK(drawn(coarse, {.counts = {{"segments", 16}}}).vertices.cols() == 2 * 16);
    CHECK(drawn(coarse, {.chord = 1e-6}).deviation->out <= 1.0001e-6);

    for (const char* wrong : {R"("facets": {"segments": 4}, )", R"("facets": {"lean": "out"}, )", R"("facets": {"segment": 24}, )",
                              R"("facets": {"segments": 24, "chord": 0.1}, )", R"("facets": {"chord": 0}, )"}) {
        INFO(wrong);
        const auto part = FilePart::create(written(wrong));
        REQUIRE_FALSE(part);
        CHECK(part.errors().front().where.find("#/facets") != std::string::npos);
    }
}

}  // namespace fettle::design::shapes::file_part_test
