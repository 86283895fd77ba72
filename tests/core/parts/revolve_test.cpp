// SPDX-License-Identifier: MIT
#include "core/parts/revolve.hpp"

#include <cmath>
#include <numbers>

#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::revolve_test {

using part_check::checked;
using part_check::draw;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

TEST_CASE("sphere, cone and torus come to their volumes, and their meshes to the true surface") {
    const auto ball = [](Drawing& drawing, const std::vector<Number>& d) { return sphere(drawing, d[0], "ball"); };
    const auto cone_part = [](Drawing& drawing, const std::vector<Number>& d) { return cone(drawing, d[0], d[1], d[2], "cone"); };
    const auto pointed = [](Drawing& drawing, const std::vector<Number>& d) { return cone(drawing, d[0], 0, d[1], "cone"); };
    const auto ring = [](Drawing& drawing, const std::vector<Number>& d) { return torus(drawing, d[0], d[1], "ring"); };
    for (const int n : {24, 48}) {
        const double close = 30.0 / (n * n);
        for (const Lean lean : {Lean::cover, Lean::within, Lean::through}) {
            const Facets facets{0, n, lean};
            const double ball_volume = volume(checked(ball, {5e-3}, facets)), exact = 4 * pi / 3 * 125e-9;
            CHECK(ball_volume == Approx(exact).epsilon(close));
            CHECK((lean == Lean::cover ? ball_volume > exact : ball_volume < exact));
            CHECK(volume(checked(cone_part, {5e-3, 3e-3, 7e-3}, facets)) == Approx(pi * 7 / 3 * 49e-9).epsilon(close));
            CHECK(volume(checked(pointed, {5e-3, 7e-3}, facets)) == Approx(pi * 7 / 3 * 25e-9).epsilon(close));
            CHECK(volume(checked(ring, {10e-3, 2e-3}, facets)) == Approx(2 * pi * pi * 40e-9).epsilon(close));
        }
    }
}

TEST_CASE("a part of a turn has plane ends") {
    const auto wedge = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto profile = filled(rectangle({d[0], 0}, d[1], d[2], "jaw"));
        return revolved(drawing, *profile, d[3], d[4]);
    };
    const DrawnPart part = checked(wedge, {2e-3, 3e-3, 4e-3, 0.2, 2.5}, {0, 300, Lean::through});
    CHECK(volume(part) == Approx(0.5 * 2.5 * (25 - 4) * 4e-9).epsilon(1e-4));
    checked(wedge, {2e-3, 3e-3, 4e-3, 0.2, 2.5});
    // On the axis.
    const auto slice = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return revolved(drawing, *filled(rectangle({0, 0}, d[0], d[1], "slice")), 0, d[2]);
    };
    checked(slice, {3e-3, 4e-3, 1.2});
    const auto crossing = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return revolved(drawing, *filled(rectangle({-d[1], 0}, d[0], d[0], "groove")));
    };
    CHECK(told(draw(crossing, {3e-3, 3e-4}).errors()) == "groove: `groove` crosses the axis by 0.3 mm\n");
}

}  // namespace fettle::core::parts::revolve_test
