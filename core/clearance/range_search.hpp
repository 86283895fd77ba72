// SPDX-License-Identifier: MIT
/// The least distance of two bodies over a box of joint coordinates, by branch and bound (box_search.hpp) with the bounds of
/// range_bound.hpp.
#pragma once

#include "core/clearance/box_search.hpp"
#include "core/clearance/range_bound.hpp"
#include "core/clearance/search_result.hpp"

namespace fettle::core::clearance {

/// Two elements at a configuration.
struct RangeEncounter {
    Coordinates at{};
    int element_a = -1, element_b = -1;  ///< -1: none was looked at
    ElementPairDistance pair;            ///< in the world, what moves both bodies left where it starts
};

/// Both bodies at rest at a configuration, and where they are nearest there; elements of -1 where the budget ends that search at once.
PairSegment held_at(const ScrewedPair& pair, const Coordinates& at);
RangeEncounter nearest_at(const ScrewedPair& pair, const Coordinates& at, const SearchOptions& search);

using RangeSearchResult = BoxSearchResult<RangeEncounter>;

RangeSearchResult search_ranges(const ScrewedPair& pair, const BoxSearchOptions& options);

/// The tree of cells that proves `distance` > 0 (certificate.hpp), by the same bounds. Contract: at most what a search has proven.
/// Empty where a stop or the budget ended it.
certificate::BoxProof prove_ranges(const ScrewedPair& pair, double distance, const BoxSearchOptions& options);

}  // namespace fettle::core::clearance
