// SPDX-License-Identifier: MIT
/// Chooses, among many witnesses of one pair of bodies, the few that say most about how its least distance can change.
///
/// Each witness is a distance of its own, d_i, and the clearance is the least of them: it changes at most as any of them does,
///   clearance(p) <= d_i(p),   and to first order   clearance(p + dp) = min_i (d_i + d_i' dp).
/// Neighbours of one minimum say nearly the same. Two witnesses differ by the wrench with which they act on the bodies' relative position,
///   w = (n, (m - o) x n / L),   n the unit direction from b to a, m the midpoint, o and L of the smaller body: reference point, radius,
/// by |w_i - w_j|, and by how much their places differ: by 1 if they are of different instants; positions of joints by how far both bodies
/// have turned and moved, |R_i - R_j| + |q_i - q_j| / L each, at most 1. Chosen is the one that differs most from all chosen so far
/// (farthest first), or rather the nearest of those like it; until none differs by 0.2.
#pragma once

#include <vector>

#include "core/clearance/clearance.hpp"

namespace fettle::adjoint::clearance {

/// What the steps of a trajectory are.
enum class Places {
    instants,  ///< of a motion
    positions  ///< of joints: the trajectory stands still at each for a step
};

/// @param candidates  Witnesses of the same pair, with their points; the first is the least one, and not among the answers.
/// @param most        At most so many are chosen. O(most * candidates).
/// @return            In the order of choice: the first few are as spread out as can be.
std::vector<core::clearance::Witness> distinct_witnesses(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                         const core::clearance::PairRequest& pair,
                                                         const std::vector<core::clearance::Witness>& candidates, int most,
                                                         Places places = Places::instants);

/// Whether two witnesses of a pair, at one place, differ so little that one of them stands for both: by less than 0.4.
bool are_alike(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const core::clearance::PairRequest& pair,
               const core::clearance::Witness& one, const core::clearance::Witness& other);

}  // namespace fettle::adjoint::clearance
