// SPDX-License-Identifier: MIT
/// Branch and bound for the least distance of two bodies over a list of path segments: boxes of both hierarchies and intervals
/// of time, the most promising first. Bounds: segment_bound.hpp. What callers use: clearance.hpp.
///
/// An entry is (interval, piece of a, piece of b) with a proven lower bound. The least of the entries in the queue and of those set
/// aside (within the tolerance of the upper bound, or at the limit of rounding) bounds the distance from below at any moment, so the
/// search may stop at any time. Entries are halved in time where the motion loosens their bound more than the size of the boxes does.
/// All segments share one queue and one upper bound: a segment during which the bodies are far apart costs one entry.
#pragma once

#include <functional>
#include <vector>

#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

struct SearchBody {
    const geometry::Mesh* mesh = nullptr;
    const contact::BodyHierarchy* hierarchy = nullptr;
};

struct SearchOptions {
    double tolerance = 1e-6;
    long max_evaluations = 50'000'000;
    double deviation_scale = 1;         ///< less than 1 breaks the proof: for tests that must notice
    std::function<bool()> should_stop;  ///< optional
};

struct SearchResult {
    double lower = 0, upper = 0;  ///< [m], lower >= 0; upper - lower <= tolerance unless rounding or the budget stands in the way
    Witness witness;              ///< of `upper`; `time` left to the caller
    long evaluations = 0;         ///< bounds computed
    bool complete = true;         ///< false: out of budget, or stopped
    bool intersecting = false;    ///< the witness is an edge that passes through a triangle
};

/// Contract: at least one segment; hierarchies of triangles only.
SearchResult search_pair(const SearchBody& a, const SearchBody& b, const std::vector<PairSegment>& segments, const SearchOptions& options);

}  // namespace fettle::core::clearance
