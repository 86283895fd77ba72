// SPDX-License-Identifier: MIT
#include "core/stepper/step.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <utility>

#include "core/base/text.hpp"
#include "core/ccd/safe_step.hpp"
#include "core/energy/body_terms.hpp"
#include "core/energy/start_history.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/stepper/prescribed_path.hpp"
#include "core/stepper/step_outputs.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::ChartPoint;
using kinematics::PathSegment;

bool is_quasi_static(const model::Model& model) { return model.integrator == scene::Integrator::quasi_static; }

std::vector<PathSegment> straight_segments(const model::Model& model, const StepState& state, const std::vector<ChartPoint>& start,
                                           const std::vector<ChartPoint>& end) {
    std::vector<PathSegment> segments(model.bodies.size());
    for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = path_between(state.history.poses[i].rotation, start[i], end[i]);
    return segments;
}

std::vector<kinematics::Pose> end_poses(const std::vector<PathSegment>& segments) {
    std::vector<kinematics::Pose> poses;
    poses.reserve(segments.size());
    for (const PathSegment& s : segments) poses.push_back(pose_at(s, 1));
    return poses;
}

bool is_clear(const model::Model& model, const std::vector<PathSegment>& segments, solver::NewtonWorkspace& workspace) {
    {
        const auto span = workspace.clock.charge(solver::SolvePhase::broad_phase);
        cover(model, segments, solver::candidate_allowance(model), workspace.candidates);
    }
    const auto span = workspace.clock.charge(solver::SolvePhase::ccd);
    const bool clear = ccd::is_path_clear(model, workspace.candidates, segments);
    settle(end_poses(segments), workspace.candidates);
    return clear;
}

// Stores the path of one stretch, on from the nodes that are there: straight where that is clear, else through as few of the accepted
// points as are needed. Those are moved there, but for the last, which is copied.
void store_path(const model::Model& model, const StepState& state, std::vector<std::vector<ChartPoint>>& accepted,
                solver::NewtonWorkspace& workspace, TrajectoryStep& out) {
    const std::size_t last = accepted.size() - 1;
    const auto store = [&](std::size_t k) {
        if (k == last)
            out.nodes.push_back(accepted[k]);
        else
            out.nodes.push_back(std::move(accepted[k]));
    };
    if (out.nodes.empty()) store(0);
    if (last == 0) store(0);  // at rest
    for (std::size_t from = 0, to = last; from < last; from = to, to = last) {
        for (; to > from + 1; to = from + 1 + (to - from - 1) / 2)
            if (is_clear(model, straight_segments(model, state, out.nodes.back(), accepted[to]), workspace)) break;
        store(to);
    }
}

// The nodes of a stretch that ends at this fraction of the step, evenly over its time.
void store_fractions(double end, TrajectoryStep& out) {
    if (out.fractions.empty()) out.fractions.push_back(0);
    const double begin = out.fractions.back();
    const std::size_t first = out.fractions.size(), count = out.nodes.size() - first;
    for (std::size_t k = 1; k < count; ++k)
        out.fractions.push_back(begin + (end - begin) * static_cast<double>(k) / static_cast<double>(count));
    out.fractions.push_back(end);
}

// Inertia, torques and motors aim at this share of the step's way; an equilibrium knows no way.
energy::StepProblem towards(const energy::StepProblem& problem, double fraction) {
    energy::StepProblem out = problem;
    set_end_time(out, problem.mechanism.end_time - (1 - fraction) * problem.model->timestep);
    if (is_quasi_static(*problem.model)) return out;
    for (std::size_t i = 0; i < out.pose_hat.size(); ++i) {
        const Matrix34 start = pose_matrix(problem.poses_t0[i]);
        out.pose_hat[i] = start + fraction * (problem.pose_hat[i] - start);
        out.torque[i] = fraction * problem.torque[i];
    }
    return out;
}

struct DrivenStep {
    solver::NewtonResult solved;  ///< of the last stretch; iterations and friction rounds of all
    TrajectoryStep path;
};

// Through the nodes of the prescribed path, the last of which is the step's end.
DrivenStep drive(const model::Model& model, const StepState& state, energy::StepProblem& problem, const std::vector<PrescribedNode>& way,
                 solver::NewtonWorkspace& workspace, const solver::NewtonOptions& options) {
    DrivenStep out;
    for (std::size_t k = 0; k < way.size(); ++k) {
        const bool last = k + 1 == way.size();
        solver::NewtonOptions stretch = options;
        if (k > 0) stretch.start = out.path.nodes.back();
        stretch.to_rounding = options.to_rounding && last;
        stretch.keep_rounds = options.keep_rounds && last;
        const int iterations = out.solved.iterations, rounds = out.solved.friction_rounds;
        if (last) {
            out.solved = solver::minimise(problem, way[k].targets, workspace, stretch);
        } else {
            energy::StepProblem part = towards(problem, way[k].fraction);
            out.solved = solver::minimise(part, way[k].targets, workspace, stretch);
        }
        out.solved.iterations += iterations;
        out.solved.friction_rounds += rounds;
        if (out.solved.status != solver::NewtonStatus::converged) return out;
        store_path(model, state, out.solved.path, workspace, out.path);
        out.path.friction_rounds = std::move(out.solved.round_ends);
        if (way.size() > 1) store_fractions(way[k].fraction, out.path);
    }
    return out;
}

SimulationStatus simulation_status(solver::NewtonStatus status) {
    switch (status) {
        case solver::NewtonStatus::converged:
            return SimulationStatus::ok;
        case solver::NewtonStatus::blocked:
            return SimulationStatus::blocked;
        case solver::NewtonStatus::not_held:
            return SimulationStatus::not_held;
        case solver::NewtonStatus::interrupted:
            return SimulationStatus::interrupted;
        case solver::NewtonStatus::not_converged:
            break;
    }
    return SimulationStatus::not_converged;
}

// Not with weights that are areas: derivatives ask more of those than the contacts.
void keep_contacts(const model::Model& model, solver::NewtonResult& solved, TrajectoryStep& path) {
    if (model.area_weighted) return;
    const auto keep = [&](std::vector<kinematics::Pose> poses, contact::ContactSet contacts) {
        path.contacts.push_back(std::make_shared<const KeptContacts>(kept_contacts(model, std::move(poses), std::move(contacts))));
    };
    for (solver::KnownContacts& round : solved.round_contacts) keep(std::move(round.poses), std::move(round.contacts));
    if (solved.round_contacts.empty()) keep(solved.poses, solved.contacts);
}

// With no gradient to keep smooth, contact may be stiffer: a two-level house of cards needs it, which falls over on soft contacts.
double least_kappa(const model::Model& model) { return model.adaptive_kappa ? 10 * model.kappa : model.kappa; }

// Far inside the activation distance the barrier is as good as a wall, and hard to solve against: the next step has a stiffer one.
double next_kappa(const model::Model& model, double kappa, const contact::ContactSet& contacts) {
    constexpr double close = 1e-2, well_apart = 0.1, rise = 4, fall = 0.5;
    if (!model.adaptive_kappa) return kappa;
    const double gap = contacts.minimum_distance - model.dmin;
    if (gap < close * model.dhat) return std::min(model::largest_kappa_rise * model.kappa, rise * kappa);
    return gap < well_apart * model.dhat ? kappa : std::max(least_kappa(model), fall * kappa);
}

// Velocities have no meaning: each equilibrium is solved to rounding, as for a gradient, so that what one step leaves unbalanced is not the
// next one's load. What leaves the scene, or comes round, without having met an equilibrium will meet none.
void ask_for_equilibrium(const model::Model& model, const PrescribedNode& end, solver::NewtonOptions& options) {
    constexpr double farthest = 10, widest_turn = 1.9 * std::numbers::pi;  // in the scene's size; [rad]
    double driven = 0;
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
        for (int k = 3; k < 6; ++k)
            if (!is_free(model.bodies[i], k)) driven = std::max(driven, std::abs(end.targets[i][k]));
    options.to_rounding = true;
    options.caution = model.diagonal / (model::allowed_proximal_share * model.dhat);
    options.farthest = farthest * model.diagonal;
    options.widest_turn = widest_turn + driven;
}

// Bodies by name that the proximal term holds, and nothing else.
void judge_holding(const energy::StepProblem& problem, const solver::NewtonResult& solved, StepResult& result) {
    const std::vector<double> shares = energy::proximal_shares(problem, solved.path.back(), solved.poses);
    std::ostringstream names;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        result.report.proximal_share = std::max(result.report.proximal_share, shares[i]);
        if (shares[i] <= model::allowed_proximal_share) continue;
        names << (names.tellp() > 0 ? ", '" : "'") << problem.model->bodies[i].name << "' (" << shares[i] << " of its load)";
    }
    if (names.tellp() == 0) return;
    result.status = SimulationStatus::not_held;
    result.message = names.str() + ": not held: the proximal term carries more than 1e-6 of the load, which nothing in the scene does";
}

// Rows that follow from others at the start do so all along, or the step is none.
bool judge_joints(const energy::StepProblem& problem, const solver::NewtonResult& solved, StepResult& result) {
    constexpr double largest_gap = 1e-9;  // of the scene's size
    const model::Model& model = *problem.model;
    const model::Mechanism& mechanism = model.mechanism;
    result.report.joint_gap = solver::largest_gap(problem, solved.poses);
    result.report.path_joint_gap = path_gap_bound(model, problem.poses_t0, result.path);
    if (mechanism.dependent.empty()) return true;
    const VectorX values =
        row_values(mechanism.set, mechanism.dependent, placed(mechanism.set.frames, solved.poses), problem.mechanism.angles);
    for (std::size_t i = 0; i < mechanism.dependent.size(); ++i) {
        const constraint::Row& row = mechanism.dependent[i];
        const double gap = std::abs(values[i] - target_at(row, problem.mechanism.end_time)) * row.length;
        result.report.joint_gap = std::max(result.report.joint_gap, gap);
        if (gap <= largest_gap * model.diagonal) continue;
        std::ostringstream message;
        message << "joint '" << mechanism.joints[row.owner].name << "' is " << base::length_text(gap, model.length_unit)
                << " from being met: where it was left out it followed from the others, here it does not. Does the linkage start at a dead "
                   "centre, as in line? Let it start beside that";
        result.status = SimulationStatus::not_converged;
        result.message = message.str();
        return false;
    }
    return true;
}

}  // namespace

StepState start_state(const model::Model& model) {
    StepState state;
    state.history = energy::start_history(model);
    state.kappa = least_kappa(model);
    return state;
}

StepResult step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace, const SimulationOptions& options) {
    const bool for_gradient = options.for_gradient || model.for_gradient;
    energy::StepProblem problem = energy::step_problem(model, state.history, for_gradient ? model.kappa : state.kappa);
    set_end_time(problem, state.time + model.timestep);
    solver::NewtonOptions newton;
    newton.velocity_tolerance = model.velocity_tolerance;
    newton.accuracy = model.solve_accuracy;
    newton.max_iterations = model.max_newton_iterations;
    newton.to_rounding = newton.keep_rounds = for_gradient;
    newton.should_stop = options.should_stop;
    const std::vector<PrescribedNode> way = prescribed_path(model, state.history.poses, state.time);
    if (is_quasi_static(model)) ask_for_equilibrium(model, way.back(), newton);
    DrivenStep driven = drive(model, state, problem, way, workspace, newton);
    const solver::NewtonResult& solved = driven.solved;

    StepResult result;
    result.status = simulation_status(solved.status);
    result.message = solved.message;
    result.report = {solved.iterations,
                     solved.friction_rounds,
                     solved.contacts.count,
                     solved.contacts.minimum_distance,
                     solved.residual,
                     0,
                     solved.shift,
                     0,
                     0};
    if (result.status == SimulationStatus::ok && is_quasi_static(model)) judge_holding(problem, solved, result);
    const auto failed = [&] {
        result.state = state;
        return std::move(result);
    };
    if (result.status != SimulationStatus::ok) return failed();
    result.path = std::move(driven.path);
    if (!model.mechanism.rows.empty() && !judge_joints(problem, solved, result)) return failed();
    result.state.time = state.time + model.timestep;
    result.state.kappa = for_gradient ? model.kappa : next_kappa(model, problem.kappa, solved.contacts);
    result.state.history = energy::advanced(model, state.history, problem, solved.poses);
    if (options.outputs) result.outputs = step_outputs(model, problem, solved, state, result.state);
    if (for_gradient) keep_contacts(model, driven.solved, result.path);
    workspace.contacts = {std::move(driven.solved.poses), std::move(driven.solved.contacts)};
    return result;
}

}  // namespace fettle::core::stepper
