// SPDX-License-Identifier: MIT
/// What could become a clearance's witness when a design changes: the local minima of the distance, and the features that come nearly as
/// near there.
///
/// A clearance is the least of many smooth functions d_i of the design, each the distance of two features, at one place. Places are
/// instants of the motion, or positions of the joints. An optimiser that sees the derivative of the least alone goes from one to the next;
/// here are the others that it could run into. The same for both kinds of clearance, but for what places are and how those near which a
/// distance has its minimum are found:
///   over the motion     the nearest instant of each window of time (core/clearance/clearance.hpp, nearest_by_window), held
///   over ranges         the nearest position in each part of the ranges (core/clearance/range_clearance.hpp, nearest_by_part), from where
///                       each way downhill is followed to a minimum (range_adjoint.hpp, settled_witness)
/// At the witness itself, and over ranges at all of them, all features within the room are looked at (tied_features.hpp). Over the motion
/// those of other instants would crowd out the instants. A few of all are chosen that differ most (distinct_witnesses.hpp).
#pragma once

#include <optional>
#include <vector>

#include "core/clearance/clearance.hpp"
#include "core/clearance/joint_ranges.hpp"

namespace fettle::adjoint::clearance {

struct LocalWitnessLimits {
    double room = 0;  ///< by how much a witness may be farther apart than the pair's own [m]
    int parts = 8;    ///< of the motion, or of the ranges: in each the nearest place is looked at
    int most = 5;     ///< at most so many are chosen
};

/// The pair as it would be with each of the other witnesses (`upper` its distance, rounding added as in the pair's own), the most distinct
/// first; only those that have a derivative. As assembled, `steps` is nothing: there is one place. Contract: the pair is no clash, and its
/// distance is above 0.
/// @param steps  The steps of the trajectory over which the pair was certified.
std::vector<core::clearance::PairClearance> local_witnesses(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                            const std::optional<core::clearance::StepRange>& steps,
                                                            const core::clearance::PairClearance& pair, const LocalWitnessLimits& limits);

/// The same over ranges, each with its own PairClearance::at.
std::vector<core::clearance::PairClearance> local_witnesses(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                                                            const core::clearance::PairClearance& pair, const LocalWitnessLimits& limits);

}  // namespace fettle::adjoint::clearance
