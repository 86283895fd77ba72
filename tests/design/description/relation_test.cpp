// SPDX-License-Identifier: MIT
#include "design/description/relation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::design::description::relation_test {

using fettle::design::description::Relation;
using fettle::design::description::violation;

TEST_CASE("a relation is met within its bounds, strictly; its violation counts in units") {
    Relation relation;
    relation.bounds.lower = 0.02;
    relation.bounds.upper = 0.03;
    relation.bounds.unit = 1e-3;
    CHECK(violation(relation, 0.02) == 0);
    CHECK(violation(relation, 0.03) == 0);
    CHECK(violation(relation, std::nextafter(0.03, 1)) > 0);
    CHECK(violation(relation, 0.0315) == Approx(1.5));
    CHECK(violation(relation, 0.0195) == Approx(0.5));
}

TEST_CASE("an equation is met within its tolerance; what is no number is never met") {
    Relation relation;
    relation.bounds.lower = relation.bounds.upper = 0.03;
    relation.tolerance = 1e-8;
    CHECK(violation(relation, 0.03 + 0.9e-8) == 0);
    CHECK(violation(relation, 0.03 - 0.9e-8) == 0);
    CHECK(violation(relation, 0.03 - 2e-8) == Approx(2e-8));
    CHECK(violation(relation, std::numeric_limits<double>::quiet_NaN()) > 0);
    CHECK(violation(Relation{}, std::numeric_limits<double>::quiet_NaN()) > 0);
    CHECK(violation(Relation{}, 7) == 0);
}

}  // namespace fettle::design::description::relation_test
