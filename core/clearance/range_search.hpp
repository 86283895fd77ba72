// SPDX-License-Identifier: MIT
/// Branch and bound for the least distance of two bodies over a box of joint coordinates: cells (box, piece of a, piece of b), the most
/// promising first, halved along a coordinate where the box loosens the bound (range_bound.hpp) by more than half the pieces' size, else
/// the larger piece is split. The least bound of the queue bounds the distance from below at any moment. Before that, samples of the box
/// and a search downhill from the best give an upper bound that is nearly the least: most cells are never looked at.
#pragma once

#include <functional>
#include <limits>

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/clearance/range_bound.hpp"

namespace fettle::core::clearance {

struct RangeSearchOptions {
    double tolerance = 1e-6;  ///< [m]
    double minimum = 0;       ///< greater than 0: goes on below the tolerance until it does not lie between the bounds
    long max_bounds = 4'000'000;
    std::function<bool()> should_stop;
    double enough = std::numeric_limits<double>::infinity();  ///< stops where they are proven so far apart, whatever the least distance [m]
};

/// Two elements at a configuration.
struct RangeEncounter {
    Coordinates at{};
    int element_a = -1, element_b = -1;  ///< -1: none was looked at
    ElementPairDistance pair;            ///< in the world, what moves both bodies left where it starts
};

struct RangeSearchResult {
    double lower = 0, upper = std::numeric_limits<double>::infinity();  ///< [m]
    RangeEncounter nearest;                                             ///< attains `upper`, up to slack
    long bounds = 0;
    bool complete = true;       ///< false: out of budget, or stopped, before the tolerance was reached
    bool intersecting = false;  ///< `nearest` is an edge through a triangle, deeper than rounding
};

RangeSearchResult search_ranges(const ScrewedPair& pair, const RangeSearchOptions& options);

/// The tree of cells that proves `distance` > 0 (certificate.hpp), by the same bounds. Contract: at most what a search has proven.
/// Empty where a stop or the budget ended it.
certificate::BoxProof prove_ranges(const ScrewedPair& pair, double distance, const RangeSearchOptions& options);

}  // namespace fettle::core::clearance
