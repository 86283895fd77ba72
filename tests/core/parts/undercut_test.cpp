// SPDX-License-Identifier: MIT
#include "core/parts/undercut.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/support/text.hpp"

namespace fettle::core::parts::undercut_test {

using tests::support::contains;

namespace {

constexpr double pi = std::numbers::pi;

/// With the half axes a along x and b along y; counter-clockwise.
Profile ellipse(double a, double b) {
    const Law law([=](const auto& t) { return std::array{a * cos(t), b * sin(t)}; });
    Path path({a, 0}, "rim");
    path.along(law_curve(law, 0, pi)).along(law_curve(law, pi, 2 * pi));
    return *filled(*path.closed());
}

}  // namespace

TEST_CASE("undercut: an ellipse bears a roller up to its least radius, b^2 / a") {
    const double a = 20e-3, b = 12e-3, least = b * b / a;
    CHECK(undercuts(ellipse(a, b), -0.999 * least).empty());
    CHECK(undercuts(ellipse(a, b), 100 * least).empty());  // outwards there is no hollow
    const Errors found = undercuts(ellipse(a, b), -1.001 * least);
    REQUIRE(found.size() == 2);  // each half, at an end
    CHECK(found[0].where == "rim");
    CHECK(contains(found[0].message, "`rim` is undercut at"));
    CHECK(contains(found[0].message, "a radius of 7.2 mm, the offset is 7.21 mm"));
}

TEST_CASE("undercut: of arcs and corners, on the side of the offset alone") {
    const Profile square = *filled(rectangle({0, 0}, 10e-3, 10e-3, "square"));
    CHECK(undercuts(square, 1e-3).empty());
    const Errors corners = undercuts(square, -1e-3);
    REQUIRE(corners.size() == 4);
    CHECK(contains(corners[0].message, "there is a corner"));
    const Profile soft = *filled(*rounded(rectangle({0, 0}, 10e-3, 10e-3, "square"), 2e-3));
    CHECK(undercuts(soft, -1.99e-3).empty());
    CHECK(undercuts(soft, -2e-3).empty());  // it shrinks to a corner: the roller still touches all of it
    CHECK(undercuts(soft, -2.01e-3).size() == 4);
    const Profile ring = *with_hole(*filled(circle({}, 10e-3, "rim")), circle({}, 3e-3, "bore"));
    CHECK(undercuts(ring, -9e-3).empty());  // growing, the bore does not bend that way
    const Errors bore = undercuts(ring, 4e-3);
    REQUIRE(bore.size() == 1);
    CHECK(bore[0].where == "bore");
}

TEST_CASE("undercut: a kink within a law is a sharp bend") {
    // r = 1 - |sin t| / 5 has corners outwards at t = 0 and pi, and no sharp bend else.
    const Law law([](const auto& t) {
        using std::abs, std::sin, std::cos;
        const auto r = 1.0 - abs(sin(t)) / 5.0;
        return std::array{r * cos(t), r * sin(t)};
    });
    Path path({0, -0.8}, "rim");
    path.along(law_curve(law, -0.5 * pi, 1.5 * pi));
    const auto loop = path.closed();
    REQUIRE(loop);
    const Errors found = undercuts(Profile{{*loop}}, -1e-3);
    REQUIRE(found.size() == 1);
    INFO(found[0].message);
    CHECK((contains(found[0].message, "at 0 deg") || contains(found[0].message, "at 180 deg") || contains(found[0].message, "at 360 deg")));
    CHECK(undercuts(Profile{{*loop}}, 1e-3).size() == 0);
}

}  // namespace fettle::core::parts::undercut_test
