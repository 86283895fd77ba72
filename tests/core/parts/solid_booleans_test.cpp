// SPDX-License-Identifier: MIT
#include "core/parts/solid_booleans.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "core/parts/extrude.hpp"
#include "core/parts/revolve.hpp"
#include "tests/core/parts/part_check.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::parts::solid_booleans_test {

using part_check::checked;
using part_check::draw;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

namespace {

Result<Solid> box(Drawing& drawing, const Number& x, const Number& y, const Number& z, const char* name) {
    return extruded(drawing, *filled(rectangle({}, x, y, name)), 0, z);
}

}  // namespace

TEST_CASE("solids that do not meet: side by side, within each other") {
    const auto part = [](int which) {
        return [which](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
            const Solid outer = *box(drawing, d[0], d[0], d[0], "outer");
            const Solid inner = moved(*box(drawing, d[1], d[1], d[1], "inner"), {0.3 * d[0], 0.3 * d[0], 0.3 * d[0]});
            const Solid far = moved(inner, {2.0 * d[0], 0, 0});
            if (which == 0) return united(drawing, outer, far);
            if (which == 1) return united(drawing, outer, inner);
            if (which == 2) return difference(drawing, outer, inner);
            if (which == 3) return intersection(drawing, outer, inner);
            return difference(drawing, inner, outer);
        };
    };
    CHECK(volume(checked(part(0), {4e-3, 1e-3})) == Approx(65e-9));
    CHECK(volume(checked(part(1), {4e-3, 1e-3})) == Approx(64e-9));
    CHECK(volume(checked(part(2), {4e-3, 1e-3})) == Approx(63e-9));
    CHECK(volume(checked(part(3), {4e-3, 1e-3})) == Approx(1e-9));
    CHECK(told(draw(part(4), {4e-3, 1e-3}).errors()).find("nothing is left of `inner` when `outer` is cut away") != std::string::npos);
}

TEST_CASE("two boxes, corner in corner") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    const auto part = [](int which) {
        return [which](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
            const Solid a = *box(drawing, d[0], d[1], d[2], "a"),
                        b = moved(*box(drawing, d[0], d[1], d[2], "b"), {d[3], 0.5 * d[3], 0.7 * d[3]});
            return which == 0 ? united(drawing, a, b) : which == 1 ? difference(drawing, a, b) : intersection(drawing, a, b);
        };
    };
    const std::vector<double> d{4e-3, 3e-3, 2e-3, 1e-3};
    const double common = (4 - 1) * (3 - 0.5) * (2 - 0.7) * 1e-9;
    const DrawnPart both = checked(part(0), d);
    CHECK(volume(both) == Approx(48e-9 - common).epsilon(1e-12));
    CHECK(volume(checked(part(1), d)) == Approx(24e-9 - common).epsilon(1e-12));
    CHECK(volume(checked(part(2), d)) == Approx(common).epsilon(1e-12));
    // The structure holds while they cut each other alike, and a change is told.
    const auto near = draw(part(0), {4.1e-3, 3e-3, 2e-3, 0.9e-3}, {}, both.structure);
    REQUIRE(near);
    CHECK(near->changes.empty());
    CHECK(near->mesh.triangles == both.mesh.triangles);
    const auto apart = draw(part(0), {4e-3, 3e-3, 2e-3, 5e-3}, {}, both.structure);
    REQUIRE(apart);
    CHECK_FALSE(apart->changes.empty());
    CHECK(volume(*apart) == Approx(48e-9));
}

TEST_CASE("a cross bore through a shaft with a flat: derivatives through edges in faces") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    const auto part = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const Solid shaft = *extruded(drawing, *filled(circle({}, d[0], "shaft")), 0, d[1]);
        const Facets facets = drawing.facets;
        drawing.facets.lean = opposite(facets.lean);
        const Solid flat = moved(*box(drawing, 3.0 * d[0], 3.0 * d[0], d[1], "flat"), {d[2], -1.5 * d[0], 0.5 * d[1]});
        const Solid pin = *extruded(drawing, *filled(circle({}, d[3], "bore")), -2.0 * d[0], 2.0 * d[0]);
        const Solid across = moved(turned(turned(pin, {0, 1, 0}, pi / 2), {0, 0, 1}, d[4]), {0, 0.1 * d[0], 0.3 * d[1]});
        drawing.facets = facets;
        const auto cut = difference(drawing, shaft, flat);
        if (!cut) return cut;
        return difference(drawing, *cut, across);
    };
    const DrawnPart drawn_part = checked(part, {4e-3, 20e-3, 2.5e-3, 1.2e-3, 0.37});
    // Covering shaft, tools within: nothing of the true part is outside.
    CHECK(drawn_part.deviation.out < 1e-11);  // rounding where edges go through faces at small angles
    CHECK(drawn_part.deviation.out_is_proven);
    CHECK(drawn_part.deviation.in > 0);
    CHECK_FALSE(drawn_part.deviation.in_is_proven);
    bool has_bore = false;
    for (std::size_t t = 0; t < drawn_part.facets.size(); ++t) {
        const DrawnSurface& surface = drawn_part.surfaces[drawn_part.facets[t].surface];
        if (surface.feature != "bore" || surface.kind != SurfaceKind::cylinder) continue;
        has_bore = true;
        CHECK(surface.hollow);
        CHECK(surface.radius == 1.2e-3);
    }
    CHECK(has_bore);
    // Steinmetz: two cylinders of one radius across each other have 16 r^3 / 3 in common.
    const auto steinmetz = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const Solid pin = *extruded(drawing, *filled(circle({}, d[0], "pin")), -2.0 * d[0], 2.0 * d[0]);
        return intersection(drawing, pin, turned(turned(pin, {0, 0, 1}, 0.03), {1, 0, 0}, pi / 2));
    };
    CHECK(volume(checked(steinmetz, {1e-3}, {0, 80, Lean::through})) == Approx(16e-9 / 3).epsilon(2e-3));
}

TEST_CASE("random boxes, balls and pins: volumes add up, meshes are solids") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    std::mt19937 random(23);
    const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967296.0; };
    for (int trial = 0; trial < 40; ++trial) {
        const int kind_a = static_cast<int>(random() % 3), kind_b = static_cast<int>(random() % 3);
        const Point3 shift{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, axis{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        const double angle = uniform(0, 6);
        const auto figure = [](Drawing& drawing, int kind, const Number& size) {
            if (kind == 0) return *box(drawing, size, 1.3 * size, 0.8 * size, "box");
            if (kind == 1) return *sphere(drawing, 0.7 * size, "ball");
            return *extruded(drawing, *filled(circle({}, 0.5 * size, "pin")), 0, 1.5 * size);
        };
        const auto part = [&](int which) {
            return [&, which](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
                const Solid a = figure(drawing, kind_a, d[0]), b = turned(moved(figure(drawing, kind_b, d[1]), shift), axis, angle);
                if (which == 3) return a;
                if (which == 4) return b;
                return which == 0 ? united(drawing, a, b) : which == 1 ? difference(drawing, a, b) : intersection(drawing, a, b);
            };
        };
        const Facets facets{0, 16, Lean::through};
        const std::vector<double> d{2, 1.7};
        const double of_a = volume(*draw(part(3), d, facets)), of_b = volume(*draw(part(4), d, facets));
        const auto common = draw(part(2), d, facets);
        const double both = common ? volume(*common) : 0;
        INFO("trial " << trial);
        CHECK(volume(trial < 8 ? checked(part(0), d, facets) : *draw(part(0), d, facets)) == Approx(of_a + of_b - both).epsilon(1e-10));
        const auto rest = draw(part(1), d, facets);
        INFO(told(rest.errors()));
        if (rest || of_a - both > 1e-12) {
            REQUIRE(rest);
            CHECK(volume(*rest) == Approx(of_a - both).epsilon(1e-10));
        }
    }
}

TEST_CASE("flush faces are cut cleanly") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    const auto part = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const Solid block = *box(drawing, d[0], d[0], d[0], "block");
        const Solid slot = moved(*box(drawing, 0.5 * d[0], d[0], 0.5 * d[0], "slot"), {0.25 * d[0], 0, 0.5 * d[0]});
        return difference(drawing, block, slot);
    };
    CHECK(volume(checked(part, {4e-3})) == Approx(48e-9));
}

}  // namespace fettle::core::parts::solid_booleans_test
