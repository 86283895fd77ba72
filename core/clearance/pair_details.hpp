// SPDX-License-Identifier: MIT
/// What is reported of a pair beyond its least distance (clearance.hpp): witnesses by their primitives, all of those that tie, and the
/// margin curve. Whether the bodies pass through each other: crossing.hpp.
#pragma once

#include <vector>

#include "core/certificate/disjoint_solids.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/clearance/pair_search.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

/// Two bodies over a list of path segments.
struct PairMotion {
    const PieceTree& a;
    const PieceTree& b;
    const stepper::Trajectory& trajectory;
    std::vector<PairSegment> segments;
    const certificate::SolidMesh &solid_a, &solid_b;
};

double time_of(const PairMotion& pair, int segment, double s);

Witness witness_of(const PairMotion& pair, const Encounter& encounter);

/// `first`, then the others within `tolerance` of it, the nearest first; of two with the same instant and points only one.
std::vector<Witness> all_witnesses(const PairMotion& pair, const Encounter& first, double tolerance, int most, const SearchOptions& search);

/// Bounds per segment; `whole` are those over all of them.
std::vector<MarginInterval> margin_curve(const PairMotion& pair, const SearchResult& whole, const SearchOptions& search);

}  // namespace fettle::core::clearance
