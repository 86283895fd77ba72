// SPDX-License-Identifier: MIT
#include "core/solver/caution.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::solver {
namespace {

constexpr double bold_fraction = 0.25;  // a step cut below this was too bold
constexpr int most_failures = 6;        // to find a step, in a row
constexpr double largest_rise = 1e4;    // over the initial shift
constexpr double good_agreement = 0.1;  // of the share gained, below a quadratic's

}  // namespace

void Caution::adapt(const Outcome& outcome) {
    failures_ = outcome.fraction > 0 ? 0 : failures_ + 1;
    shift_ = std::max(shift_, outcome.shift);
    const double largest = largest_rise * initial_;
    if (!outcome.arrived) {
        shift_ = outcome.fraction > 0 ? initial_ : std::min(10 * shift_, largest);
    } else if (outcome.fraction < bold_fraction) {
        const double least = std::min(std::max(1.0, 4 * shift_), largest);
        shift_ = std::clamp(outcome.fraction > 0 ? outcome.curvature / outcome.fraction : 0, least, largest);
    } else if (outcome.fraction == 1) {
        const bool foretold = outcome.gain_share > 0.5 - good_agreement;
        shift_ *= foretold ? 0.01 : outcome.gain_share > 0.25 ? 0.1 : 0.5;
        if (shift_ < negligible_shift) shift_ = 0;
    }
}

bool Caution::may_try_again() const { return failures_ <= most_failures; }

}  // namespace fettle::core::solver
