// SPDX-License-Identifier: MIT
#include "fettle/design/description/relation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::design::description {

double violation(const Relation& relation, double value) {
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    const double beyond = std::max(relation.bounds.lower - value, value - relation.bounds.upper);
    return beyond > relation.tolerance ? beyond / relation.bounds.unit : 0;
}

}  // namespace fettle::design::description
