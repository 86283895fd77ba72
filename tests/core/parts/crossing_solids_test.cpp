// SPDX-License-Identifier: MIT
// Prisms and cylinders that cross at right angles, at 45 degrees and the like through one point, as shafts and bores do: edges meet edges
// to within rounding there. Volumes of union, intersection and difference must add up.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/geometry/mass_moments.hpp"
#include "core/parts/drawn_part.hpp"
#include "core/parts/extrude.hpp"
#include "core/parts/solid_booleans.hpp"
#include "core/parts/solid_cut.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::parts::crossing_solids_test {

namespace {

constexpr double mm = 1e-3;

struct Crossing {
    int shape_a, shape_b;  // 0: circle, 1: square, 2: hexagon
    double radius_a, radius_b, angle;
    Point3 axis;
};

Result<Solid> prism(Drawing& drawing, int shape, double r, double half) {
    Loop outline = circle({}, r, "circle");
    if (shape == 1) outline = rectangle({-r, -r}, 2 * r, 2 * r, "square");
    if (shape == 2) {
        std::vector<Point2> corners;
        for (int k = 0; k < 6; ++k) corners.push_back({r * std::cos(k * std::numbers::pi / 3), r * std::sin(k * std::numbers::pi / 3)});
        outline = polygon(corners, "hexagon");
    }
    return extruded(drawing, *filled(outline), -half, half);
}

// What is drawn of a combination: its volume; nothing where it is refused.
std::optional<double> volume_of(const Crossing& c, Combination combination) {
    Drawing drawing;
    const auto a = prism(drawing, c.shape_a, c.radius_a, 12 * mm);
    const auto b = turned(*prism(drawing, c.shape_b, c.radius_b, 14 * mm), c.axis, c.angle);
    const Result<Solid> solid = combination == Combination::unite       ? united(drawing, *a, b)
                                : combination == Combination::intersect ? intersection(drawing, *a, b)
                                                                        : difference(drawing, *a, b);
    if (!solid) return std::nullopt;
    const Result<DrawnPart> part = drawn(drawing, *solid, "part", {.jacobian = false});
    if (!part) return std::nullopt;
    return geometry::solid_moments(part->mesh.vertices, part->mesh.triangles)(3, 3);
}

double volume_alone(int shape, double r, double half) {
    Drawing drawing;
    const auto part = drawn(drawing, *prism(drawing, shape, r, half), "part", {.jacobian = false});
    return geometry::solid_moments(part->mesh.vertices, part->mesh.triangles)(3, 3);
}

struct Campaign {
    int asked = 0, refused = 0;

    void run(unsigned seed, int count) {
        std::mt19937 random(seed);
        const auto among = [&](const auto& list) { return list[random() % list.size()]; };
        const std::vector<int> shapes{0, 1, 2};
        const std::vector<double> radii{2 * mm, 2.5 * mm, 3 * mm, 4 * mm, 5 * mm}, degrees{30, 45, 60, 90, 120, 135};
        const std::vector<Point3> axes{{0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
        for (int k = 0; k < count; ++k) {
            const Crossing c{among(shapes), among(shapes), among(radii), among(radii), among(degrees) * std::numbers::pi / 180,
                             among(axes)};
            if (c.radius_a == c.radius_b) continue;  // touch along lines: no solid, some of them
            check(c);
        }
    }

    void check(const Crossing& c) {
        CAPTURE(c.shape_a, c.shape_b, c.radius_a, c.radius_b, c.angle);
        const double a = volume_alone(c.shape_a, c.radius_a, 12 * mm), b = volume_alone(c.shape_b, c.radius_b, 14 * mm);
        const auto both = volume_of(c, Combination::intersect), all = volume_of(c, Combination::unite),
                   left = volume_of(c, Combination::subtract);
        asked += 3;
        for (const auto& volume : {both, all, left}) refused += volume ? 0 : 1;
        if (both && all) CHECK(*both + *all == Approx(a + b).epsilon(1e-9));
        if (both && left) CHECK(*both + *left == Approx(a).epsilon(1e-9));
    }
};

}  // namespace

TEST_CASE("solids that cross at usual angles through one point are cut, and their volumes add up") {
    if (!has_solid_booleans()) FETTLE_SKIP("this build cannot cut solids");
    Campaign campaign;
    // Two bores, as a user drilled them: refused once for an edge of 1e-15 mm.
    campaign.check({0, 0, 4 * mm, 3 * mm, std::numbers::pi / 2, {0, 1, 0}});
    campaign.check({1, 2, 3 * mm, 4 * mm, std::numbers::pi / 4, {0, 1, 0}});
    campaign.check({2, 1, 3 * mm, 5 * mm, std::numbers::pi / 3, {1, 1, 0}});
    CHECK(campaign.refused == 0);
    campaign.run(1, 40);
    INFO(campaign.refused << " of " << campaign.asked);
    CHECK(100 * campaign.refused <= campaign.asked);
}

TEST_CASE("many solids that cross at usual angles", "[slow]") {
    if (!has_solid_booleans()) FETTLE_SKIP("this build cannot cut solids");
    Campaign campaign;
    campaign.run(2, 1000);
    INFO(campaign.refused << " of " << campaign.asked);
    CHECK(100 * campaign.refused <= campaign.asked);
}

}  // namespace fettle::core::parts::crossing_solids_test
