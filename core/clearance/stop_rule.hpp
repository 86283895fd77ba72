// SPDX-License-Identifier: MIT
/// When a search for a least distance has found enough, where what is asked is an answer and not the distance itself: is a minimum kept,
/// or, without one, about how far are the two apart? Then their bounds may be farther apart than the tolerance once the answer is known.
/// docs/method/clearance.md#when-a-search-stops.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::clearance {

struct StopRule {
    double minimum = 0;                               ///< that is asked about [m]; 0: none
    bool answer_is_enough = false;                    ///< false: the tolerance is what is wanted
    long quick = 0;                                   ///< bounds that are computed for the tolerance's sake all the same
    long patient = std::numeric_limits<long>::max();  ///< after so many bounds a known answer ends the search, whatever the gap

    /// How far apart the bounds may be that end the search [m]: a tenth of what is above the minimum (or below it), or a thousandth of the
    /// distance where there is none; as upper - lower <= (lower - minimum)/10 says of `upper`.
    double gap(double tolerance, double upper, long bounds) const {
        if (!answer_is_enough || bounds < quick || !std::isfinite(upper)) return tolerance;
        return std::max(tolerance, minimum > 0 ? std::abs(upper - minimum) / 11 : upper / 1000);
    }
    /// Without a minimum: how far they are apart, to a tenth.
    bool is_answered(double lower, double upper) const {
        return minimum > 0 ? lower >= minimum || upper < minimum : lower > 0 && lower >= 0.9 * upper;
    }
    bool ends(double lower, double upper, long bounds) const { return answer_is_enough && bounds >= patient && is_answered(lower, upper); }
};

}  // namespace fettle::core::clearance
