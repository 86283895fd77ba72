// SPDX-License-Identifier: MIT
#include "design/description/constraint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::design::description {

double violation(const Bounds& bounds, const Measurement& measured) {
    if (std::isnan(measured.value) || std::isnan(measured.lower) || std::isnan(measured.upper))
        return std::numeric_limits<double>::infinity();
    const double below = measured.lower >= bounds.lower ? 0 : bounds.lower - measured.lower;
    const double above = measured.upper <= bounds.upper ? 0 : measured.upper - bounds.upper;
    const double beyond = std::max(below, above) / bounds.unit;
    return measured.fault.empty() ? beyond : std::max(beyond, 1.0);
}

}  // namespace fettle::design::description
