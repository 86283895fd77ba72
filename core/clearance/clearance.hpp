// SPDX-License-Identifier: MIT
/// Certified clearance: proven bounds of the least distance of pairs of bodies, over the continuous curved path.
///   lower <= min over the time range of dist(A(t), B(t)) <= upper,   rounding error charged to `lower`.
/// A theorem about the meshes as stored and the path as stored (docs/method/clearance.md), not about samples.
///
///     const std::vector<core::clearance::PairRequest> pairs{{.a = 0, .b = 1, .minimum = 0.3e-3}};  // bodies by number, lengths in m
///     auto options = core::clearance::usual_options(pairs);
///     options.motion = true;  // false: as assembled
///     for (const auto& pair : core::clearance::certify(model, simulation.trajectory, pairs, options))
///         std::printf("%s: from %g to %g m, nearest at %g s\n", core::clearance::to_string(pair.status), pair.lower, pair.upper,
///                     pair.witness.time);
#pragma once

#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

/// Bounds for each pair asked for, in their order. The path of `trajectory` must be of the model's bodies.
std::vector<PairClearance> certify(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options);

/// The same with its certificate, which leaves out what could not be measured.
ProvenClearances certify_with_proof(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options);

struct NearClearances {
    /// Pairs that may collide, each over a part of the path throughout which they may be nearer than the reach: in the order of the
    /// pairs, then of time. A pair can have several parts.
    std::vector<PairClearance> windows;
    bool everything = false;  ///< of every pair that may collide the whole path was searched
};

/// The least distance of all pairs that may collide at once: pairs that are not in `windows` are proven to be at least `reach` apart, by
/// boxes round whole bodies that hold them for a while; those that are get searched as certify() does, up to `reach` (`enough`).
NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, double reach, ClearanceOptions options);

/// Steps [first, last) of a trajectory.
struct StepRange {
    int first = 0, last = 0;
};
/// The same over some of the steps alone; `options.motion` is irrelevant. Contract: 0 <= first < last <= the trajectory's steps.
NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, StepRange steps, double reach,
                            ClearanceOptions options);

/// Steps [first, last) of a trajectory, and into how many equal parts they are divided: at most one part a step.
struct TimeWindows {
    int first = 0, last = 0;
    int count = 1;
};

/// Where two bodies are nearest in each window, of the windows in which they come within `reach` [m] of each other; in order of time. Found
/// to within `tolerance` [m], with no proof. A window whose nearest instant is its edge, while they are nearer in the window beyond, has no
/// minimum of its own and is left out. Contract: 0 <= first < last <= the trajectory's steps.
std::vector<Witness> nearest_by_window(const model::Model& model, const stepper::Trajectory& trajectory, const PairRequest& pair,
                                       const TimeWindows& windows, double reach, double tolerance);

/// The start configuration as a trajectory without steps.
stepper::Trajectory as_assembled(const model::Model& model);

}  // namespace fettle::core::clearance
