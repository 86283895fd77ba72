// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step_count.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "fettle/core/stepper/simulate.hpp"

namespace fettle::core::stepper::step_count_test {

TEST_CASE("A duration takes the steps that cover it", "[stepper]") {
    CHECK(step_count(1, 0.3) == 4);
    CHECK(step_count(1, 0.25) == 4);
    CHECK(step_count(0, 0.25) == 0);
    CHECK(step_count(1e-12, 0.25) == 1);
    for (int n = 1; n < 3000; ++n) {
        for (const double h : {0.001, 0.01, 1.0 / 60, 0.3, 1e-7}) REQUIRE(step_count(n * h, h) == n);
    }
    CHECK(step_count(1.025, 99999999999) == 1);
    CHECK(step_count(1e300, 1e-3) == std::numeric_limits<int>::max());
}

TEST_CASE("A model's steps are those of its end time, unless they are asked for", "[stepper]") {
    model::Model model;
    model.timestep = 0.3;
    SimulationOptions options;
    CHECK(step_count(model, options) == default_step_count);
    model.end_time = 1;
    CHECK(step_count(model, options) == 4);
    options.steps = 7;
    CHECK(step_count(model, options) == 7);
}

}  // namespace fettle::core::stepper::step_count_test
