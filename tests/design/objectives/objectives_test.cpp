// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>

#include "fettle/design/objectives/marker_path.hpp"
#include "fettle/design/objectives/mass.hpp"
#include "fettle/design/objectives/stroke.hpp"
#include "fettle/tests/support/box_mesh.hpp"
#include "fettle/tests/support/derivative_check.hpp"

namespace {

using namespace fettle;
using namespace fettle::design::objectives;

// A cube of side 0.2 about its reference point, which lies at (0.3, 0.1, -0.2) in the file's frame.
core::model::Model cube_model() {
    core::model::Model model;
    core::model::Body body;
    body.mesh = tests::support::box_mesh(Vector3::Constant(-0.1), Vector3::Constant(0.1));
    body.reference_point = Vector3(0.3, 0.1, -0.2);
    body.density = 500;
    model.bodies.push_back(body);
    return model;
}

core::stepper::Trajectory moving(int steps) {
    core::stepper::Trajectory trajectory;
    trajectory.timestep = 0.1;
    for (int t = 0; t <= steps; ++t) {
        core::kinematics::Pose pose;
        pose.rotation = core::kinematics::rotation(Vector3(0.1, 0.2, 0.3) * t);
        pose.position = Vector3(std::cos(0.5 * t + 0.2), std::sin(0.5 * t), 0.1 * t);
        trajectory.poses.push_back({pose});
    }
    trajectory.steps.resize(static_cast<size_t>(steps));
    return trajectory;
}

// The derivative in all entries of all pose matrices, as numbers of their own.
void check_pose_gradient(const Objective& objective, double tolerance = 1e-8) {
    const core::model::Model model = cube_model();
    core::stepper::Trajectory trajectory = moving(14);
    const auto count = static_cast<Eigen::Index>(trajectory.poses.size());
    const Simulated simulated{model, trajectory, 1e-9};
    Seeds seeds = zero_seeds(simulated);
    objective.add_seeds(simulated, objective.value(simulated), 1.7, seeds);
    VectorX gradient(12 * count);
    for (Eigen::Index t = 0; t < count; ++t)
        gradient.segment<12>(12 * t) = seeds.trajectory_bar.pose_bar[static_cast<size_t>(t)][0].reshaped();
    const auto check = tests::support::check_gradient(
        [&](const VectorX& x) {
            core::stepper::Trajectory moved = trajectory;
            for (Eigen::Index t = 0; t < count; ++t) {
                core::kinematics::Pose& pose = moved.poses[static_cast<size_t>(t)][0];
                pose.rotation += x.segment<9>(12 * t).reshaped(3, 3);
                pose.position += x.segment<3>(12 * t + 9);
            }
            return 1.7 * objective.value({model, moved, 1e-9}).value;
        },
        VectorX::Zero(12 * count), gradient, {1e-4, 0.25, 4});
    INFO("at " << check.column << ": " << check.analytic << " against " << check.difference);
    CHECK(check.relative_error < tolerance);
}

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
    const core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(14);
    CHECK(Stroke(0, Vector3::UnitX(), std::nullopt).value({model, trajectory, 1e-9}).value == Approx(2).epsilon(1e-3));
    CHECK(Stroke(0, Vector3::UnitZ(), std::nullopt).value({model, trajectory, 1e-9}).value == Approx(1.4));
}

TEST_CASE("marker path: value and derivative, timed and with free timing") {
    const Vector3 point(0.4, 0.0, 0.1);
    const std::vector<Vector3> targets{{0.9, 0.1, 0}, {0.2, 0.9, 0.5}, {-1, 0.3, 0.8}};
    check_pose_gradient(MarkerPath(0, point, targets, {0.0, 0.37, 1.4}));
    check_pose_gradient(MarkerPath(0, point, targets, {}), 1e-7);
    // A marker at configurations counts where it is.
    const core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(14);
    const Simulated simulated{model, trajectory, 1e-9};
    const Vector3 there = marker_position(simulated, 3, 0, point);
    CHECK(MarkerPath(0, point, {there}, {0.3}).value(simulated).value < 1e-30);
    CHECK(MarkerPath(0, point, {there}, {}).value(simulated).value < 1e-30);
    CHECK(MarkerPath(0, point, {there + Vector3(0, 0, 0.5)}, {0.3}).value(simulated).value == Approx(0.25));
}

TEST_CASE("mass: value and derivative in vertices and density") {
    core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(1);
    const Mass mass({0});
    CHECK(mass.value({model, trajectory, 1e-9}).value == Approx(500 * 0.008));
    Seeds seeds = zero_seeds({model, trajectory, 1e-9});
    mass.add_seeds({model, trajectory, 1e-9}, {}, 2, seeds);
    VectorX gradient(25);
    gradient << seeds.model_bar.bodies[0].vertices_bar.reshaped(), seeds.model_bar.bodies[0].density_bar * 1000;
    const auto check = tests::support::check_gradient(
        [&](const VectorX& x) {
            core::model::Model moved = model;
            moved.bodies[0].mesh.vertices += x.head<24>().reshaped(3, 8);
            moved.bodies[0].density += 1000 * x[24];
            return 2 * mass.value({moved, trajectory, 1e-9}).value;
        },
        VectorX::Zero(25), gradient, {1e-3, 0.25, 5});
    CHECK(check.relative_error < 1e-9);
}
