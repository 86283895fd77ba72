// SPDX-License-Identifier: MIT
/// How a number counts that a design asks for over its tolerances, and not as drawn: with what is kept in reserve for the deviations of
/// what is made, to first order of its derivatives (tolerances/robust_offset.hpp).
#pragma once

#include <string>

namespace fettle::design::description {

struct OverTolerances {
    enum class Kind { sigma, worst_case };
    Kind kind = Kind::sigma;
    double sigmas = 3;  ///< standard deviations from the mean; of a worst case nothing

    bool operator==(const OverTolerances&) const = default;
};

/// "at 3 sigma of the tolerances", "in the worst case of the tolerances".
std::string words(const OverTolerances& over);

}  // namespace fettle::design::description
