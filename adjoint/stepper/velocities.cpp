// SPDX-License-Identifier: MIT
#include "adjoint/stepper/velocities.hpp"

#include "core/base/contract.hpp"
#include "core/energy/start_history.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::model::Model;
using core::scene::Integrator;

bool has_two_steps(const Model& model, std::size_t t) { return model.integrator == Integrator::bdf2 && t > 0; }

// The gradient in Newmark's velocity at the end of a step.
Matrix34& velocity_bar(const Model& model, std::size_t t, std::size_t body, TrajectoryGradient& seeds) {
    const std::size_t steps = seeds.pose_bar.size() - 1;
    FETTLE_ASSERT(t < steps, "a seed is of one of the trajectory's steps");
    seeds.velocity_bar.resize(steps);
    if (seeds.velocity_bar[t].empty()) seeds.velocity_bar[t].assign(model.bodies.size(), Matrix34::Zero());
    return seeds.velocity_bar[t][body];
}

}  // namespace

std::vector<std::vector<Matrix34>> end_velocities(const Model& model, const core::stepper::Trajectory& trajectory) {
    std::vector<std::vector<Matrix34>> out;
    core::energy::History now = core::energy::start_history(model);
    now.poses = trajectory.poses[0];
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        now = advanced(model, now, integration_step(model, now), trajectory.poses[t + 1]);
        out.push_back(now.velocities);
    }
    return out;
}

void add_velocity_seed(const Model& model, int t, int body, const Matrix34& bar, TrajectoryGradient& seeds) {
    FETTLE_ASSERT(model.integrator != Integrator::quasi_static, "quasi-static steps have no velocities");
    const auto step = static_cast<std::size_t>(t), i = static_cast<std::size_t>(body);
    const bool is_solved_for = core::energy::has_free_dof(model.bodies[i]);
    if (is_solved_for && model.integrator == Integrator::newmark) {
        velocity_bar(model, step, i, seeds) += bar;
    } else if (is_solved_for && has_two_steps(model, step)) {
        const Matrix34 scaled = bar / (2 * model.timestep / 3);
        seeds.pose_bar[step + 1][i] += scaled;
        seeds.pose_bar[step][i] -= 4.0 / 3 * scaled;
        seeds.pose_bar[step - 1][i] += 1.0 / 3 * scaled;
    } else {
        const Matrix34 scaled = bar / model.timestep;
        seeds.pose_bar[step + 1][i] += scaled;
        seeds.pose_bar[step][i] -= scaled;
    }
}

void add_slip_seed(const Model& model, int t, int body, const Matrix34& bar, Seeds& seeds) {
    const auto step = static_cast<std::size_t>(t), i = static_cast<std::size_t>(body);
    std::vector<std::vector<Matrix34>>& pose_bar = seeds.trajectory_bar.pose_bar;
    if (has_two_steps(model, step)) {
        pose_bar[step][i] += 4.0 / 3 * bar;
        pose_bar[step - 1][i] -= 1.0 / 3 * bar;
        return;
    }
    pose_bar[step][i] += bar;
    if (model.integrator != Integrator::newmark) return;
    const Matrix34 of_velocity = 0.5 * model.timestep * bar;
    if (step == 0)
        seeds.model_bar.bodies[i].velocity_start_bar += of_velocity;
    else
        add_velocity_seed(model, t - 1, body, of_velocity, seeds.trajectory_bar);
}

}  // namespace fettle::adjoint::stepper
