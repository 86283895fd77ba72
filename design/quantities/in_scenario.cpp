// SPDX-License-Identifier: MIT
#include "design/quantities/in_scenario.hpp"

#include <algorithm>

#include "design/quantities/expression.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Quantity;
using description::QuantityFacts;
using description::Seeds;
using description::Simulated;
using Kind = QuantityFacts::Kind;

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
    QuantityFacts facts = quantity->facts();
    if (facts.kind == Kind::in_scenario) return quantity;
    if (facts.kind != Kind::formula) return std::make_shared<InScenario>(quantity, scenario);
    for (NamedQuantity& part : facts.parts) part.quantity = in_scenario(part.quantity, scenario);
    return Expression::create(*facts.formula, facts.parts).value();
}

const Quantity& without_scenario(const Quantity& quantity) {
    const QuantityFacts facts = quantity.facts();
    return facts.kind == Kind::in_scenario ? *facts.parts.front().quantity : quantity;
}

int scenario_of(const Quantity& quantity) { return quantity.facts().scenario; }

bool has_scenario(const Quantity& quantity) {
    const QuantityFacts facts = quantity.facts();
    if (facts.kind == Kind::in_scenario) return true;
    return facts.kind == Kind::formula && !facts.parts.empty() &&
           std::all_of(facts.parts.begin(), facts.parts.end(), [](const NamedQuantity& part) { return has_scenario(*part.quantity); });
}

const description::ClearanceRange* clearance_of(const Quantity& quantity) { return without_scenario(quantity).facts().clearance; }

}  // namespace fettle::design::quantities
