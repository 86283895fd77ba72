// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/clearance.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/adjoint/clearance/clearance_adjoint.hpp"
#include "fettle/adjoint/clearance/distinct_witnesses.hpp"
#include "fettle/adjoint/clearance/tied_features.hpp"
#include "fettle/core/clearance/clearance.hpp"

namespace fettle::design::quantities {

using core::clearance::PairClearance;
using core::clearance::Witness;
using description::Branch;
using description::Measurement;
using description::Simulated;

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

constexpr double window_accuracy = 1e-3;  // of the value, to which the nearest instants of the windows are found

// Surfaces apart, solids not.
bool one_lies_inside(const PairClearance& pair) { return pair.solids == core::certificate::Solids::overlap && !pair.intersecting; }

void add_clearance_seeds(const Simulated& s, const PairClearance& pair, double scale, description::Seeds& seeds) {
    const std::string refusal =
        adjoint::clearance::clearance_adjoint(s.model, s.trajectory, pair, scale, seeds.trajectory_bar, seeds.model_bar);
    if (seeds.refusal.empty()) seeds.refusal = refusal;
}

}  // namespace

std::pair<int, int> window_steps(int steps, int window, int windows) {
    const auto edge = [&](int w) { return static_cast<int>(static_cast<long>(w) * steps / windows); };
    return {edge(window), std::max(edge(window + 1), edge(window) + 1)};
}

PairClearance Clearance::certify(const Simulated& s) const {
    core::clearance::ClearanceOptions options;
    options.tolerance = s.clearance_tolerance;
    options.sample_nodes = false;
    options.measure_overlap = false;
    options.motion = range_.motion;
    const std::vector<core::clearance::PairRequest> request{{range_.a, range_.b, minimum_}};
    if (!range_.motion || range_.windows <= 1) return core::clearance::certify_clearance(s.model, s.trajectory, request, options).front();
    const auto [first, last] = window_steps(count_of(s.trajectory.steps), range_.window, range_.windows);
    PairClearance pair = core::clearance::certify_clearance(s.model, part_of(s.trajectory, first, last), request, options).front();
    if (pair.witness.step >= 0) pair.witness.step += first;
    return pair;
}

Measurement Clearance::value(const Simulated& s) const {
    const PairClearance pair = certify(s);
    const std::string names = "`" + s.model.bodies[range_.a].name + "` and `" + s.model.bodies[range_.b].name + "`";
    if (one_lies_inside(pair)) {
        const double inside = -pair.witness.distance;
        return {inside, inside, inside, false, pair, "of " + names + " one lies inside the other's material"};
    }
    Measurement measured{pair.upper, pair.lower, pair.upper, pair.is_bounded, pair, {}, {}};
    if (pair.intersecting) measured.fault = names + " pass through each other";
    if (pair.lower > 0 && !pair.intersecting && !core::certificate::are_apart(pair.solids))
        measured.fault = "of " + names + ": " + core::clearance::why_not_apart(pair.solids);
    return measured;
}

void Clearance::add_seeds(const Simulated& s, const Measurement& measured, double scale, description::Seeds& seeds) const {
    const double sign = one_lies_inside(*measured.clearance) ? -1 : 1;
    add_clearance_seeds(s, *measured.clearance, sign * scale, seeds);
}

// Those at most `room` farther apart than the witness is.
std::vector<Witness> Clearance::other_witnesses(const Simulated& s, const PairClearance& pair, double room) const {
    std::vector<Witness> near = adjoint::clearance::tied_features(s.model, s.trajectory, pair.a, pair.b, pair.witness, room);
    if (range_.motion) {
        const auto [first, last] = window_steps(count_of(s.trajectory.steps), range_.window, range_.windows);
        const std::vector<Witness> later =
            core::clearance::nearest_by_window(s.model, s.trajectory, {pair.a, pair.b}, {first, last, branch_windows},
                                               pair.witness.distance + room, std::min(window_accuracy * pair.upper, room));
        near.insert(near.end(), later.begin(), later.end());
    }
    const auto has_none = [&](const Witness& w) {
        return !adjoint::clearance::no_derivative_at(s.model, s.trajectory, pair.a, pair.b, w).empty();
    };
    near.erase(std::remove_if(near.begin(), near.end(), has_none), near.end());
    return adjoint::clearance::distinct_witnesses(s.model, s.trajectory, {pair.a, pair.b}, pair.witness, near,
                                                  (range_.motion ? most_branches : most_branches_at_rest) - 1);
}

std::vector<Branch> Clearance::branches(const Simulated& s, const Measurement& measured, double limit) const {
    std::vector<Branch> branches{{measured.value, [&](double scale, description::Seeds& seeds) { add_seeds(s, measured, scale, seeds); }}};
    const PairClearance& pair = *measured.clearance;
    if (pair.is_clash() || !(pair.witness.distance > 0) || !(limit >= measured.value)) return branches;
    const double rounding = pair.upper - pair.witness.distance;  // that the certificate adds to the witness's
    for (const Witness& witness : other_witnesses(s, pair, limit - measured.value)) {
        PairClearance other = pair;
        other.witness = witness;
        branches.push_back({std::max(measured.value, witness.distance + rounding),
                            [&s, other](double scale, description::Seeds& seeds) { add_clearance_seeds(s, other, scale, seeds); }});
    }
    return branches;
}

Errors Clearance::check(const core::model::Model& model, int steps) const {
    Errors errors = description::check_body(model, range_.a);
    for (const Error& error : description::check_body(model, range_.b)) errors.push_back(error);
    if (range_.a == range_.b) errors.push_back({ErrorCode::inconsistent, "", "a clearance is between two bodies; both are the same"});
    if (range_.motion && steps < 1) errors.push_back({ErrorCode::out_of_range, "", "a clearance over the motion needs a step"});
    if (range_.windows < 1 || range_.window < 0 || range_.window >= range_.windows)
        errors.push_back({ErrorCode::out_of_range, "", "the windows of a motion are counted from 0, and are at least 1"});
    return errors;
}

}  // namespace fettle::design::quantities
