// SPDX-License-Identifier: MIT
/// How a number counts that a design asks for over its tolerances, and not as drawn: with a reserve for the deviations of the design as
/// made, to first order of its derivatives (tolerances/robust_offset.hpp), or proven.
#pragma once

#include <string>

namespace fettle::design::description {

struct OverTolerances {
    /// proven: the least clearance of all parts within the tolerances, certified (problem/proven_clearance.hpp)
    enum class Kind { sigma, worst_case, proven };
    Kind kind = Kind::sigma;
    double sigmas = 3;  ///< standard deviations from the mean; of others nothing

    bool operator==(const OverTolerances&) const = default;
};

/// "at 3 sigma of the tolerances", "in the worst case of the tolerances", "for all parts within the tolerances, proven".
std::string words(const OverTolerances& over);

}  // namespace fettle::design::description
