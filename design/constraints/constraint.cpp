// SPDX-License-Identifier: MIT
#include "fettle/design/constraints/constraint.hpp"

#include <algorithm>

namespace fettle::design::constraints {

double Constraint::violation(const objectives::Quantity& q) const {
    return std::max({0.0, bounds_.lower - q.lower, q.upper - bounds_.upper}) / bounds_.unit;
}

}  // namespace fettle::design::constraints
