// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/stroke.hpp"

#include "fettle/tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::stroke_test {

namespace {

using namespace fettle::tests::design_support;

}  // namespace

TEST_CASE("smooth extreme: parabolas exactly, the ends and flat stretches as they are") {
    std::vector<double> y;
    for (int i = 0; i < 9; ++i) y.push_back(3 - 0.5 * (i - 4.3) * (i - 4.3));
    const Extreme extreme = smooth_maximum(y);
    CHECK(extreme.value == Approx(3).epsilon(1e-14));
    CHECK(extreme.first == 3);
    CHECK(extreme.weights[0] + extreme.weights[1] + extreme.weights[2] == Approx(1));
    CHECK(smooth_maximum({3, 2, 1}).value == 3);
    CHECK(smooth_maximum({1, 2, 3}).value == 3);
    CHECK(smooth_maximum({1, 2, 2, 2, 1}).value == Approx(2.125));  // the first of equals, bent by its left neighbour
    CHECK(smooth_maximum({5, 5, 5}).value == 5);
    CHECK(smooth_maximum({7}).value == 7);
}

TEST_CASE("stroke of a cosine: closer than its configurations, by the stated bound, and nearly smooth in its phase") {
    const double step = 0.0314;
    double largest_jump = 0, last = 0, largest_error = 0;
    for (int k = 0; k <= 400; ++k) {
        std::vector<double> y;
        for (int t = 0; t < 210; ++t) y.push_back(std::cos(step * t + 0.5 + 1e-4 * k));
        const double value = smooth_maximum(y).value;
        largest_error = std::max(largest_error, std::abs(value - 1));
        if (k > 0) largest_jump = std::max(largest_jump, std::abs(value - last));
        last = value;
    }
    CHECK(largest_error < 3 * std::pow(step, 4) / 128 * 1.01);
    CHECK(largest_jump < 1e-8);
}

TEST_CASE("stroke: value and derivative") {
    check_pose_gradient(Stroke(0, Vector3(1, 2, 0).normalized(), std::nullopt));
    check_pose_gradient(Stroke(0, Vector3::UnitX(), 1.3));
    check_deviations(Stroke(0, Vector3::UnitX(), 1.3));
    const core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(14);
    CHECK(Stroke(0, Vector3::UnitX(), std::nullopt).value({model, trajectory, 1e-9}).value == Approx(2).epsilon(1e-3));
    CHECK(Stroke(0, Vector3::UnitZ(), std::nullopt).value({model, trajectory, 1e-9}).value == Approx(1.4));
}

}  // namespace fettle::design::quantities::stroke_test
