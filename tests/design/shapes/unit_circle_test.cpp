// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/unit_circle.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::design::shapes::unit_circle_test {

namespace {

double distance_to_segment(const Vector2& p, const Vector2& a, const Vector2& b) {
    const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - s * (b - a)).norm();
}

std::vector<Vector2> polygon(int segments, double radius, double phase) {
    std::vector<Vector2> points;
    for (int i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments + phase;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
}

// Least distance of two nested polygons: attained at a vertex of one of them.
double polygon_distance(const std::vector<Vector2>& a, const std::vector<Vector2>& b) {
    double least = 1e9;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            least = std::min(least, distance_to_segment(a[i], b[j], b[(j + 1) % b.size()]));
            least = std::min(least, distance_to_segment(b[j], a[i], a[(i + 1) % a.size()]));
        }
    }
    return least;
}

TEST_CASE("unit circle: points, exact symmetry") {
    for (int n : {4, 8, 12, 24, 32, 36}) {
        const auto circle = unit_circle(n);
        REQUIRE(circle.size() == static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i) {
            const auto at = [&](int k) { return circle[((k % n) + n) % n]; };
            const long double angle = 2 * std::numbers::pi_v<long double> * i / n;  // the reference's angle must not be rounded to double
            CHECK(std::abs(static_cast<double>(at(i)[0] - std::cos(angle))) < 2.3e-16);
            CHECK(std::abs(static_cast<double>(at(i)[1] - std::sin(angle))) < 2.3e-16);
            CHECK(at(-i)[0] == at(i)[0]);
            CHECK(at(-i)[1] == -at(i)[1]);
            CHECK(at(n / 4 - i)[0] == at(i)[1]);
            CHECK(at(i + n / 2)[0] == -at(i)[0]);
        }
        CHECK(circle[n / 4][0] == 0.0);
    }
    CHECK_THROWS_AS(unit_circle(6), core::base::ContractError);
    CHECK_THROWS_AS(unit_circle(0), core::base::ContractError);
}

TEST_CASE("unit circle: an inscribed pin in a circumscribed bore keeps the nominal clearance at every angle") {
    const double pin = 4.05, bore = 4.4;
    for (int n : {8, 24, 32}) {
        double least = 1e9;
        for (int k = 0; k <= 20; ++k) {
            const double phase = k * std::numbers::pi / (10 * n);
            const double d = polygon_distance(polygon(n, pin, phase), polygon(n, bore / flat_ratio(n), 0));
            CHECK(d >= bore - pin - 1e-13);
            least = std::min(least, d);
        }
        CHECK(least == Approx(bore - pin).epsilon(1e-12));  // vertex against the middle of a flat
        CHECK(polygon_distance(polygon(n, pin, 0), polygon(n, bore / flat_ratio(n), 0)) ==
              Approx(bore - pin * flat_ratio(n)).epsilon(1e-12));
    }
}

}  // namespace

}  // namespace fettle::design::shapes::unit_circle_test
