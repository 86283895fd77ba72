// SPDX-License-Identifier: MIT
#include "design/quantities/marker_path.hpp"

#include "design/quantities/marker.hpp"
#include "tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::marker_path_test {

namespace {

using namespace fettle::tests::design_support;

}  // namespace

TEST_CASE("marker path: value and derivative, timed and with free timing") {
    const Vector3 point(0.4, 0.0, 0.1);
    const std::vector<OwnPoint> targets{Vector3(0.9, 0.1, 0), Vector3(0.2, 0.9, 0.5), Vector3(-1, 0.3, 0.8)};
    check_pose_gradient(MarkerPath(0, point, targets, {0.0, 0.37, 1.4}));
    check_pose_gradient(MarkerPath(0, point, targets, {}), 1e-7);
    check_deviations(MarkerPath(0, point, targets, {0.0, 0.37, 1.4}));
    check_deviations(MarkerPath(0, point, targets, {}));
    // A marker at configurations counts where it is.
    const core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(14);
    const fettle::design::description::Simulated simulated{model, trajectory, 1e-9};
    const Vector3 there = marker_position(simulated, 3, 0, point);
    CHECK(MarkerPath(0, point, {there}, {0.3}).value(simulated).value < 1e-30);
    CHECK(MarkerPath(0, point, {there}, {}).value(simulated).value < 1e-30);
    CHECK(MarkerPath(0, point, {there + Vector3(0, 0, 0.5)}, {0.3}).value(simulated).value == Approx(0.25));
}

}  // namespace fettle::design::quantities::marker_path_test
