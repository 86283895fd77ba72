// SPDX-License-Identifier: MIT
#include "core/scene/step_count.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "core/stepper/simulate.hpp"

namespace fettle::core::scene::step_count_test {

TEST_CASE("A duration takes the steps that cover it", "[scene]") {
    CHECK(*step_count(1, 0.3) == 4);
    CHECK(*step_count(1, 0.25) == 4);
    CHECK(*step_count(0, 0.25) == 0);
    CHECK(*step_count(1e-12, 0.25) == 1);
    for (int n = 1; n < 3000; ++n) {
        for (const double h : {0.001, 0.01, 1.0 / 60, 0.3, 1e-7}) REQUIRE(*step_count(n * h, h) == n);
    }
    CHECK(*step_count(1.025, 99999999999) == 1);
    CHECK(*step_count(2147483646, 1) == 2147483646);
    for (const double duration : {2147483647.0, 1e300}) {
        const auto count = step_count(duration, 1);
        REQUIRE_FALSE(count);
        CHECK(count.errors().front().message.find("more than 2147483647 steps") != std::string::npos);
    }
}

TEST_CASE("A model's steps are those of its end time, unless they are asked for", "[scene]") {
    model::Model model;
    model.timestep = 0.3;
    stepper::SimulationOptions options;
    CHECK(stepper::step_count(model, options) == default_step_count);
    model.end_time = 1;
    CHECK(stepper::step_count(model, options) == 4);
    options.steps = 7;
    CHECK(stepper::step_count(model, options) == 7);
}

}  // namespace fettle::core::scene::step_count_test
