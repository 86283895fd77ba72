// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step.hpp"

#include <algorithm>

#include "fettle/core/contact/safe_step.hpp"
#include "fettle/core/stepper/step_outputs.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::ChartPoint;
using kinematics::PathSegment;

std::vector<PathSegment> straight_segments(const model::Model& model, const StepState& state, const std::vector<ChartPoint>& start,
                                           const std::vector<ChartPoint>& end) {
    std::vector<PathSegment> segments(model.bodies.size());
    for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = path_between(state.history.poses[i].rotation, start[i], end[i]);
    return segments;
}

std::vector<kinematics::Pose> end_poses(const std::vector<PathSegment>& segments) {
    std::vector<kinematics::Pose> poses;
    for (const PathSegment& s : segments) poses.push_back(pose_at(s, 1));
    return poses;
}

// The stored path: straight where that is clear, else through as few of the accepted points as are needed.
TrajectoryStep stored_path(const model::Model& model, const StepState& state, const std::vector<std::vector<ChartPoint>>& accepted,
                           solver::NewtonWorkspace& workspace) {
    const auto is_clear = [&](const std::vector<PathSegment>& segments) {
        {
            const auto span = workspace.clock.charge(solver::SolvePhase::broad_phase);
            cover(model, segments, solver::candidate_allowance(model), workspace.candidates);
        }
        const auto span = workspace.clock.charge(solver::SolvePhase::ccd);
        const bool clear = contact::is_path_clear(model, workspace.candidates, segments);
        settle(end_poses(segments), workspace.candidates);
        return clear;
    };
    TrajectoryStep out{{accepted.front()}};
    std::size_t from = 0;
    while (from + 1 < accepted.size()) {
        std::size_t to = accepted.size() - 1;
        for (; to > from + 1; to = from + 1 + (to - from - 1) / 2) {
            const std::vector<PathSegment> segments = straight_segments(model, state, accepted[from], accepted[to]);
            if (is_clear(segments)) break;
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

Vector6 curve_increments(const scene::PrescribedMotion& prescribed, double from, double to) {
    Vector6 out = Vector6::Zero();
    for (int k = 0; k < 6; ++k)
        if (prescribed[k]) out[k] = scene::motion_value(*prescribed[k], to) - scene::motion_value(*prescribed[k], from);
    return out;
}

// A script stops with its curves; what is left of the step after its last pose goes on with them.
Vector6 scripted_target(const model::Body& body, const kinematics::Pose& pose, double from, double to) {
    const auto& stop = body.prescribed[0] ? body.prescribed[0]->stop_time : std::nullopt;
    const double stopped = stop ? std::min(to, std::max(from, *stop)) : to, end = std::min(stopped, body.script.times.back());
    const kinematics::Pose target = model::scripted_pose(body, end);
    const Vector6 rest = curve_increments(body.prescribed, end, to);
    Vector6 out;
    out << target.position + rest.head<3>(),
        kinematics::rotation_vector(kinematics::rotation(rest.tail<3>()) * target.rotation * pose.rotation.transpose());
    return out;
}

// With no gradient to keep smooth, contact may be stiffer: a two-level house of cards needs it, which falls over on soft contacts.
double least_kappa(const model::Model& model) { return model.adaptive_kappa ? 10 * model.kappa : model.kappa; }

// Far inside the activation distance the barrier is as good as a wall, and hard to solve against: the next step has a stiffer one.
double next_kappa(const model::Model& model, double kappa, const contact::ContactSet& contacts) {
    constexpr double close = 1e-2, well_apart = 0.1, rise = 4, fall = 0.5, largest = 1e4;
    if (!model.adaptive_kappa) return kappa;
    const double gap = contacts.minimum_distance - model.dmin;
    if (gap < close * model.dhat) return std::min(largest * model.kappa, rise * kappa);
    return gap < well_apart * model.dhat ? kappa : std::max(least_kappa(model), fall * kappa);
}

}  // namespace

StepState start_state(const model::Model& model) {
    StepState state;
    state.history = energy::start_history(model);
    state.kappa = least_kappa(model);
    return state;
}

std::vector<Vector6> prescribed_targets(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time) {
    std::vector<Vector6> targets(model.bodies.size(), Vector6::Zero());
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const model::Body& body = model.bodies[i];
        const bool scripted = !body.script.empty() && time < body.script.times.back();
        targets[i] = scripted ? scripted_target(body, poses[i], time, time + model.timestep)
                              : curve_increments(body.prescribed, time, time + model.timestep);
        if (!scripted) targets[i].head<3>() += poses[i].position;
    }
    return targets;
}

StepResult step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace, const SimulationOptions& options) {
    const energy::StepProblem problem = energy::step_problem(model, state.history, options.for_gradient ? model.kappa : state.kappa);
    const std::vector<Vector6> targets = prescribed_targets(model, state.history.poses, state.time);
    solver::NewtonOptions newton;
    newton.velocity_tolerance = model.velocity_tolerance;
    newton.max_iterations = model.max_newton_iterations;
    newton.to_rounding = options.for_gradient;
    newton.should_stop = options.should_stop;
    const solver::NewtonResult solved = solver::minimise(problem, targets, workspace, newton);

    StepResult result;
    result.status = simulation_status(solved.status);
    result.message = solved.message;
    result.report = {solved.iterations, solved.friction_rounds, solved.contacts.count, solved.contacts.minimum_distance, solved.residual,
                     solved.shift};
    result.state = state;
    if (result.status != SimulationStatus::ok) return result;
    result.path = stored_path(model, state, solved.path, workspace);
    result.state.time = state.time + model.timestep;
    result.state.kappa = options.for_gradient ? model.kappa : next_kappa(model, problem.kappa, solved.contacts);
    std::vector<kinematics::Pose> end = solved.poses;
    for (kinematics::Pose& pose : end) pose.rotation = kinematics::orthonormalised(pose.rotation);
    result.state.history = energy::advanced(model, state.history, problem, std::move(end));
    if (options.outputs) result.outputs = step_outputs(model, problem, solved, result.state);
    return result;
}

}  // namespace fettle::core::stepper
