// SPDX-License-Identifier: MIT
/// What a search for the least distance of two bodies is asked and answers: pair_search.hpp.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/clearance/segment_bound.hpp"
#include "core/clearance/stop_rule.hpp"
#include "core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {

struct SearchOptions {
    double tolerance = 1e-6;
    long max_evaluations = 50'000'000;
    std::function<bool()> should_stop;                          ///< optional
    double enough = std::numeric_limits<double>::infinity();    ///< a lower bound of this much ends the search, whatever the gap [m]
    StopRule stop;                                              ///< when less than the tolerance will do
    double refuted = -std::numeric_limits<double>::infinity();  ///< an upper bound below this ends the search, whatever the gap [m]
    bool nodes_only = false;                                    ///< at the ends of the segments instead of over them
    bool seek_intersection = false;  ///< for an edge through a triangle, deeper than rounding: bounds are of no use then
    std::optional<Encounter> seed;   ///< of the same bodies: its distance is the first upper bound
    bool exact_witness = true;       ///< `nearest` are the nearest elements at their instant, if that is found soon
    bool sample_nodes = false;       ///< find SearchResult::sampled along the way. Contract: over more than one segment
};

struct SearchResult {
    /// [m], lower >= 0; upper - lower <= tolerance unless less will do, or rounding or the budget stands in the way
    double lower = 0, upper = 0;
    Encounter nearest;          ///< attains `upper`
    Encounter sampled;          ///< if asked for: the least at ends of segments, to a hundredth of the tolerance
    long evaluations = 0;       ///< bounds computed
    bool complete = true;       ///< false: out of budget, or stopped
    bool intersecting = false;  ///< `nearest` is an edge that passes through a triangle, deeper than rounding
};

}  // namespace fettle::core::clearance
