// SPDX-License-Identifier: MIT
/// Whether the surfaces of two bodies cross during a motion, and since when. Asked where a search for the least distance (pair_search.hpp)
/// ended with the lower bound 0: bodies that only come very close, and bodies that pass through each other between two instants, look
/// alike to it.
#pragma once

#include <optional>

#include "core/clearance/pair_details.hpp"

namespace fettle::core::clearance {

struct CrossingResult {
    std::optional<Encounter> crossing;  ///< an edge of one passes through a triangle of the other, deeper than rounding
    double lower = 0;                   ///< greater than 0: proven that the surfaces never meet, and stay so far apart [m]
};

/// Over all of the path, not only its nodes. Neither is found where the budget ends first, or where it is a matter of rounding.
CrossingResult find_crossing(const PairMotion& pair, const SearchOptions& search);

/// When surfaces meet first, of a pair that is known to be in each other at `known`.
struct FirstContact {
    double not_before = 0;  ///< proven: until then the surfaces have not met; the start of the path if not even that is proven [s]
    Encounter encounter;    ///< the elements that come within a fraction of the tolerance of each other first
};
/// By halving the path up to `known`, parts of which are searched for a distance that is proven to be greater than 0.
FirstContact first_contact(const PairMotion& pair, const Encounter& known, const SearchOptions& search);

}  // namespace fettle::core::clearance
