// SPDX-License-Identifier: MIT
#include "design/tolerances/robust_offset.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::design::tolerances::robust_offset_test {

namespace {

const Vector3 g(2, -1, 0.5), mean(0.1, 0, -0.2), lower(-0.3, -0.1, -0.5), upper(0.5, 0.1, 0.1);

Matrix3 covariance() {
    Matrix3 c;
    c << 0.04, 0.01, 0, 0.01, 0.09, -0.02, 0, -0.02, 0.01;
    return c;
}

}  // namespace

TEST_CASE("a robust offset at k sigma is mean and k standard deviations") {
    const RobustOffset up = offset_at_sigmas(g, mean, covariance(), 3), down = offset_at_sigmas(g, mean, covariance(), -3);
    const double variance = 4 * 0.04 + 0.09 + 0.25 * 0.01 + 2 * (2 * -1 * 0.01 + -1 * 0.5 * -0.02);
    CHECK(up.mean == Approx(0.2 - 0.1));
    CHECK(up.standard_deviation == Approx(std::sqrt(variance)));
    CHECK(up.offset == Approx(0.1 + 3 * std::sqrt(variance)));
    CHECK(down.offset == Approx(0.1 - 3 * std::sqrt(variance)));
}

TEST_CASE("a robust offset's direction is its derivative in the gradient") {
    for (const double sigmas : {3.0, -2.0, 0.0}) {
        const RobustOffset at = offset_at_sigmas(g, mean, covariance(), sigmas);
        for (int j = 0; j < 3; ++j) {
            constexpr double h = 1e-5;
            const double above = offset_at_sigmas(g + h * Vector3::Unit(j), mean, covariance(), sigmas).offset;
            const double below = offset_at_sigmas(g - h * Vector3::Unit(j), mean, covariance(), sigmas).offset;
            CHECK(at.direction[j] == Approx((above - below) / (2 * h)).epsilon(1e-8));
        }
    }
    for (const int side : {1, -1})
        CHECK(worst_offset(g, lower, upper, side).direction.dot(g) == worst_offset(g, lower, upper, side).offset);
}

TEST_CASE("a robust offset in the worst case is the farthest corner's") {
    const Vector3 corner_up(0.5, -0.1, 0.1), corner_down(-0.3, 0.1, -0.5);
    CHECK(worst_offset(g, lower, upper, 1).offset == Approx(g.dot(corner_up)));
    CHECK(worst_offset(g, lower, upper, -1).offset == Approx(g.dot(corner_down)));
    CHECK(worst_offset(g, lower, upper, -1).direction == VectorX(corner_down));
}

TEST_CASE("a robust offset where nothing depends on the deviations") {
    const RobustOffset at = offset_at_sigmas(Vector3::Zero(), mean, covariance(), 3);
    CHECK(at.offset == 0);
    CHECK(at.direction == VectorX(mean));
    CHECK(at.standard_deviation == 0);
    CHECK(worst_offset(Vector3::Zero(), lower, upper, 1).offset == 0);
}

}  // namespace fettle::design::tolerances::robust_offset_test
