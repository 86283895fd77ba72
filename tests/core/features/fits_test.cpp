// SPDX-License-Identifier: MIT
#include "core/features/fits.hpp"

#include <catch2/catch.hpp>

#include "core/features/find_features.hpp"
#include "core/features/fit_gap.hpp"
#include "core/model/body_geometry.hpp"
#include "core/setup/build_model.hpp"
#include "tests/core/features/known_parts.hpp"

namespace fettle::core::features::fits_test {

using namespace known_parts;  // NOLINT(google-build-using-namespace)

namespace {

Features one(Feature feature) {
    Features out;
    out.tolerance = 1e-7;
    feature.name = feature.is_hole ? "B1" : "P1";
    out.features.push_back(std::move(feature));
    return out;
}

// An exact cylinder, as a reader of exact surfaces would hand it in.
Feature cylinder(bool hole, double radius, const Vector3& axis, const Vector3& middle, double length) {
    Feature out;
    out.surface = {SurfaceKind::cylinder, middle, axis.normalized(), radius, 0};
    out.is_hole = hole;
    out.is_exact = true;
    const double at = out.surface.axis.dot(middle);
    out.origin = middle - at * out.surface.axis;
    out.along = {at - 0.5 * length, at + 0.5 * length};
    out.pieces = {out.along};
    out.covered = 2 * std::numbers::pi;
    out.facets_least = out.facets_largest = radius;
    return out;
}

}  // namespace

TEST_CASE("a hole that goes no more than half round does not hold its pin") {
    const Feature pin = cylinder(false, 2 * mm, {0, 0, 1}, {0, 0, 0}, 20 * mm);
    for (const double degrees : {90.0, 180.0, 200.0, 360.0}) {
        Feature hole = cylinder(true, 2.1 * mm, {0, 0, 1}, {0, 0, 0}, 8 * mm);
        hole.covered = degrees * std::numbers::pi / 180;
        const std::vector<Fit> fits = find_fits({one(hole), one(pin)});
        REQUIRE(fits.size() == 1);
        CHECK(fits[0].is_held == (degrees > 190));
    }
}

TEST_CASE("a pin in a bore: play, overlap, off centre") {
    const Feature pin = cylinder(false, 2 * mm, {1, 0, 0}, {30 * mm, 44 * mm, 20 * mm}, 50 * mm);
    const Feature bore = cylinder(true, 2.1 * mm, {-1, 0, 0}, {10 * mm, 44.03 * mm, 20 * mm}, 8 * mm);
    const std::vector<Fit> fits = find_fits({one(bore), one(pin)});
    REQUIRE(fits.size() == 1);
    CHECK(fits[0].pin.body == 1);
    CHECK(fits[0].hole.body == 0);
    CHECK(fits[0].is_held);
    CHECK(fits[0].play == Approx(0.1 * mm));
    CHECK(fits[0].overlap == Approx(8 * mm));
    CHECK(fits[0].off_centre == Approx(0.03 * mm));
    CHECK_FALSE(fits[0].is_centred);
    CHECK(fits[0].lean < 1e-12);
}

TEST_CASE("what is no fit: beside, too wide, beyond the end, of one body, a rounded corner") {
    const Feature pin = cylinder(false, 2 * mm, {0, 0, 1}, {0, 0, 0}, 10 * mm);
    const auto count = [&](Feature hole) { return find_fits({one(pin), one(std::move(hole))}).size(); };
    CHECK(count(cylinder(true, 2.1 * mm, {0, 0, 1}, {0, 0, 0}, 5 * mm)) == 1);
    CHECK(count(cylinder(true, 2.1 * mm, {0, 0, 1}, {0.2 * mm, 0, 0}, 5 * mm)) == 0);
    CHECK(count(cylinder(true, 9 * mm, {0, 0, 1}, {0, 0, 0}, 5 * mm)) == 0);
    CHECK(count(cylinder(true, 2.1 * mm, {0, 0, 1}, {0, 0, 20 * mm}, 5 * mm)) == 0);
    CHECK(count(cylinder(true, 2.1 * mm, {1, 0, 0}, {0, 0, 0}, 5 * mm)) == 0);
    CHECK(count(cylinder(true, 1.98 * mm, {0, 0, 1}, {0, 0, 0}, 5 * mm)) == 1);  // pressed in
    Feature corner = cylinder(true, 2.1 * mm, {0, 0, 1}, {0, 0, 0}, 5 * mm);
    corner.is_rounding = true;
    CHECK(count(corner) == 0);
    Features both = one(pin);
    both.features.push_back(cylinder(true, 2.1 * mm, {0, 0, 1}, {0, 0, 0}, 5 * mm));
    CHECK(find_fits({both}).empty());
}

TEST_CASE("random fits of drawn parts: the play is found, and the proven gap is below it by the facets alone") {
    for (unsigned seed = 1; seed <= 25; ++seed) {
        Chance chance(seed);
        const double r = chance.between(1, 6) * mm, play = chance.between(0.02, 0.15) * r;
        const bool is_ball = chance.among(4) == 0;
        scene::Scene scene;
        scene.length_unit = mm;
        for (const bool hole : {false, true}) {
            scene::Body body;
            body.name = hole ? "plate" : "pin";
            body.type = scene::BodyType::static_body;
            body.mesh = drawn_mesh([&](Drawing& drawing) -> Result<Solid> {
                if (is_ball && hole) {
                    const Solid block =
                        moved(*extruded(drawing, *filled(rectangle({-3.0 * r, -3.0 * r}, 6.0 * r, 6.0 * r, "block")), 0, 6.0 * r),
                              {0, 0, -3.0 * r});
                    return difference(drawing, block, *sphere(drawing, r + play, "socket"));
                }
                if (is_ball) return sphere(drawing, r, "ball");
                if (hole)
                    return extruded(
                        drawing,
                        *with_hole(*filled(rectangle({-20 * mm, -20 * mm}, 40 * mm, 40 * mm, "plate")), circle({}, r + play, "bore")), 0,
                        6 * mm);
                return moved(*extruded(drawing, *filled(circle({}, r, "pin")), 0, 20 * mm), {0, 0, -5 * mm});
            });
            scene.bodies.push_back(body);
        }
        setup::BuildOptions options;
        options.check_start = false;
        const auto model = setup::build_model(scene, options);
        REQUIRE(model);
        std::vector<Features> parts;
        for (const model::Body& body : model->bodies) parts.push_back(find_features(model::mesh_at_start(body)));
        const std::vector<Fit> fits = find_fits(parts);
        INFO("seed " << seed << ", r " << r << ", play " << play << (is_ball ? ", a ball" : ""));
        REQUIRE(fits.size() == 1);
        CHECK(fits[0].play == Approx(play).margin(1e-7));
        CHECK(fits[0].is_centred);
        CHECK(fits[0].facets_play <= fits[0].play + 1e-9);
        const clearance::PairClearance gap = fit_gaps(*model, parts, fits).front();
        CHECK(gap.lower > 0);
        CHECK(gap.lower <= play + 1e-9);
        // Centred: the proven gap of the facets is no less than what they leave about the common axis.
        CHECK(gap.upper >= fits[0].facets_play - 1e-9);
    }
}

}  // namespace fettle::core::features::fits_test
