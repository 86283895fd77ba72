// SPDX-License-Identifier: MIT
#include "adjoint/clearance/local_witnesses.hpp"

#include <algorithm>
#include <cmath>

#include "adjoint/clearance/distinct_witnesses.hpp"
#include "adjoint/clearance/path_nodes.hpp"
#include "adjoint/clearance/range_adjoint.hpp"
#include "adjoint/clearance/tied_features.hpp"
#include "core/clearance/range_clearance.hpp"

namespace fettle::adjoint::clearance {
namespace {

using core::clearance::JointRanges;
using core::clearance::PairClearance;
using core::clearance::Witness;
using core::model::Model;
using core::stepper::Trajectory;

constexpr double share_of_distance = 1e-3;  // to which nearest places are found
constexpr int most_settled = 24;
constexpr int most_changes = 6;  // of the nearest features, on the way to a minimum

double accuracy(const PairClearance& pair, const LocalWitnessLimits& limits) {
    return std::min(share_of_distance * pair.upper, limits.room);
}

double farthest(const PairClearance& pair, const LocalWitnessLimits& limits) { return pair.witness.distance + limits.room; }

PairClearance with_witness(PairClearance pair, const Witness& witness) {
    pair.upper += witness.distance - pair.witness.distance;
    pair.witness = witness;
    pair.witnesses = {witness};
    return pair;
}

// What is within the room of the pair's own witness, at another place.
std::vector<Witness> features_at(const Model& model, const Trajectory& trajectory, const PairClearance& pair, const Witness& at,
                                 const LocalWitnessLimits& limits) {
    return tied_features(model, trajectory, pair.a, pair.b, at, farthest(pair, limits) - at.distance);
}

bool is_same_place(const JointRanges& ranges, const PairClearance& one, const PairClearance& other) {
    constexpr double same = 1e-7;  // of a range
    for (std::size_t k = 0; k < one.at.size(); ++k) {
        const core::certificate::LinkageCoordinate& c = ranges.linkage.coordinates[one.coordinates[k]];
        if (!(std::abs(one.at[k] - other.at[k]) <= same * (c.high - c.low))) return false;
    }
    return true;
}

// Downhill from a place by the positions of the joints, on to neighbouring features where these are nearer.
PairClearance local_minimum(const Model& model, const JointRanges& ranges, PairClearance pair) {
    for (int k = 0;; ++k) {
        pair = settled_witness(model, ranges, pair);
        if (k == most_changes) return pair;
        const Trajectory posed = at_witness(model, ranges, pair);
        Witness nearest = pair.witness;
        for (const Witness& w : tied_features(model, posed, pair.a, pair.b, pair.witness, 0))
            if (w.distance < nearest.distance && are_alike(model, posed, {pair.a, pair.b}, w, pair.witness)) nearest = w;
        constexpr double rounding = 1e-9;
        if (!(nearest.distance < (1 - rounding) * pair.witness.distance)) return pair;
        pair = with_witness(pair, nearest);
    }
}

// Positions of the joints as a motion that stands still at each for a step, so that they are places as instants are.
class StandingMotion {
public:
    StandingMotion(const Model& model, const JointRanges& ranges) : model_(model), ranges_(ranges) {}

    // @return the pair's witness as one of the motion. Contract: all that are added are of the same two bodies.
    Witness add(const PairClearance& pair) {
        const auto seen = std::find_if(places_.begin(), places_.end(), [&](const auto& p) { return is_same_place(ranges_, p, pair); });
        Witness witness = pair.witness;
        witness.step = static_cast<int>(seen - places_.begin());
        if (seen == places_.end()) append(pair);
        return witness;
    }

    const Trajectory& trajectory() const { return trajectory_; }

    PairClearance at(Witness witness) const {
        const PairClearance& place = places_[witness.step];
        witness.step = -1;
        return with_witness(place, witness);
    }

private:
    void append(const PairClearance& pair) {
        places_.push_back(pair);
        const std::vector<core::kinematics::Pose> poses = at_witness(model_, ranges_, pair).poses.front();
        std::vector<core::kinematics::ChartPoint> node(poses.size());
        for (std::size_t body = 0; body < poses.size(); ++body) node[body].position = poses[body].position;
        if (trajectory_.poses.empty()) trajectory_.poses.push_back(poses);
        trajectory_.poses.back() = poses;
        trajectory_.poses.push_back(poses);
        trajectory_.steps.push_back({{node, node}, {}, {}});
    }

    const Model& model_;
    const JointRanges& ranges_;
    std::vector<PairClearance> places_;
    Trajectory trajectory_;
};

}  // namespace

std::vector<PairClearance> local_witnesses(const Model& model, const Trajectory& trajectory,
                                           const std::optional<core::clearance::StepRange>& steps, const PairClearance& pair,
                                           const LocalWitnessLimits& limits) {
    std::vector<Witness> nearest;
    if (steps)
        nearest = core::clearance::nearest_by_window(model, trajectory, {pair.a, pair.b}, {steps->first, steps->last, limits.parts},
                                                     farthest(pair, limits), accuracy(pair, limits));
    std::vector<Witness> near = features_at(model, trajectory, pair, pair.witness, limits);  // itself first
    near.insert(near.end(), nearest.begin(), nearest.end());
    const auto has_none = [&](const Witness& w) { return !no_derivative_at(model, trajectory, pair.a, pair.b, w).empty(); };
    near.erase(std::remove_if(near.begin() + 1, near.end(), has_none), near.end());
    std::vector<PairClearance> chosen;
    for (const Witness& w : distinct_witnesses(model, trajectory, {pair.a, pair.b}, near, limits.most))
        chosen.push_back(with_witness(pair, w));
    return chosen;
}

std::vector<PairClearance> local_witnesses(const Model& model, const JointRanges& ranges, const PairClearance& pair,
                                           const LocalWitnessLimits& limits) {
    const double rounding = pair.upper - pair.witness.distance;
    const core::clearance::PairRequest bodies{pair.a, pair.b};
    StandingMotion found(model, ranges);
    PairClearance own = pair;
    own.witness = found.add(pair);
    std::vector<Witness> places{own.witness};
    for (const PairClearance& part :
         core::clearance::nearest_by_part(model, ranges, bodies, limits.parts, farthest(pair, limits), accuracy(pair, limits)))
        places.push_back(found.add(part));
    std::vector<Witness> near;
    for (const Witness& place : places) {
        const std::vector<Witness> there = features_at(model, found.trajectory(), pair, place, limits);
        near.insert(near.end(), there.begin(), there.end());
    }
    StandingMotion settled(model, ranges);
    std::vector<Witness> minima{settled.add(pair)};
    for (const Witness& w : distinct_witnesses(model, found.trajectory(), bodies, near, most_settled, Places::positions))
        minima.push_back(settled.add(local_minimum(model, ranges, found.at(w))));
    std::vector<PairClearance> chosen;
    for (const Witness& w : distinct_witnesses(model, settled.trajectory(), bodies, minima, limits.most, Places::positions)) {
        chosen.push_back(settled.at(w));
        chosen.back().upper = w.distance + rounding;
    }
    return chosen;
}

}  // namespace fettle::adjoint::clearance
