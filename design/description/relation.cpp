// SPDX-License-Identifier: MIT
#include "design/description/relation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::design::description {

std::function<RelationValue(const VectorX&)> function_of(const core::expression::Formula& formula,
                                                         const std::vector<Parameter>& parameters) {
    const std::vector<std::string> names = names_of(parameters);
    return [formula, positions = core::expression::positions_of(formula, names)](const VectorX& p) {
        std::vector<double> inputs;
        for (const int position : positions) inputs.push_back(p[position]);
        const core::expression::ValueAndGradient at = core::expression::differentiated(formula, inputs);
        RelationValue out{at.value, VectorX::Zero(p.size())};
        for (size_t k = 0; k < positions.size(); ++k) out.gradient[positions[k]] = at.gradient[k];
        return out;
    };
}

double violation(const Relation& relation, double value) {
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    const double beyond = std::max(relation.bounds.lower - value, value - relation.bounds.upper);
    return beyond > relation.tolerance ? beyond / relation.bounds.unit : 0;
}

}  // namespace fettle::design::description
