// SPDX-License-Identifier: MIT
#include "fettle/design/constraints/clearance_constraint.hpp"

#include <algorithm>

#include "fettle/adjoint/clearance/clearance_adjoint.hpp"

namespace fettle::design::constraints {

namespace {

core::stepper::Trajectory part_of(const core::stepper::Trajectory& whole, int first, int last) {
    core::stepper::Trajectory part;
    part.time_start = whole.time_start + first * whole.timestep;
    part.timestep = whole.timestep;
    part.body_names = whole.body_names;
    part.poses.assign(whole.poses.begin() + first, whole.poses.begin() + last + 1);
    part.steps.assign(whole.steps.begin() + first, whole.steps.begin() + last);
    return part;
}

}  // namespace

std::pair<int, int> window_steps(int steps, int window, int windows) {
    const auto edge = [&](int w) { return static_cast<int>(static_cast<long>(w) * steps / windows); };
    return {edge(window), std::max(edge(window + 1), edge(window) + 1)};
}

objectives::Quantity ClearanceConstraint::value(const objectives::Simulated& s) const {
    core::clearance::ClearanceOptions options;
    options.tolerance = s.clearance_tolerance;
    options.sample_nodes = false;
    options.motion = requirement_.motion;
    const std::vector<core::clearance::PairRequest> request{{requirement_.a, requirement_.b, bounds().lower}};
    core::clearance::PairClearance pair;
    if (requirement_.motion && requirement_.windows > 1) {
        const auto [first, last] = window_steps(static_cast<int>(s.trajectory.steps.size()), requirement_.window, requirement_.windows);
        pair = core::clearance::certify_clearance(s.model, part_of(s.trajectory, first, last), request, options).front();
        if (pair.witness.step >= 0) pair.witness.step += first;
    } else {
        pair = core::clearance::certify_clearance(s.model, s.trajectory, request, options).front();
    }
    return {pair.upper, pair.lower, pair.upper, pair};
}

void ClearanceConstraint::add_seeds(const objectives::Simulated& s, const objectives::Quantity& quantity, double scale,
                                    objectives::Seeds& seeds) const {
    adjoint::clearance::clearance_adjoint(s.model, s.trajectory, *quantity.clearance, scale, seeds.trajectory_bar, seeds.model_bar);
}

}  // namespace fettle::design::constraints
