// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "fettle/design/constraints/clearance_constraint.hpp"

namespace {

using namespace fettle::design;

constraints::ClearanceConstraint at_least(double minimum) {
    constraints::Bounds bounds;
    bounds.lower = minimum;
    bounds.margin = 2e-6;
    bounds.unit = 1e-3;
    return {"fit", bounds, {}};
}

}  // namespace

TEST_CASE("a clearance is judged by its proven lower bound, aimed at with a margin") {
    const auto fit = at_least(3e-4);
    CHECK(fit.target_lower() == Approx(3.02e-4));
    CHECK(std::isinf(fit.target_upper()));
    CHECK(fit.violation({3.5e-4, 3e-4, 3.5e-4, {}}) == 0);
    CHECK(fit.violation({3.5e-4, 2.9e-4, 3.5e-4, {}}) == Approx(0.01));  // the value would do, the proof does not
    CHECK(fit.violation({1e-4, 1e-4, 1e-4, {}}) == Approx(0.2));
}

TEST_CASE("both bounds count, in units") {
    constraints::Bounds bounds;
    bounds.lower = 0.02995;
    bounds.upper = 0.03005;
    bounds.unit = 1e-3;
    const constraints::ClearanceConstraint stroke("stroke", bounds, {});
    CHECK(stroke.violation(objectives::exact(0.03)) == 0);
    CHECK(stroke.violation(objectives::exact(0.0302)) == Approx(0.15));
    CHECK(stroke.violation(objectives::exact(0.0299)) == Approx(0.05));
}

TEST_CASE("windows divide the steps without gap or overlap") {
    for (const int steps : {10, 17, 205}) {
        for (const int windows : {1, 2, 3, 10}) {
            int next = 0;
            for (int w = 0; w < windows; ++w) {
                const auto [first, last] = constraints::window_steps(steps, w, windows);
                CHECK(first == next);
                CHECK(last >= first);
                next = last;
            }
            CHECK(next == steps);
        }
    }
    CHECK(constraints::window_steps(2, 1, 5) == std::pair(0, 1));
    CHECK(constraints::window_steps(2, 4, 5) == std::pair(1, 2));
}
