// SPDX-License-Identifier: MIT
#include "design/quantities/in_scenario.hpp"

#include <algorithm>

#include "design/quantities/expression.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Quantity;
using description::Seeds;
using description::Simulated;

Measurement InScenario::value(const Simulated& simulated) const { return quantity_->value(simulated.in(scenario_)); }

void InScenario::add_seeds(const Simulated& simulated, const Measurement& measured, double scale, Seeds& seeds) const {
    if (simulated.scenario == scenario_) quantity_->add_seeds(simulated, measured, scale, seeds);
}

VectorX InScenario::deviations(const Simulated& simulated) const { return quantity_->deviations(simulated.in(scenario_)); }

void InScenario::add_deviation_seeds(const Simulated& simulated, int i, double scale, Seeds& seeds) const {
    if (simulated.scenario == scenario_) quantity_->add_deviation_seeds(simulated, i, scale, seeds);
}

std::vector<description::Branch> InScenario::branches(const Simulated& simulated, const Measurement& measured, double limit) const {
    return simulated.scenario == scenario_ ? quantity_->branches(simulated, measured, limit) : std::vector<description::Branch>();
}

std::shared_ptr<const Quantity> in_scenario(const std::shared_ptr<const Quantity>& quantity, int scenario) {
    if (dynamic_cast<const InScenario*>(quantity.get()) != nullptr) return quantity;
    const auto* expression = dynamic_cast<const Expression*>(quantity.get());
    if (expression == nullptr) return std::make_shared<InScenario>(quantity, scenario);
    std::vector<NamedQuantity> parts = expression->parts();
    for (NamedQuantity& part : parts) part.quantity = in_scenario(part.quantity, scenario);
    return Expression::create(expression->formula(), parts).value();
}

const Quantity& without_scenario(const Quantity& quantity) {
    const auto* one = dynamic_cast<const InScenario*>(&quantity);
    return one == nullptr ? quantity : *one->quantity();
}

int scenario_of(const Quantity& quantity) {
    const auto* one = dynamic_cast<const InScenario*>(&quantity);
    return one == nullptr ? 0 : one->scenario();
}

bool has_scenario(const Quantity& quantity) {
    if (dynamic_cast<const InScenario*>(&quantity) != nullptr) return true;
    const auto* expression = dynamic_cast<const Expression*>(&quantity);
    return expression != nullptr && !expression->parts().empty() &&
           std::all_of(expression->parts().begin(), expression->parts().end(),
                       [](const NamedQuantity& part) { return has_scenario(*part.quantity); });
}

}  // namespace fettle::design::quantities
