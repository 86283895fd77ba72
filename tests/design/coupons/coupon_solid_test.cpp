// SPDX-License-Identifier: MIT
#include "design/coupons/coupon_solid.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace fettle::design::coupons::coupon_solid_test {

namespace {

using core::geometry::Mesh;
using tolerances::FeatureKind;

// The area of the union of a label's bars, by a raster of 0.1 mm: bars are whole numbers of these.
double area_of(const std::string& text, const StrokeFont& font) {
    std::set<std::pair<long, long>> cells;
    constexpr double cell = 1e-4;
    for (const Bar& bar : bars_of(text, font)) {
        for (long i = std::lround(bar.x / cell); i < std::lround((bar.x + bar.width) / cell); ++i)
            for (long j = std::lround(bar.y / cell); j < std::lround((bar.y + bar.height) / cell); ++j) cells.insert({i, j});
    }
    return static_cast<double>(cells.size()) * cell * cell;
}

double closed_form_volume(const Coupon& coupon) {
    double volume = coupon.width * coupon.depth * coupon.thickness;
    for (const CouponFeature& feature : coupon.features) {
        const double disc = std::numbers::pi * feature.nominal * feature.nominal / 4, above = feature.height - coupon.thickness;
        if (feature.kind == FeatureKind::hole) volume -= disc * coupon.thickness;
        if (feature.kind == FeatureKind::slot) volume -= feature.nominal * feature.length * coupon.thickness;
        if (feature.kind == FeatureKind::pin) volume += disc * above;
        if (feature.kind == FeatureKind::wall) volume += feature.nominal * feature.length * above;
        if (feature.kind == FeatureKind::gap) volume += 2 * coupon.rib * feature.length * above;
    }
    for (const CouponLabel& label : coupon.labels) volume += area_of(label.text, coupon.font) * coupon.label_height;
    return volume;
}

// What facets add at most: pins hold their circles, holes lie within theirs, both within 2 um.
double round_volume(const Coupon& coupon) {
    double volume = 0;
    for (const CouponFeature& feature : coupon.features) {
        const double height = feature.kind == FeatureKind::hole  ? coupon.thickness
                              : feature.kind == FeatureKind::pin ? feature.height - coupon.thickness
                                                                 : 0;
        volume += std::numbers::pi * feature.nominal * 2e-6 * height;
    }
    return volume;
}

void check_volume(const Coupon& coupon, const Mesh& mesh) {
    const double exact = closed_form_volume(coupon);
    CHECK(volume_of(mesh) >= exact);
    CHECK(volume_of(mesh) <= exact + round_volume(coupon));
}

// Every directed edge once, with its opposite.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges)
        if (count != 1 || edges.count({edge.second, edge.first}) == 0) return false;
    return true;
}

}  // namespace

TEST_CASE("coupons: the solid is closed, in one piece, and as large as its features say") {
    const auto plate = coupon({});
    REQUIRE(plate);
    const auto mesh = coupon_mesh(*plate);
    for (const Error& error : mesh.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(mesh);
    CHECK(is_closed(*mesh));
    CHECK(*std::max_element(mesh->triangle_shell.begin(), mesh->triangle_shell.end()) == 0);
    check_volume(*plate, *mesh);
    CHECK(volume_of(*mesh) < 12e-6);  // half an hour
    const Vector3 low = mesh->vertices.rowwise().minCoeff(), high = mesh->vertices.rowwise().maxCoeff();
    CHECK(low.norm() == 0);
    CHECK(high.x() == plate->width);
    CHECK(high.y() == plate->depth);
    CHECK(high.z() == Approx(9e-3));
}

TEST_CASE("coupons: more and larger features") {
    const auto plate = coupon({CouponKind::printed, 11, {{FeatureKind::hole, 2e-3, 12e-3}, {FeatureKind::height, 4e-3, 12e-3}}});
    REQUIRE(plate);
    const auto mesh = coupon_mesh(*plate);
    for (const Error& error : mesh.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(mesh);
    CHECK(is_closed(*mesh));
    check_volume(*plate, *mesh);
}

TEST_CASE("coupons: the outline to cut has holes, slots and fingers, and labels as lines") {
    const auto plate = coupon({CouponKind::cut, 6, {}});
    REQUIRE(plate);
    const auto outline = coupon_outline(*plate);
    for (const Error& error : outline.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(outline);
    CHECK(outline->loops.size() == 1 + 6 + 6);
    double area = plate->width * plate->depth, first = plate->width;
    for (const CouponFeature& feature : plate->features) {
        if (feature.kind == FeatureKind::hole) area -= std::numbers::pi * feature.nominal * feature.nominal / 4;
        if (feature.kind == FeatureKind::slot) area -= feature.nominal * feature.length;
        if (feature.kind == FeatureKind::gap) area -= feature.nominal * feature.length;
        if (feature.kind == FeatureKind::wall) first = std::min(first, feature.x - feature.nominal / 2);
    }
    area += (plate->width - first) * 10e-3;
    CHECK(core::parts::area(*outline).value == Approx(area).epsilon(1e-9));
    const auto svg = coupon_svg(*plate);
    REQUIRE(svg);
    CHECK(svg->find("stroke=\"blue\"") != std::string::npos);
    CHECK(svg->ends_with("</svg>\n"));
}

}  // namespace fettle::design::coupons::coupon_solid_test
