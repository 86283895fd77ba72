// SPDX-License-Identifier: MIT
#include "core/parts/profile.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "core/parts/extrude.hpp"
#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::profile_test {

using part_check::checked;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

TEST_CASE("a hole that breaks through is told with its wall and where") {
    const auto plate = filled(circle({}, 10e-3, "rim"));
    const double angle = 37 * pi / 180;
    const auto pierced = with_hole(*plate, circle(polar(7.2e-3, angle), 3e-3, "axle"));
    CHECK(told(pierced.errors()) == "axle: hole `axle` breaks through `rim`: wall -0.2 mm at 37 deg\n");
    CHECK(with_hole(*plate, circle(polar(6.8e-3, angle), 3e-3, "axle")));
    const auto twice = with_holes(*plate, {circle({-3e-3, 0}, 3e-3, "left"), circle({2e-3, 0}, 3e-3, "right")});
    CHECK(told(twice.errors()) == "right: hole `right` breaks through `left`: wall -1 mm at 180 deg\n");
}

TEST_CASE("a loop that crosses itself or is empty is told") {
    const auto bow = filled(polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1.1}}, "bow"));
    CHECK(told(bow.errors()).find("`bow` crosses or touches itself at") != std::string::npos);
    CHECK(told(filled(polygon({{0, 0}, {1, 0}, {2, 0}}, "sliver")).errors()) == "sliver: `sliver` encloses no area\n");
    CHECK(told(Path({0, 0}, "arm").line_to({1, 0}).arc_about({0.5, 0.1}, {2, 0}).closed().errors()).find("about (500 mm, 100 mm) begins") !=
          std::string::npos);
}

namespace {

enum class Kind { arc, cubic, law };

// A quarter of a circle, counter-clockwise from the angle `from`.
Curve quarter(Kind kind, const Vector2& centre, double radius, double from) {
    const auto on_circle = [&](double angle) {
        return Point2{centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle)};
    };
    const Point2 start = on_circle(from), end = on_circle(from + pi / 2);
    if (kind == Kind::arc) return Arc{start, end, constant(centre), radius, true};
    if (kind == Kind::cubic) {
        const double handle = 0.5522847498 * radius;
        const Vector2 d(std::cos(from), std::sin(from)), aside(-d.y(), d.x());
        return Bezier{{start, start + constant(Vector2(handle * aside)), end + constant(Vector2(handle * d)), end}};
    }
    Law law([=](const auto& t) {
        using std::cos, std::sin;
        return std::array{centre.x() + radius * cos(t), centre.y() + radius * sin(t)};
    });
    return law_curve(std::move(law), from, from + pi / 2);
}

}  // namespace

// Such joints are where rounding decides how two curves cross that touch.
TEST_CASE("curves that go on smoothly into each other do not cross, at any scale and angle") {
    std::mt19937 random(3);
    const auto uniform = [&](double low, double high) { return low + (high - low) * static_cast<double>(random()) / 4294967296.0; };
    constexpr std::array<Kind, 3> kinds{Kind::arc, Kind::cubic, Kind::law};
    for (int k = 0; k < 81 * 12; ++k) {
        // An oval of four quarters, two of them smaller.
        const double large = std::pow(10, uniform(-5, 1)), small = large * uniform(0.02, 0.9), angle = uniform(0, 2 * pi);
        Vector2 centre = large * Vector2(uniform(-1, 1), uniform(-1, 1));
        Loop oval;
        for (int i = 0, which = k % 81; i < 4; ++i, which /= 3) {
            const double radius = i % 2 == 0 ? large : small, from = angle + i * pi / 2;
            oval.segments.push_back({quarter(kinds[which % 3], centre, radius, from), "oval", std::nullopt});
            const double onward = i % 2 == 0 ? large - small : small - large;
            centre += onward * Vector2(std::cos(from + pi / 2), std::sin(from + pi / 2));
        }
        for (std::size_t i = 0; i < 4; ++i) {  // neighbours share their ends
            const Point2 end = end_of(oval.segments[i].curve);
            Curve& next = oval.segments[(i + 1) % 4].curve;
            if (auto* cubic = std::get_if<Bezier>(&next)) cubic->points.front() = end;
            if (auto* arc = std::get_if<Arc>(&next)) arc->start = end;
            if (auto* law = std::get_if<LawCurve>(&next)) law->start = end;
        }
        INFO("oval " << k << ", radii " << large << " and " << small << ", at " << angle);
        CHECK(told(filled(oval).errors()) == "");
    }
    // Fillets between an arc and the flanks of a gap.
    for (int k = 0; k < 300; ++k) {
        const double base = std::pow(10, uniform(-3, 0)), root = base * uniform(1.1, 1.2), tip = base * uniform(1.005, 1.05);
        const double turn = uniform(0.12, 0.2), at_root = std::sqrt(root * root / base / base - 1),
                     at_tip = std::sqrt(tip * tip / base / base - 1);
        const LawCurve out = involute(base, -turn, at_tip, at_root), back = involute(base, turn, at_root, at_tip, true);
        const auto gap = Path(out.start, "gap")
                             .along(out)
                             .round(0.02 * base * turn)
                             .arc_about({0, 0}, back.start)
                             .round(0.1 * base * turn)
                             .along(back)
                             .closed();
        REQUIRE(gap);
        INFO("gap " << k << " of base " << base);
        CHECK(told(filled(turned(*gap, uniform(0, 2 * pi))).errors()) == "");
    }
}

TEST_CASE("areas of what lines, arcs and splines enclose") {
    CHECK(area(*filled(circle({1, 2}, 3))).value == Approx(9 * pi).epsilon(1e-14));
    CHECK(area(*filled(slot({0, 0}, {4, 0}, 1))).value == Approx(8 + pi).epsilon(1e-14));
    const auto rounded_square = rounded(rectangle({0, 0}, 4, 3), 0.5);
    CHECK(area(*filled(*rounded_square)).value == Approx(12 - (4 - pi) * 0.25).epsilon(1e-14));
    const auto chamfered_square = chamfered(rectangle({0, 0}, 4, 3), 0.5);
    CHECK(area(*filled(*chamfered_square)).value == Approx(12 - 4 * 0.125).epsilon(1e-14));
    // A law: the limacon r = 2 + cos(phi), area pi (4 + 1/2).
    const auto limacon = Path({3, 0})
                             .along(law_curve(Law([](const auto& t) {
                                                  using std::cos, std::sin;
                                                  const auto r = 2.0 + cos(t);
                                                  return std::array{r * cos(t), r * sin(t)};
                                              }),
                                              0, 2 * pi))
                             .closed();
    CHECK(area(*filled(*limacon)).value == Approx(4.5 * pi).epsilon(1e-10));
    // Involute from its circle: r^2 u^3 / 6 between the radius at the start, the curve and the string... by the sector formula.
    const double u = 0.8;
    const auto flank = involute(1, 0, 0, u);
    CHECK(value(flank.end).norm() == Approx(std::hypot(1, u)));
}

TEST_CASE("all ways to draw an arc agree, and corners take any neighbours") {
    // The same half moon five ways.
    const double r = 2e-3;
    std::vector<Loop> loops;
    loops.push_back(*Path({-r, 0}).line_to({r, 0}).arc_about({0, 0}, {-r, 0}).closed());
    loops.push_back(*Path({-r, 0}).line_to({r, 0}).arc_through({0, r}, {-r, 0}).closed());
    loops.push_back(*Path({-r, 0}).line_to({r, 0}).bulge_to({-r, 0}, 1).closed());
    loops.push_back(*Path({-r, 0}).line_to({r, 0}).arc_by({0, 0}, pi).closed());
    for (const Loop& loop : loops) CHECK(area(*filled(loop)).value == Approx(pi * r * r / 2).epsilon(1e-12));
    const auto tangent = Path({0, 0}).line_to({r, 0}).tangent_arc_to({r, 2 * r}).line_to({0, 2 * r}).closed();
    CHECK(area(*filled(*tangent)).value == Approx(2 * r * r + pi * r * r / 2).epsilon(1e-12));

    const auto part = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto loop = Path({0, 0}, "cam")
                              .round(d[3])
                              .line_to({d[0], 0})
                              .round(d[3])
                              .arc_through({1.2 * d[0], 0.5 * d[1]}, {d[0], d[1]})
                              .chamfer(d[3], 0.7 * d[3])
                              .line_to({0.5 * d[0], 1.1 * d[1]})
                              .round(0.5 * d[3])
                              .spline_through({{0.2 * d[0], 0.8 * d[1]}, {0, d[1]}})
                              .round(0.2 * d[3])
                              .closed();
        if (!loop) return loop.errors();
        const auto profile = filled(*loop);
        if (!profile) return profile.errors();
        return extruded(drawing, *profile, 0, d[2]);
    };
    checked(part, {20e-3, 12e-3, 3e-3, 1e-3});
}

TEST_CASE("profiles moved, turned, mirrored and repeated keep their areas and their derivatives") {
    const auto part = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const Loop rim = circle({}, d[0], "rim"), hole = slot({d[1], 0}, {d[1] + d[2], 0}, d[3], "slot");
        auto profile = with_holes(*filled(rim), polar_copies(turned(mirrored(hole, {}, {1, 0}), d[4]), 5));
        if (!profile) return profile.errors();
        return extruded(drawing, moved(turned(*profile, d[4], {d[0], 0}), {d[2], d[3]}), 0, d[0]);
    };
    const DrawnPart drawn_part = checked(part, {20e-3, 8e-3, 6e-3, 2e-3, 0.3}, {0, 400, Lean::through});
    const double area = pi * 400 - 5 * (6 * 4 + pi * 4);
    CHECK(volume(drawn_part) == Approx(area * 1e-6 * 20e-3).epsilon(2e-4));
}

}  // namespace fettle::core::parts::profile_test
