// SPDX-License-Identifier: MIT
#include "core/solver/caution.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::solver::caution_test {

using fettle::core::solver::Caution;

TEST_CASE("no caution stays none", "[caution]") {
    CHECK_FALSE(Caution(0).is_on());
    CHECK(Caution(0).shift() == 0);
}

TEST_CASE("caution falls as steps do what they promise, to nothing", "[caution]") {
    Caution caution(1e6);
    CHECK(caution.is_on());
    caution.adapt({1, 1e6, 0, 0.5, true});
    CHECK(caution.shift() == Approx(1e4));
    caution.adapt({1, 1e4, 0, 0.3, true});
    CHECK(caution.shift() == Approx(1e3));
    caution.adapt({1, 1e3, 0, 0.1, true});
    CHECK(caution.shift() == Approx(500));
    caution.adapt({0.5, 500, 0, 0.5, true});  // cut a little: as much as before
    CHECK(caution.shift() == Approx(500));
    caution.adapt({1, 500, 0, 0.9, true});  // far from the least along its way
    CHECK(caution.shift() == Approx(5));
    for (int k = 0; k < 2; ++k) caution.adapt({1, caution.shift(), 0, 0.5, true});
    CHECK(caution.shift() == 0);
}

TEST_CASE("a step that was cut makes it the curvature that would have cut it", "[caution]") {
    Caution caution(1e6);
    caution.adapt({0.01, 1e6, 1e5, 0.5, true});
    CHECK(caution.shift() == Approx(1e7));
    caution.adapt({0.1, 1e7, 1e3, 0.5, true});  // never less than four times as much
    CHECK(caution.shift() == Approx(4e7));
    for (int k = 0; k < 20; ++k) caution.adapt({0.01, caution.shift(), 1e30, 0.5, true});
    CHECK(caution.shift() == Approx(1e10));  // nor without end
}

TEST_CASE("what the factorisation needed counts, and what is driven keeps it at the first value", "[caution]") {
    Caution caution(1e6);
    for (int k = 0; k < 5; ++k) caution.adapt({1, 0, 0, 0.5, true});
    CHECK(caution.shift() == 0);
    caution.adapt({1, 1e8, 0, 0.5, true});
    CHECK(caution.shift() == Approx(1e6));
    caution.adapt({1, 1e6, 0, 0.5, false});
    CHECK(caution.shift() == 1e6);
    caution.adapt({0.01, 1e9, 1e12, 0.5, false});
    CHECK(caution.shift() == 1e6);
}

TEST_CASE("no step at all: larger shifts, six times", "[caution]") {
    Caution caution(1e6);
    for (int k = 0; k < 6; ++k) {
        caution.adapt({0, caution.shift(), 0, 0, true});
        CHECK(caution.may_try_again());
    }
    CHECK(caution.shift() == Approx(4096e6));
    caution.adapt({0, caution.shift(), 0, 0, true});
    CHECK_FALSE(caution.may_try_again());
    caution.adapt({1, caution.shift(), 0, 0.5, true});
    CHECK(caution.may_try_again());
}

}  // namespace fettle::core::solver::caution_test
