// SPDX-License-Identifier: MIT
/// A cube on a known path, and the check of a quantity's derivative in all pose matrices.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "design/description/quantity.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::tests::design_support {

// A cube of side 0.2 about its reference point, which lies at (0.3, 0.1, -0.2) in the file's frame.
inline core::model::Model cube_model() {
    core::model::Model model;
    core::model::Body body;
    body.mesh = support::box_mesh(Vector3::Constant(-0.1), Vector3::Constant(0.1));
    body.reference_point = Vector3(0.3, 0.1, -0.2);
    body.density = 500;
    model.bodies.push_back(body);
    return model;
}

inline core::stepper::Trajectory moving(int steps) {
    core::stepper::Trajectory trajectory;
    trajectory.timestep = 0.1;
    for (int t = 0; t <= steps; ++t) {
        core::kinematics::Pose pose;
        pose.rotation = core::kinematics::rotation(Vector3(0.1, 0.2, 0.3) * t);
        pose.position = Vector3(std::cos(0.5 * t + 0.2), std::sin(0.5 * t), 0.1 * t);
        trajectory.poses.push_back({pose});
    }
    trajectory.steps.resize(steps);
    return trajectory;
}

// The derivative in all entries of all pose matrices, as numbers of their own.
inline void check_pose_gradient(const design::description::Quantity& quantity, double tolerance = 1e-8) {
    const core::model::Model model = cube_model();
    core::stepper::Trajectory trajectory = moving(14);
    const auto count = static_cast<Eigen::Index>(trajectory.poses.size());
    const design::description::Simulated simulated{model, trajectory, 1e-9};
    adjoint::Seeds seeds = adjoint::zero_seeds(model, count_of(trajectory.steps));
    quantity.add_seeds(simulated, quantity.value(simulated), 1.7, seeds);
    VectorX gradient(12 * count);
    for (Eigen::Index t = 0; t < count; ++t) gradient.segment<12>(12 * t) = seeds.trajectory_bar.pose_bar[t][0].reshaped();
    const auto check = support::check_gradient(
        [&](const VectorX& x) {
            core::stepper::Trajectory moved = trajectory;
            for (Eigen::Index t = 0; t < count; ++t) {
                core::kinematics::Pose& pose = moved.poses[t][0];
                pose.rotation += x.segment<9>(12 * t).reshaped(3, 3);
                pose.position += x.segment<3>(12 * t + 9);
            }
            return 1.7 * quantity.value({model, moved, 1e-9}).value;
        },
        VectorX::Zero(12 * count), gradient, {1e-4, 0.25, 4});
    INFO("at " << check.column << ": " << check.analytic << " against " << check.difference);
    CHECK(check.relative_error < tolerance);
}

// The value is the sum of its deviations' squares, and its derivative that of theirs: d value = sum 2 r_i dr_i.
inline void check_deviations(const design::description::Quantity& quantity) {
    const core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(14);
    const design::description::Simulated simulated{model, trajectory, 1e-9};
    const auto measured = quantity.value(simulated);
    const VectorX r = quantity.deviations(simulated);
    REQUIRE(r.size() > 0);
    CHECK(r.squaredNorm() == Approx(measured.value));
    const auto seeded = [&](const auto& add) {
        adjoint::Seeds seeds = adjoint::zero_seeds(model, count_of(trajectory.steps));
        add(seeds);
        return seeds.trajectory_bar.pose_bar;
    };
    const auto whole = seeded([&](adjoint::Seeds& seeds) { quantity.add_seeds(simulated, measured, 1.7, seeds); });
    const auto parts = seeded([&](adjoint::Seeds& seeds) {
        for (Eigen::Index i = 0; i < r.size(); ++i) quantity.add_deviation_seeds(simulated, static_cast<int>(i), 1.7 * 2 * r[i], seeds);
    });
    double largest = 0;
    for (size_t t = 0; t < whole.size(); ++t) {
        CHECK((whole[t][0] - parts[t][0]).cwiseAbs().maxCoeff() < 1e-12);
        largest = std::max(largest, whole[t][0].cwiseAbs().maxCoeff());
    }
    CHECK(largest > 1e-3);
}

}  // namespace fettle::tests::design_support
