// SPDX-License-Identifier: MIT
#include "design/problem/vanishing_number.hpp"

#include <array>
#include <catch2/catch.hpp>

namespace fettle::design::problem::vanishing_number_test {

using core::expression::Number;
using core::expression::Tape;
using core::geometry::Range;

TEST_CASE("What vanishes whatever its inputs are is seen, and nothing else") {
    Tape tape;
    const Number length = tape.input(0.06), angle = tape.input(0.7);
    const std::array inputs{Range(0.05, 0.07), Range(0.6, 0.8)};
    const auto none = [&](const Number& x) { return vanishes(x, inputs, 1e-13); };
    CHECK(none(Number(1e-14)));
    CHECK_FALSE(none(Number(1e-12)));
    CHECK(none(length / 2 + length / 2 - length));
    CHECK(none((length - 0.01) * 3 - (3 * length - 0.03)));
    CHECK(none(length * cos(angle) / 2 - 0.5 * (cos(angle + 0.0) * length)));
    CHECK(none(sqrt(length + 1 + angle) - sqrt(1 + angle + length)));
    CHECK_FALSE(none(length / 2 + length / 2 - angle));
    CHECK_FALSE(none(length - 0.06));  // there, but not everywhere
    CHECK_FALSE(none(length * cos(angle) - length * cos(angle + 1e-9)));
    CHECK_FALSE(none(1e-10 * length));
    CHECK(none(1e-13 * length));
    // Undefined for some of them.
    CHECK_FALSE(none(1e-20 / (length - 0.06)));
    CHECK_FALSE(none(length / 0.0));
}

}  // namespace fettle::design::problem::vanishing_number_test
