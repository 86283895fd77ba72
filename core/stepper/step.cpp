// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step.hpp"

#include "fettle/core/contact/safe_step.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::ChartPoint;
using kinematics::PathSegment;

std::vector<PathSegment> straight_segments(const model::Model& model, const StepState& state, const std::vector<ChartPoint>& start,
                                           const std::vector<ChartPoint>& end) {
    std::vector<PathSegment> segments(model.bodies.size());
    for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = path_between(state.poses[i].rotation, start[i], end[i]);
    return segments;
}

// The stored path: straight where that is clear, else through as few of the accepted points as are needed.
TrajectoryStep stored_path(const model::Model& model, const StepState& state, const std::vector<std::vector<ChartPoint>>& accepted) {
    TrajectoryStep out{{accepted.front()}};
    std::size_t from = 0;
    while (from + 1 < accepted.size()) {
        std::size_t to = accepted.size() - 1;
        for (; to > from + 1; to = from + 1 + (to - from - 1) / 2) {
            const std::vector<PathSegment> segments = straight_segments(model, state, accepted[from], accepted[to]);
            if (contact::is_path_clear(model, segments)) break;
        }
        out.nodes.push_back(accepted[to]);
        from = to;
    }
    return out;
}

SimulationStatus simulation_status(solver::NewtonStatus status) {
    switch (status) {
        case solver::NewtonStatus::converged:
            return SimulationStatus::ok;
        case solver::NewtonStatus::blocked:
            return SimulationStatus::blocked;
        case solver::NewtonStatus::interrupted:
            return SimulationStatus::interrupted;
        case solver::NewtonStatus::not_converged:
            break;
    }
    return SimulationStatus::not_converged;
}

}  // namespace

StepState start_state(const model::Model& model) {
    StepState state;
    for (const model::Body& body : model.bodies) {
        state.poses.push_back(body.pose_start);
        state.velocities.push_back(body.velocity_start);
    }
    return state;
}

std::vector<Vector6> prescribed_targets(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time) {
    std::vector<Vector6> targets(model.bodies.size(), Vector6::Zero());
    for (std::size_t i = 0; i < targets.size(); ++i)
        for (int k = 0; k < 6; ++k) {
            const auto& curve = model.bodies[i].prescribed[k];
            if (!curve) continue;
            const double increment = scene::motion_value(*curve, time + model.timestep) - scene::motion_value(*curve, time);
            targets[i][k] = k < 3 ? poses[i].position[k] + increment : increment;
        }
    return targets;
}

StepResult step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace, const SimulationOptions& options) {
    const energy::StepProblem problem = energy::implicit_euler_problem(model, state.poses, state.velocities);
    const std::vector<Vector6> targets = prescribed_targets(model, state.poses, state.time);
    solver::NewtonOptions newton;
    newton.velocity_tolerance = model.velocity_tolerance;
    newton.max_iterations = model.max_newton_iterations;
    newton.to_rounding = options.for_gradient;
    newton.should_stop = options.should_stop;
    const solver::NewtonResult solved = solver::minimise(problem, targets, workspace, newton);

    StepResult result;
    result.status = simulation_status(solved.status);
    result.message = solved.message;
    result.report = {solved.iterations, solved.contacts, solved.minimum_distance, solved.residual};
    result.state = state;
    if (result.status != SimulationStatus::ok) return result;
    result.path = stored_path(model, state, solved.path);
    result.state.time = state.time + model.timestep;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        result.state.poses[i] = {kinematics::orthonormalised(solved.poses[i].rotation), solved.poses[i].position};
        result.state.velocities[i] = (pose_matrix(result.state.poses[i]) - pose_matrix(state.poses[i])) / model.timestep;
    }
    return result;
}

}  // namespace fettle::core::stepper
