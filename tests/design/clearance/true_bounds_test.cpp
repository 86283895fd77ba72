// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/clearance/report.hpp"
#include "design/reading/scene_shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::clearance::true_bounds_test {

namespace {

struct Judged {
    Subject subject;
    ClearanceReport report;
};

// A pin of radius 4.8 mm in a bore of 5 mm, as far off the axis as `offset` [mm] says; facets as given.
Judged pin_in_bore(double offset, const std::string& facets, const std::string& scale = "1") {
    const tests::support::TemporaryFolder folder;
    const std::string path = folder.write(
        "a.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "hub", "type": "static", "scale": )" +
                            scale + R"(, "shape": {"solid": {"extrude": {"holes": {"circle": 5}, "in": {"circle": 8}}, "to": 6})" + facets +
                            R"(}},
        {"name": "pin", "type": "static", "scale": )" +
                            scale + R"(, "position": [)" + std::to_string(offset) +
                            R"(, 0, 0], "shape": {"solid": {"extrude": {"circle": 4.8}, "from": -1, "to": 7})" + facets + "}}]}");
    const auto scene = core::scene_files::read_scene(path, reading::scene_read_options());
    for (const Error& error : scene.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(scene);
    auto model = core::setup::build_model(*scene);
    for (const Error& error : model.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(model);
    Judged out{subject_of(std::move(*model)), {}};
    auto report = judge_clearances(out.subject, {});
    REQUIRE(report);
    out.report = std::move(*report);
    REQUIRE(out.report.pairs.size() == 1);
    return out;
}

}  // namespace

TEST_CASE("true bounds: a round pin in a round bore, whatever the facets", "[clearance]") {
    for (const char* facets : {R"(, "counts": {"segments": 24})", R"(, "counts": {"segments": 37})", R"(, "facets": "0.001mm")", ""})
        for (const double offset : {0.0, 0.05, 0.13}) {
            const Judged judged = pin_in_bore(offset, facets);
            const auto& pair = judged.report.pairs[0];
            const auto bounds = true_bounds(judged.subject, pair);
            INFO(facets << ", " << offset << " mm");
            REQUIRE(bounds);
            const double truth = (0.2 - offset) * 1e-3;
            CHECK(bounds->lower_is_proven);
            CHECK(bounds->upper_is_proven);
            CHECK(bounds->lower <= truth);
            CHECK(bounds->upper >= truth);
            // As wide as the meshes' own bounds and what facets leave the circles by: r (1 - cos(pi/n)), outside or inside.
            double play = 0;
            for (const core::model::Body& body : judged.subject.model.bodies) {
                REQUIRE(body.mesh.deviation);
                play += body.mesh.deviation->out + body.mesh.deviation->in;
            }
            CHECK(bounds->upper - bounds->lower <= pair.least.upper - pair.least.lower + play + 1e-12);
            if (std::string(facets).find("24") != std::string::npos)
                CHECK(play < 2 * 8e-3 / std::cos(M_PI / 24) * (1 - std::cos(M_PI / 24)) + 1e-9);
        }
}

TEST_CASE("true bounds: a scaled part is as far off as its scale says; meshes that are drawn for nothing have none", "[clearance]") {
    const Judged judged = pin_in_bore(0.05, R"(, "counts": {"segments": 16})", "2");
    const auto bounds = true_bounds(judged.subject, judged.report.pairs[0]);
    REQUIRE(bounds);
    CHECK(bounds->lower <= 0.35e-3);
    CHECK(bounds->upper >= 0.35e-3);

    Judged plain = pin_in_bore(0.05, "");
    for (core::model::Body& body : plain.subject.model.bodies) body.mesh.deviation.reset();
    CHECK_FALSE(true_bounds(plain.subject, plain.report.pairs[0]));
}

TEST_CASE("true bounds: what is found from samples is not proven; parts that touch have none", "[clearance]") {
    Judged judged = pin_in_bore(0.05, "");
    judged.subject.model.bodies[0].mesh.deviation->out_is_proven = false;
    const auto bounds = true_bounds(judged.subject, judged.report.pairs[0]);
    REQUIRE(bounds);
    CHECK_FALSE(bounds->lower_is_proven);
    CHECK(bounds->upper_is_proven);
    judged.report.pairs[0].finding = Finding::touching;
    CHECK_FALSE(true_bounds(judged.subject, judged.report.pairs[0]));
}

}  // namespace fettle::design::clearance::true_bounds_test
