// SPDX-License-Identifier: MIT
/// What the physics tests of the stepper share: models made in memory, runs that must succeed, and numbers read off a trajectory.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>

#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::tests::physics {

inline constexpr double gravity = 9.81;  // [m/s^2], along -z in `world`

inline core::model::Model world(std::vector<core::model::Body> bodies, double h) {
    core::model::Model model;
    model.bodies = std::move(bodies);
    model.gravity = Vector3(0, 0, -gravity);
    model.timestep = h;
    model.dhat = 1e-3;
    model.velocity_tolerance = 1e-6;
    model.kappa = core::model::choose_kappa(model);
    return model;
}

inline core::model::Model weightless(std::vector<core::model::Body> bodies, double h) {
    core::model::Model model = world(std::move(bodies), h);
    model.gravity.setZero();
    model.kappa = core::model::choose_kappa(model);
    return model;
}

inline void set_friction(core::model::Model& model, double mu, double eps_v, int rounds = -1) {
    model.friction.mu.setConstant(mu);
    model.friction.eps_v = eps_v;
    model.friction.rounds = rounds;
}

using mechanisms::run;

inline Vector3 position(const core::stepper::Simulation& run, int step, int body = 0) { return run.trajectory.poses[step][body].position; }

inline Matrix3 rotation(const core::stepper::Simulation& run, int step, int body = 0) { return run.trajectory.poses[step][body].rotation; }

/// The velocity of the reference point during step `step` (1, 2, ...): implicit Euler's at its end.
inline Vector3 velocity(const core::stepper::Simulation& run, int step, int body = 0) {
    return (position(run, step, body) - position(run, step - 1, body)) / run.trajectory.timestep;
}

/// Inertia tensor about the reference point, body axes [kg m^2].
inline Matrix3 inertia(const core::model::Body& body) {
    const Matrix3 second = body.moments.topLeftCorner<3, 3>();
    return second.trace() * Matrix3::Identity() - second;
}

/// Slope of log(error) over log(h), for errors at h, h/2, h/4, ...: the smallest of the stretches.
inline double observed_order(const std::vector<double>& errors) {
    double order = INFINITY;
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) order = std::min(order, std::log2(errors[i] / errors[i + 1]));
    return order;
}

}  // namespace fettle::tests::physics
