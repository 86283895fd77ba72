// SPDX-License-Identifier: MIT
#include "core/parts/profile_booleans.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "core/parts/extrude.hpp"
#include "core/parts/sampled_loops.hpp"
#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::profile_booleans_test {

using part_check::checked;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

namespace {

double lens(double r, double d) { return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d); }

double area_of(const Result<Profile>& profile) {
    INFO(told(profile.errors()));
    REQUIRE(profile);
    CHECK(told(faults_of(*profile)).empty());
    return area(*profile).value;
}

Profile square(double x, double y, double a, const char* name) { return *filled(rectangle({x, y}, a, a, name)); }

}  // namespace

TEST_CASE("two circles: union, difference and intersection by the formula of the lens") {
    const auto a = *filled(circle({0, 0}, 1, "a")), b = *filled(circle({0.7, 0.4}, 1, "b"));
    const double common = lens(1, std::hypot(0.7, 0.4));
    CHECK(area_of(united(a, b)) == Approx(2 * pi - common).epsilon(1e-12));
    CHECK(area_of(difference(a, b)) == Approx(pi - common).epsilon(1e-12));
    CHECK(area_of(intersection(a, b)) == Approx(common).epsilon(1e-12));
    // Two arcs each: what is cut over a circle's start is one arc again.
    CHECK(united(a, b)->loops.front().segments.size() == 2);
    CHECK(intersection(a, b)->loops.front().segments.size() == 2);
    // Apart, within, the same.
    const auto far = *filled(circle({5, 0}, 1, "far")), small = *filled(circle({0.1, 0}, 0.2, "small"));
    CHECK(area_of(united(a, far)) == Approx(2 * pi));
    CHECK(area_of(difference(a, far)) == Approx(pi));
    CHECK(intersection(a, far)->loops.empty());
    CHECK(area_of(difference(a, small)) == Approx(pi * 0.96));
    CHECK(difference(small, a)->loops.empty());
    CHECK(area_of(united(a, a)) == Approx(pi));
    CHECK(difference(a, a)->loops.empty());
    CHECK(area_of(intersection(a, a)) == Approx(pi));
}

TEST_CASE("figures that share edges, corners and tangents") {
    const auto a = square(0, 0, 2, "a");
    CHECK(area_of(united(a, square(2, 0, 2, "b"))) == Approx(8));
    CHECK(united(a, square(2, 0, 2, "b"))->loops.size() == 1);
    CHECK(area_of(united(a, square(2, 1, 2, "b"))) == Approx(8));
    CHECK(area_of(difference(a, square(0, 0, 1, "b"))) == Approx(3));
    CHECK(area_of(difference(a, square(1, 0.5, 1, "b"))) == Approx(3));
    CHECK(area_of(intersection(a, square(1, 1, 1, "b"))) == Approx(1));
    CHECK(intersection(a, square(2, 0, 1, "b"))->loops.empty());
    // A slot whose round end is the rim's own curve, tangent sides.
    const auto link = *filled(slot({0, 0}, {4, 0}, 1, "link"));
    CHECK(area_of(united(link, *filled(circle({0, 0}, 1, "end")))) == Approx(8 + pi));
    CHECK(area_of(difference(link, *filled(circle({0, 0}, 1, "end")))) == Approx(8 + pi / 2 - pi / 2).epsilon(1e-9));
    CHECK(area_of(united(*filled(rectangle({0, -1}, 4, 2, "bar")), *filled(circle({0, 0}, 1, "end")))) == Approx(8 + pi / 2));
    // Squares on each other's corner: two figures that touch in a point.
    const auto corners = united(a, square(2, 2, 2, "b"));
    REQUIRE(corners);
    CHECK(area(*corners).value == Approx(8));
    CHECK(corners->loops.size() == 2);
}

TEST_CASE("splines and laws are cut where they are") {
    const auto blob = Path({1, 0}, "blob").spline_through({{0.4, 0.9}, {-0.8, 0.5}, {-0.7, -0.6}, {0.5, -0.8}}).closed();
    const auto limacon = Path({3, 0}, "limacon")
                             .along(law_curve(Law([](const auto& t) {
                                                  using std::cos, std::sin;
                                                  const auto r = 2.0 + cos(t);
                                                  return std::array{r * cos(t), r * sin(t)};
                                              }),
                                              0, 2 * pi))
                             .closed();
    const auto a = *filled(*blob), b = *filled(*limacon), c = square(-0.5, -0.5, 4, "square");
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{a, c}, std::pair{b, c}}) {
        const double both = area_of(intersection(p, q)), all = area(p).value + area(q).value;
        CHECK(area_of(united(p, q)) == Approx(all - both).epsilon(1e-9));
        CHECK(area_of(difference(p, q)) == Approx(area(p).value - both).epsilon(1e-9));
    }
}

TEST_CASE("derivatives go through cuts of all kinds of curves") {
    const auto part = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto disc = filled(circle({}, d[0], "rim"));
        const auto slots = polar_copies(slot({d[1], 0}, {2.0 * d[0], 0}, d[2], "slot"), 4);
        auto profile = *disc;
        for (const Loop& loop : slots) {
            auto next = difference(profile, *filled(loop));
            if (!next) return next.errors();
            profile = *next;
        }
        const Number reach = d[0];
        const auto flower = Path({1.15 * reach, 0}, "flower")
                                .along(law_curve(Law([reach](const auto& t) {
                                                     using std::cos, std::sin;
                                                     const auto r = reach * (1.0 + 0.15 * cos(8.0 * t));
                                                     return std::array{r * cos(t), r * sin(t)};
                                                 }),
                                                 0, 2 * pi))
                                .closed();
        if (!flower) return flower.errors();
        const auto cut = intersection(profile, *filled(*flower));
        if (!cut) return cut.errors();
        const auto blob = Path({d[1], d[1]}, "blob").spline_through({{0, 1.5 * d[0]}, {-d[1], d[1]}, {-0.2 * d[0], -0.1 * d[1]}}).closed();
        const auto all = united(*cut, *filled(*blob));
        if (!all) return all.errors();
        return extruded(drawing, *all, 0, d[3]);
    };
    checked(part, {20e-3, 8e-3, 2e-3, 3e-3});
    checked(part, {20e-3, 8e-3, 2e-3, 3e-3}, {1e-4, 0, Lean::through});
}

TEST_CASE("random Booleans of boxes and circles: areas add up") {
    std::mt19937 random(7);
    const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967296.0; };
    for (int trial = 0; trial < 200; ++trial) {
        const auto figure = [&](const char* name) {
            const Point2 centre{uniform(-1, 1), uniform(-1, 1)};
            if (random() % 2 == 0) return *filled(circle(centre, uniform(0.3, 1.2), name));
            const auto box = *filled(rectangle(centre, uniform(0.3, 2), uniform(0.3, 2), name));
            return random() % 2 == 0 ? box : turned(box, uniform(0, 6));
        };
        const auto a = figure("a"), b = figure("b"), c = figure("c");
        const auto ab = united(a, b);
        const double both = area(*intersection(a, b)).value;
        CHECK(area_of(ab) == Approx(area(a).value + area(b).value - both).epsilon(1e-9));
        const auto rest = difference(*ab, c), common = intersection(*ab, c);
        REQUIRE(rest);
        REQUIRE(common);
        CHECK(area(*rest).value + area(*common).value == Approx(area(*ab).value).epsilon(1e-9));
        CHECK(told(faults_of(*rest)).empty());
    }
}

TEST_CASE("offsets have the area of Steiner's formula, and grow and shrink by what they say") {
    const double a = 4, b = 3, d = 0.5;
    const auto box = *filled(rectangle({0, 0}, a, b, "box"));
    CHECK(area_of(offset(box, d)) == Approx(a * b + 2 * (a + b) * d + pi * d * d).epsilon(1e-12));
    CHECK(area_of(offset(box, -d)) == Approx((a - 2 * d) * (b - 2 * d)).epsilon(1e-12));
    CHECK(offset(box, -1.6)->loops.empty());
    const auto ring = *with_hole(*filled(circle({}, 3, "rim")), circle({}, 1, "bore"));
    CHECK(area_of(offset(ring, 0.4)) == Approx(pi * (3.4 * 3.4 - 0.6 * 0.6)).epsilon(1e-12));
    CHECK(area_of(offset(ring, 1.5)) == Approx(pi * 4.5 * 4.5).epsilon(1e-12));
    CHECK(offset(ring, -1.1)->loops.empty());
    // An angle of two bars: its inner corner stays sharp, the outer ones are rounded.
    const auto angle = *filled(polygon({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, "angle"));
    CHECK(area_of(offset(angle, 0.2)) == Approx(7 + 0.2 * 16 + (5 - 4) * 0.04 * pi / 4 + 4 * 0.04 * pi / 4 - 0.04).epsilon(1e-9));
    CHECK(area_of(offset(angle, -0.2)) == Approx(0.6 * (3.6 + 3.0) + 0.04 - pi * 0.01).epsilon(1e-9));
    // A cusp between a line and the arc that it touches: half an arc about it.
    const auto cusp = *difference(*filled(rectangle({0, 0}, 2, 1, "bar")), *filled(circle({1, 1}, 1, "round")));
    CHECK(area(cusp).value == Approx(2 - pi / 2));
    for (const Loop& loop : cusp.loops) {
        const auto grown = offset(Profile{{loop}}, 0.1);
        INFO(told(grown.errors()));
        REQUIRE(grown);
        const SampledLoops around({loop});
        for (const Segment& segment : grown->loops.front().segments)
            for (int k = 0; k <= 10; ++k) CHECK(around.nearest(at(segment.curve, k / 10.0).position).distance == Approx(0.1).epsilon(1e-9));
    }
    // A dumb-bell comes apart.
    const auto bell = *united(*united(*filled(circle({-3, 0}, 1, "left")), *filled(circle({3, 0}, 1, "right"))),
                              *filled(rectangle({-3, -0.2}, 6, 0.4, "bar")));
    const auto apart = offset(bell, -0.3);
    REQUIRE(apart);
    CHECK(apart->loops.size() == 2);
    const SampledLoops around(bell.loops);
    for (const Loop& loop : apart->loops)
        for (const Segment& segment : loop.segments)
            for (int k = 0; k <= 10; ++k) CHECK(around.nearest(at(segment.curve, k / 10.0).position).distance == Approx(0.3).epsilon(1e-9));
}

TEST_CASE("an offset of a law is as far from it everywhere, with exact derivatives") {
    const auto pitch_curve = [](const Number& base, const Number& rise) {
        return Path({base + rise, 0}, "cam")
            .along(law_curve(Law([base, rise](const auto& t) {
                                 using std::cos, std::sin;
                                 const auto r = base + rise * cos(2.0 * t);
                                 return std::array{r * cos(t), r * sin(t)};
                             }),
                             0, 2 * pi))
            .closed();
    };
    const auto pitch = *filled(*pitch_curve(10, 2));
    for (const double d : {-2.0, 1.0}) {
        const auto cam = offset(pitch, d);
        INFO(told(cam.errors()));
        REQUIRE(cam);
        const SampledLoops around(pitch.loops);
        for (const Segment& segment : cam->loops.front().segments)
            for (int k = 0; k <= 20; ++k)
                CHECK(around.nearest(at(segment.curve, k / 20.0).position).distance == Approx(std::abs(d)).epsilon(1e-6));
    }
    const auto part = [&](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto loop = pitch_curve(d[0], d[1]);
        if (!loop) return loop.errors();
        const auto cam = offset(*filled(*loop), -d[2]);
        if (!cam) return cam.errors();
        return extruded(drawing, *cam, 0, d[3]);
    };
    const DrawnPart cam = checked(part, {20e-3, 4e-3, 3e-3, 5e-3}, {0, 120});
    CHECK(cam.deviation.out_is_proven);
    // A roller too large for the hollows: the cam is undercut there, and the curve crosses itself.
    checked(part, {20e-3, 8e-3, 6e-3, 5e-3}, {0, 120});
}

}  // namespace fettle::core::parts::profile_booleans_test
