// SPDX-License-Identifier: MIT
#include "design/tolerances/capability.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

Capability capability_of(double mean, double standard_deviation, const RequirementLimits& limits) {
    FETTLE_ASSERT(standard_deviation >= 0 && limits.lower <= limits.upper, "a deviation, and limits in order");
    Capability result;
    if (standard_deviation == 0) return result;
    const double width = limits.upper - limits.lower, nearest = std::min(limits.upper - mean, mean - limits.lower);
    if (std::isfinite(width)) result.cp = CapabilityIndex{width / (6 * standard_deviation), 0};
    if (std::isfinite(nearest)) result.cpk = CapabilityIndex{nearest / (3 * standard_deviation), 0};
    return result;
}

Capability estimated_capability(double mean, double standard_deviation, const RequirementLimits& limits, int n) {
    FETTLE_ASSERT(n >= 2, "two values or more");
    Capability result = capability_of(mean, standard_deviation, limits);
    const double degrees = n - 1;
    if (result.cp) result.cp->error = result.cp->value / std::sqrt(2 * degrees);
    if (result.cpk) result.cpk->error = std::sqrt(1.0 / (9.0 * n) + result.cpk->value * result.cpk->value / (2 * degrees));
    return result;
}

}  // namespace fettle::design::tolerances
