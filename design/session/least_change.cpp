// SPDX-License-Identifier: MIT
#include "design/session/least_change.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/contract.hpp"

namespace fettle::design::session {

// The solution is s_k = clamp(m slope_k), of one multiplier m for all, in ranges. As variables come to their bounds the others have to do
// more, so that m only grows: who is at a bound stays there, and each pass but the last fixes one at least.
LeastChange least_change(const VectorX& at, const VectorX& lower, const VectorX& upper, const VectorX& gradient, double wanted) {
    FETTLE_ASSERT(at.size() == gradient.size() && lower.size() == at.size() && upper.size() == at.size(), "one entry per parameter");
    const VectorX range = upper - lower, slope = gradient.cwiseProduct(range);
    const Eigen::Index n = at.size();
    LeastChange found{at, 0, true};
    std::vector<bool> is_held(static_cast<std::size_t>(n), false);
    double done_by_held = 0;
    for (Eigen::Index pass = 0; pass <= n; ++pass) {
        double size = 0;
        for (Eigen::Index k = 0; k < n; ++k)
            if (!is_held[static_cast<std::size_t>(k)]) size += slope[k] * slope[k];
        if (!(size > 0)) break;
        const double multiplier = (wanted - done_by_held) / size;
        bool any_held = false;
        for (Eigen::Index k = 0; k < n; ++k) {
            if (is_held[static_cast<std::size_t>(k)]) continue;
            const double goal = at[k] + multiplier * slope[k] * range[k];
            found.values[k] = std::clamp(goal, lower[k], upper[k]);
            if (goal >= lower[k] && goal <= upper[k]) continue;
            is_held[static_cast<std::size_t>(k)] = any_held = true;
            done_by_held += gradient[k] * (found.values[k] - at[k]);
        }
        if (!any_held) break;
    }
    found.change = gradient.dot(found.values - at);
    found.reaches = std::abs(found.change - wanted) <= 1e-9 * std::abs(wanted);
    return found;
}

}  // namespace fettle::design::session
