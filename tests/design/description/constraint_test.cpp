// SPDX-License-Identifier: MIT
#include "design/description/constraint.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::design::description::constraint_test {

namespace {

Bounds at_least(double minimum) {
    Bounds bounds;
    bounds.lower = minimum;
    bounds.margin = 2e-6;
    bounds.unit = 1e-3;
    return bounds;
}

}  // namespace

TEST_CASE("a clearance is judged by its proven lower bound, aimed at with a margin") {
    const Bounds fit = at_least(3e-4);
    CHECK(target_lower(fit) == Approx(3.02e-4));
    CHECK(std::isinf(target_upper(fit)));
    CHECK(violation(fit, {3.5e-4, 3e-4, 3.5e-4, true, {}, {}}) == 0);
    CHECK(violation(fit, {3.5e-4, 2.9e-4, 3.5e-4, true, {}, {}}) == Approx(0.01));  // the value would do, the proof does not
    CHECK(violation(fit, {1e-4, 1e-4, 1e-4, true, {}, {}}) == Approx(0.2));
}

TEST_CASE("both bounds count, in units") {
    Bounds bounds;
    bounds.lower = 0.02995;
    bounds.upper = 0.03005;
    bounds.unit = 1e-3;
    CHECK(violation(bounds, computed(0.03)) == 0);
    CHECK(violation(bounds, computed(0.0302)) == Approx(0.15));
    CHECK(violation(bounds, computed(0.0299)) == Approx(0.05));
}

TEST_CASE("a fault is a violation, whatever the numbers") {
    CHECK(violation(at_least(3e-4), {1, 1, 1, false, {}, "`ball` lies inside the material of `block`"}) == 1);
    CHECK(violation({}, {-1e-3, -1e-3, -1e-3, false, {}, "so"}) == 1);
    CHECK(violation(at_least(3e-3), {-1e-3, -1e-3, -1e-3, false, {}, "so"}) == Approx(4));
}

TEST_CASE("what is no number meets nothing, and infinity no finite bound") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    CHECK(violation(at_least(3e-4), computed(nan)) == infinity);
    CHECK(violation({}, computed(nan)) == infinity);
    CHECK(violation(at_least(3e-4), {1e-3, nan, 1e-3, true, {}, {}}) == infinity);
    CHECK(violation(at_least(3e-4), {1e-3, 1e-3, nan, true, {}, {}}) == infinity);
    CHECK(violation(at_least(3e-4), computed(-infinity)) == infinity);
    Bounds below;
    below.upper = 1;
    CHECK(violation(below, computed(infinity)) == infinity);
    CHECK(violation(at_least(3e-4), {1e-3, 1e-3, infinity, true, {}, {}}) == 0);  // nothing is wanted on that side
}

}  // namespace fettle::design::description::constraint_test
