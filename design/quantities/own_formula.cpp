// SPDX-License-Identifier: MIT
#include "design/quantities/own_formula.hpp"

#include <algorithm>

#include "core/base/contract.hpp"

namespace fettle::design::quantities {

using core::expression::Formula;
using description::Seeds;
using description::Simulated;

namespace {

std::vector<double> inputs_of(const Formula& formula, const Simulated& simulated) {
    std::vector<double> inputs;
    for (const int position : positions_of(formula, simulated.names)) inputs.push_back(simulated.parameters[position]);
    return inputs;
}

}  // namespace

double value_at(const Formula& formula, const Simulated& simulated) {
    return core::expression::value_of<double>(formula, inputs_of(formula, simulated));
}

void add_parameter_seed(const std::string& parameter, const Simulated& simulated, double scale, Seeds& seeds) {
    const auto found = std::find(simulated.names.begin(), simulated.names.end(), parameter);
    FETTLE_ASSERT(found != simulated.names.end(), "a formula's inputs are parameters of the design");
    if (seeds.parameters_bar.size() == 0) seeds.parameters_bar = VectorX::Zero(simulated.parameters.size());
    seeds.parameters_bar[found - simulated.names.begin()] += scale;
}

void add_formula_seed(const Formula& formula, const Simulated& simulated, double scale, Seeds& seeds) {
    const VectorX gradient = core::expression::differentiated(formula, inputs_of(formula, simulated)).gradient;
    for (size_t k = 0; k < formula.inputs.size(); ++k) add_parameter_seed(formula.inputs[k], simulated, scale * gradient[k], seeds);
}

Vector3 OwnPoint::value(const Simulated& simulated) const {
    Vector3 out = at;
    for (size_t k = 0; k < 3; ++k)
        if (formulas[k]) out[static_cast<Eigen::Index>(k)] = value_at(*formulas[k], simulated);
    return out;
}

void OwnPoint::add_seed(const Simulated& simulated, const Vector3& gradient, Seeds& seeds) const {
    for (size_t k = 0; k < 3; ++k)
        if (formulas[k]) add_formula_seed(*formulas[k], simulated, gradient[static_cast<Eigen::Index>(k)], seeds);
}

void OwnPoint::add_parameters(std::vector<std::string>& names) const {
    for (const std::optional<Formula>& formula : formulas)
        if (formula) names.insert(names.end(), formula->inputs.begin(), formula->inputs.end());
}

}  // namespace fettle::design::quantities
