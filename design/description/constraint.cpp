// SPDX-License-Identifier: MIT
#include "fettle/design/description/constraint.hpp"

#include <algorithm>

namespace fettle::design::description {

double violation(const Bounds& bounds, const Measurement& measured) {
    const double beyond = std::max({0.0, bounds.lower - measured.lower, measured.upper - bounds.upper}) / bounds.unit;
    return measured.fault.empty() ? beyond : std::max(beyond, 1.0);
}

}  // namespace fettle::design::description
