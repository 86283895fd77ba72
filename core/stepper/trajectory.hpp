// SPDX-License-Identifier: MIT
/// The result of a simulation: configurations and the continuous path between them, which is intersection-free (it was
/// checked by curved CCD segment by segment). Readers and writers: trajectory_io.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/kinematics/path.hpp"
#include "core/stepper/kept_contacts.hpp"

namespace fettle::core::stepper {

/// One time step. Each body has a chart of its own, based at its rotation at the start of the step. The path visits
/// `nodes[0]` (the start: rotation vector 0), `nodes[1]`, ..., `nodes.back()` (the end), straight in the chart in between.
/// Usually there are two nodes; more where the straight path would have crossed something.
/// In time, node k is reached after `fractions[k]` of the step.
struct TrajectoryStep {
    std::vector<std::vector<kinematics::ChartPoint>> nodes;  ///< [node][body]
    std::vector<double> fractions{};                         ///< [node], 0 to 1, never falling; empty: evenly, k/(number of segments)
    /// [round][body]: where each round of friction ended, the last at the step's end; of a quasi-static step the last two. Kept by
    /// simulations for gradients of scenes with friction (the adjoint goes back through the rounds), and in memory only; empty: not kept.
    std::vector<std::vector<kinematics::ChartPoint>> friction_rounds{};
    /// Contacts at these ends, without friction at the step's end alone. Kept likewise; missing where they were too many.
    std::vector<std::shared_ptr<const KeptContacts>> contacts{};
};

struct Trajectory {
    double time_start = 0;
    double timestep = 0;        ///< h [s]; of uneven steps the mean
    std::vector<double> times;  ///< [s], of each of `poses`, where the steps are not even; empty: time_start + t timestep
    std::vector<std::string> body_names;
    std::vector<std::vector<kinematics::Pose>> poses;  ///< [t][body], t = 0 .. steps.size()
    std::vector<TrajectoryStep> steps;                 ///< step t leads from poses[t] to poses[t + 1]
};

/// Segment `k` of step `t` of a body.
inline kinematics::PathSegment path_segment(const Trajectory& trajectory, int t, int k, int body) {
    const auto& nodes = trajectory.steps[t].nodes;
    return kinematics::path_between(trajectory.poses[t][body].rotation, nodes[k][body], nodes[k + 1][body]);
}

inline int segment_count(const Trajectory& trajectory, int t) { return count_of(trajectory.steps[t].nodes) - 1; }

/// Share of step `t` that has passed at s in [0, 1] of its segment `k`.
inline double step_fraction(const Trajectory& trajectory, int t, int k, double s) {
    const auto& fractions = trajectory.steps[t].fractions;
    if (fractions.empty()) return (k + s) / segment_count(trajectory, t);
    return fractions[k] + s * (fractions[k + 1] - fractions[k]);
}

/// Time of poses[t] [s].
inline double time_at(const Trajectory& trajectory, int t) {
    return trajectory.times.empty() ? trajectory.time_start + t * trajectory.timestep : trajectory.times[t];
}

/// Time at s in [0, 1] of segment `k` of step `t`; of the start if t is -1 (no step) [s].
inline double time_at(const Trajectory& trajectory, int t, int k, double s) {
    if (t < 0) return time_at(trajectory, 0);
    const double fraction = step_fraction(trajectory, t, k, s);
    if (trajectory.times.empty()) return trajectory.time_start + trajectory.timestep * (t + fraction);
    return trajectory.times[t] + fraction * (trajectory.times[t + 1] - trajectory.times[t]);
}

/// Pose of a body at s in [0, 1] of segment `k` of step `t`; its pose at the start if t is -1 (no step).
inline kinematics::Pose pose_at(const Trajectory& trajectory, int t, int k, double s, int body) {
    if (t < 0) return trajectory.poses.front()[body];
    return kinematics::pose_at(path_segment(trajectory, t, k, body), s);
}

}  // namespace fettle::core::stepper
