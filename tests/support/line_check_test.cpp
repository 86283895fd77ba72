// SPDX-License-Identifier: MIT
/// The judge must pass right derivatives, find wrong ones out, and say where it cannot tell.
#include "tests/support/line_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::tests::support::line_check_test {

namespace {

double grow(double h) { return 3 * std::expm1(h); }

}  // namespace

TEST_CASE("a right derivative along a line has a remainder of slope 2, a wrong one has not", "[support]") {
    const LineCheck right = check_line(grow, 3);
    CHECK(right.tells);
    CHECK(right.largest == Approx(100 * right.smallest));
    CHECK(right.slope == Approx(2).margin(0.02));
    CHECK(right.is_right());
    for (const double error : {1e-6, -1e-6}) {
        const LineCheck wrong = check_line(grow, 3 * (1 + error));
        CHECK(wrong.smallest == right.smallest);  // the choice is the function's
        CHECK(wrong.relative_error == Approx(1e-6).epsilon(1e-3));
        CHECK(std::abs(wrong.slope - 2) > 0.1);
        CHECK_FALSE(wrong.is_right());
    }
}

TEST_CASE("a third-order term that takes over is kept out of the range", "[support]") {
    // The difference has slope 2 below 1e-4 alone, and crosses 0 there.
    const LineCheck check = check_line([](double h) { return h + h * h - 1e4 * h * h * h; }, 1);
    CHECK(check.tells);
    CHECK(check.largest <= 2e-5);
    CHECK(check.is_right());
}

TEST_CASE("no second derivative, a kink, rounding: the remainder's slope tells nothing, differences do", "[support]") {
    const auto cubic = [](double h) { return 2 * h + h * h * h; };
    CHECK_FALSE(check_line(cubic, 2).tells);
    CHECK(check_line(cubic, 2).is_right());
    CHECK_FALSE(check_line(cubic, 2 * (1 + 1e-6)).is_right());
    const auto kinked = [](double h) { return h + std::abs(h); };
    CHECK_FALSE(check_line(kinked, 0.9).tells);
    CHECK_FALSE(check_line(kinked, 2).is_right());
    const auto coarse = [](double h) { return std::round(1e5 * grow(h)) / 1e5; };
    CHECK_FALSE(check_line(coarse, 3).tells);
}

TEST_CASE("what has no values has no right derivative", "[support]") {
    const LineCheck check = check_line([](double) { return std::numeric_limits<double>::quiet_NaN(); }, 1);
    CHECK_FALSE(check.tells);
    CHECK_FALSE(check.is_right());
    // Beyond 1e-3 there are none.
    CHECK(check_line([](double h) { return std::abs(h) > 1e-3 ? std::numeric_limits<double>::quiet_NaN() : grow(h); }, 3).is_right());
    CHECK_FALSE(check_line(grow, std::numeric_limits<double>::quiet_NaN()).is_right());
}

}  // namespace fettle::tests::support::line_check_test
