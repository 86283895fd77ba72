// SPDX-License-Identifier: MIT
#include "design/quantities/stroke.hpp"

#include "tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::stroke_test {

namespace {

using namespace fettle::tests::design_support;

}  // namespace

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
