// SPDX-License-Identifier: MIT
/// Branch and bound for the least distance of two bodies over a list of path segments: pieces of both bodies and intervals of time, the
/// most promising first (but see search_front.hpp). Bounds: segment_bound.hpp. What callers use: clearance.hpp.
///
/// An entry is (interval, piece of a, piece of b) with a proven lower bound. The least of the entries in the queue and of those set
/// aside (within the tolerance of the upper bound, or at the limit of rounding) bounds the distance from below at any moment, so the
/// search may stop at any time. Entries are halved in time where the motion loosens their bound more than the size of the boxes does.
/// All segments share one queue and one upper bound. Many segments are searched at once first, unless a proof is to be
/// recorded, which goes segment by segment; then each one is, and costs at least one entry. Whole bodies have
/// bounds by their convex hulls, too (hull_direction.hpp), for those that lie beside each other.
#pragma once

#include <cstddef>
#include <vector>

#include "core/clearance/search_result.hpp"

namespace fettle::core::clearance {

/// Contract: at least one segment.
SearchResult search_pair(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options);

/// Where the bodies come within `distance` of each other: for every segment and pair of elements that does, the least distance found.
/// Ends early, with what it has, at `most` of them.
std::vector<Encounter> encounters_within(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, double distance,
                                         std::size_t most, const SearchOptions& options);

}  // namespace fettle::core::clearance
