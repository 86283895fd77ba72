// SPDX-License-Identifier: MIT
/// Branch and bound for the least distance of two bodies over a list of path segments: pieces of both bodies and intervals of time, the
/// most promising first. Bounds: segment_bound.hpp. What callers use: clearance.hpp.
///
/// An entry is (interval, piece of a, piece of b) with a proven lower bound. The least of the entries in the queue and of those set
/// aside (within the tolerance of the upper bound, or at the limit of rounding) bounds the distance from below at any moment, so the
/// search may stop at any time. Entries are halved in time where the motion loosens their bound more than the size of the boxes does.
/// All segments share one queue and one upper bound. Many segments are searched at once first (span_search.hpp), unless a proof is to be
/// recorded, which is told segment by segment; then each one is (segment_search.hpp), and costs at least one entry.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "fettle/core/clearance/certificate.hpp"
#include "fettle/core/clearance/segment_bound.hpp"
#include "fettle/core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {

struct SearchOptions {
    double tolerance = 1e-6;
    long max_evaluations = 50'000'000;
    double deviation_scale = 1;                               ///< less than 1 breaks the proof: for tests that must notice
    std::function<bool()> should_stop;                        ///< optional
    double enough = std::numeric_limits<double>::infinity();  ///< a lower bound of this much ends the search, whatever the gap [m]
    bool nodes_only = false;                                  ///< at the ends of the segments instead of over them
    bool seek_intersection = false;  ///< for an edge through a triangle, deeper than rounding: bounds are of no use then
    std::optional<Encounter> seed;   ///< of the same bodies: its distance is the first upper bound
    bool sample_nodes = false;       ///< find SearchResult::sampled along the way. Contract: no proof, over more than one segment
    PairProof* proof = nullptr;      ///< the tree of entries is recorded here, one proof per segment
};

struct SearchResult {
    double lower = 0, upper = 0;  ///< [m], lower >= 0; upper - lower <= tolerance unless rounding or the budget stands in the way
    Encounter nearest;            ///< attains `upper`
    Encounter sampled;            ///< if asked for: the least at ends of segments, to a hundredth of the tolerance
    long evaluations = 0;         ///< bounds computed
    bool complete = true;         ///< false: out of budget, or stopped
    bool intersecting = false;    ///< `nearest` is an edge that passes through a triangle, deeper than rounding
};

/// Contract: at least one segment.
SearchResult search_pair(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options);

/// Where the bodies come within `distance` of each other: for every segment and pair of elements that does, the least distance found.
/// Ends early, with what it has, at `most` of them.
std::vector<Encounter> encounters_within(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, double distance,
                                         std::size_t most, const SearchOptions& options);

}  // namespace fettle::core::clearance
