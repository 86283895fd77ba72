// SPDX-License-Identifier: MIT
#include "design/quantities/curve_slope.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::quantities::curve_slope_test {

TEST_CASE("the slope of a table is that of its pieces, whatever its profile") {
    using core::scene::Curve;
    using core::scene::CurveKind;
    const std::vector<Curve> curves{{.kind = CurveKind::linear, .times = {0, 0.5, 2}, .values = {1, -2, 4}},
                                    {.kind = CurveKind::trapezoid, .times = {0, 0.5, 2}, .values = {1, -2, 4}},
                                    {.kind = CurveKind::cubic, .times = {0, 0.5, 2, 2.1}, .values = {1, -2, 4, 3}},
                                    {.kind = CurveKind::control_points, .times = {0, 2}, .values = {1, -2, 4, 3, 0, 7}}};
    for (const Curve& curve : curves) {
        for (double x = 0.013; x < 2; x += 0.037) {
            CAPTURE(static_cast<int>(curve.kind), x);
            constexpr double h = 1e-5;
            const double difference = (curve_value(curve, x + h) - curve_value(curve, x - h)) / (2 * h);
            CHECK(curve_slope(curve, x) == Approx(difference).epsilon(1e-7).margin(1e-7));
        }
        CHECK(curve_slope(curve, -0.1) == 0);
        CHECK(curve_slope(curve, 2.2) == 0);
    }
    CHECK(curve_slope(curves[0], 0.25) == Approx(-6).epsilon(1e-14));
    CHECK(curve_slope(curves[0], 0.5) == Approx(4).epsilon(1e-14));  // of what follows
    CHECK(curve_slope({.kind = CurveKind::linear, .times = {1}, .values = {5}}, 1) == 0);
}

}  // namespace fettle::design::quantities::curve_slope_test
