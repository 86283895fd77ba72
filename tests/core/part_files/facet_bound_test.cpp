// SPDX-License-Identifier: MIT
// A bound of the facets of a part's solids before they are drawn: never more than what is drawn, and a part that multiplies them is refused
// at once.
#include "core/part_files/facet_bound.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <vector>

#include "core/part_files/part_file.hpp"

namespace fettle::core::part_files::facet_bound_test {

Result<parts::DrawnPart> drawn(const std::string& rest) {
    const auto file =
        PartFile::parse(R"({"fettle_part": 1, "units": "mm", "dimensions": {"a": {"value": 3}}, )" + rest + "}", "a.part.json");
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return file->drawn({3e-3});
}

std::string copies(const std::string& what, int count, const std::string& step) {
    return R"({"repeat": )" + what + R"(, "count": )" + std::to_string(count) + R"(, "step": )" + step + "}";
}

// Each at least 500,000 facets and nothing of it is drawn: in how many seconds?
double refused_after(const std::string& rest) {
    const auto start = std::chrono::steady_clock::now();
    const auto part = drawn(rest);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    REQUIRE_FALSE(part);
    const Error& error = part.errors().front();
    INFO(error.where << ": " << error.message);
    CHECK(error.code == base::ErrorCode::out_of_range);
    CHECK(error.where.find("a.part.json#/solid") == 0);
    CHECK(error.message.find("at least ") != std::string::npos);
    CHECK(error.message.find("at most 500000 are drawn: take fewer copies") != std::string::npos);
    return seconds;
}

TEST_CASE("facets that multiply are refused before they are drawn") {
    std::string doubled = R"("s0": {"sphere": 1})";
    for (int k = 1; k < 60; ++k)
        doubled += ", \"s" + std::to_string(k) + R"(": {"union": ["s)" + std::to_string(k - 1) + R"(", {"move": "s)" +
                   std::to_string(k - 1) + R"(", "by": [)" + std::to_string(3LL << std::min(k, 40)) + ", 0, 0]}]}";
    double seconds = refused_after(R"("solids": {)" + doubled + R"(}, "solid": "s59")");
    for (const char* solid :
         {R"({"sphere": 1})", R"({"torus": [0.9, 0.4]})", R"({"turn": {"sphere": 1}, "by": "30deg", "axis": [1, 0, 0]})",
          R"({"mirror": {"move": {"sphere": 1}, "by": [4, 5, 6]}, "across": "yz"})", R"({"revolve": {"circle": 0.4, "centre": [0.8, 0]}})",
          R"({"extrude": {"circle": 1}, "to": 1})",
          R"({"stack": [{"layer": {"circle": 1}, "height": 0.5}, {"layer": {"circle": 0.8}, "height": 0.5}]})",
          R"({"subtract": {"move": {"sphere": 1}, "by": [90, 0, 0]}, "from": {"sphere": 1}})",
          R"({"twist": {"circle": 0.4}, "to": 1, "by": "360deg"})", R"({"cone": [1, 0.5], "height": 1})"})
        seconds = std::max(
            seconds, refused_after(R"("solid": )" + copies(copies(copies(solid, 30, "[3, 0, 0]"), 30, "[0, 3, 0]"), 30, "[0, 0, 3]")));
    CHECK(seconds < 0.5);
}

// Copies that share material, or touch, may become few facets.
TEST_CASE("what cuts take away is not counted") {
    const std::string cube = R"({"extrude": {"rectangle": [1, 1], "corner": [0, 0]}, "to": 1})";
    const auto bar = drawn(R"("solid": )" + copies(copies(cube, 60, "[1, 0, 0]"), 60, "[0, 1, 0]"));
    REQUIRE(bar);
    CHECK(bar->mesh.triangles.size() < 12 * 60 * 60);
}

// The bound alone, of a file that is read as PartFile reads it.
double facets_at_least(const std::string& rest, const parts::Facets& facets) {
    auto document = files::JsonDocument::parse("{" + rest + "}", "a.part.json");
    REQUIRE(document);
    PartNumbers numbers(1e-3);
    ProfileReader profiles(numbers, document->root()["profiles"]);
    profiles.read_named();
    const FacetBound bound = read_facet_bound(numbers, profiles, document->root()["solids"], document->root()["solid"]);
    REQUIRE(document->errors().empty());
    parts::Drawing drawing(facets);
    const auto made = bound(Sheet{drawing, {}, {}, {}, 0});
    REQUIRE(made);
    return *made;
}

TEST_CASE("no part has fewer facets than its bound, and round ones not many times as many") {
    const std::string ball = R"({"sphere": 1})";
    const std::vector<std::string> solids{
        ball,
        R"({"torus": [0.9, 0.4]})",
        R"({"cone": [1, 0.5], "height": 1})",
        R"({"cone": [1, 0], "height": 1})",
        R"({"extrude": {"circle": 1}, "to": 1})",
        R"({"extrude": {"slot": [[0, 0], [0.5, 0]], "radius": 0.4}, "to": 1, "chamfer": 0.1})",
        R"({"extrude": {"holes": [{"circle": 0.5}], "in": {"circle": 1}}, "to": 1, "chamfer_above": -0.1})",
        R"({"revolve": {"circle": 0.4, "centre": [0.8, 0]}, "angle": "90deg"})",
        R"({"twist": {"circle": 0.6}, "to": 1, "by": "360deg"})",
        R"({"helix": {"circle": 0.2, "centre": [1, 0]}, "pitch": 0.5, "turns": 2})",
        R"({"stack": [{"layer": {"circle": 1}, "height": 0.5}, {"layer": {"circle": 1}, "height": 0.5}]})",
        R"({"stack": [{"repeat": [{"layer": {"circle": 1}, "height": 0.1}, {"layer": {"circle": 2}, "height": 0.1}], "count": 4}]})",
        copies(ball, 3, "[2.5, 0, 0]"),
        copies(ball, 3, "[1.5, 0, 0]"),
        R"({"repeat": {"move": {"sphere": 1}, "by": [4, 0, 0]}, "count": 6})",
        R"({"union": [{"sphere": 1}, {"move": {"sphere": 1}, "by": [1, 0, 0]}, {"move": {"sphere": 1}, "by": [9, 0, 0]}]})",
        R"({"subtract": {"sphere": 1}, "from": {"move": {"sphere": 1}, "by": [1, 0, 0]}})"};
    for (const std::string& solid : solids)
        for (const auto lean : {parts::Lean::cover, parts::Lean::within, parts::Lean::through})
            for (const int segments : {5, 24}) {
                const parts::Facets facets{0, segments, lean};
                const auto file = PartFile::parse(R"({"fettle_part": 1, "dimensions": {}, "solid": )" + solid + "}", "a.part.json");
                REQUIRE(file);
                const auto part = file->drawn({}, facets);
                INFO(solid << " of " << segments << " segments");
                REQUIRE(part);
                const auto made = static_cast<double>(part->mesh.triangles.size());
                const double least = facets_at_least(R"("solid": )" + solid, facets);
                CHECK(least <= made);
                const bool is_cut = solid.find("1.5, 0, 0") != std::string::npos || solid.find("subtract") != std::string::npos;
                if (segments == 24 && !is_cut) CHECK(least >= made / 20);
            }
}

TEST_CASE("what is flat, or in line, counts once") {
    const parts::Facets facets;
    for (const char* outline : {R"({"rectangle": [1, 1]})", R"({"polygon": [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1]]})"}) {
        CHECK(facets_at_least(R"("solid": {"extrude": )" + std::string(outline) + R"(, "to": 1})", facets) <= 8);
        CHECK(facets_at_least(R"("solid": {"revolve": {"move": )" + std::string(outline) + R"(, "by": [1, 0]}})", facets) <= 96);
    }
}

}  // namespace fettle::core::part_files::facet_bound_test
