// SPDX-License-Identifier: MIT
/// What is reported of a pair beyond its least distance (clearance.hpp): witnesses by their primitives, all of those that tie, the margin
/// curve, and whether the bodies pass through each other.
#pragma once

#include <vector>

#include "fettle/core/clearance/pair_clearance.hpp"
#include "fettle/core/clearance/pair_search.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

/// Two bodies over a list of path segments.
struct PairMotion {
    const PieceTree& a;
    const PieceTree& b;
    const stepper::Trajectory& trajectory;
    std::vector<PairSegment> segments;
};

Witness witness_of(const PairMotion& pair, const Encounter& encounter);

/// `first`, then the others within `tolerance` of it, the nearest first; of two with the same instant and points only one.
std::vector<Witness> all_witnesses(const PairMotion& pair, const Encounter& first, double tolerance, int most, const SearchOptions& search);

/// Bounds per segment; `whole` are those over all of them.
std::vector<MarginInterval> margin_curve(const PairMotion& pair, const SearchResult& whole, const SearchOptions& search);

/// Does an edge of one pass through a triangle of the other, deeper than rounding, at a node of the path? Stops at the first found.
bool intersects_at_nodes(const PairMotion& pair, const SearchOptions& search);

}  // namespace fettle::core::clearance
