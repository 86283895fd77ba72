// SPDX-License-Identifier: MIT
#include "design/quantities/in_scenario.hpp"

#include <algorithm>

#include "design/quantities/expression.hpp"
#include "design/quantities/worst.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Quantity;
using description::QuantityFacts;
using description::Seeds;
using description::Simulated;
using Kind = QuantityFacts::Kind;

namespace {

// Each of which may be of a scenario of its own.
bool is_made_of_quantities(const QuantityFacts& facts) { return facts.kind == Kind::formula || facts.kind == Kind::worst; }

std::vector<std::shared_ptr<const Quantity>> quantities_of(const std::vector<NamedQuantity>& parts) {
    std::vector<std::shared_ptr<const Quantity>> out;
    for (const NamedQuantity& part : parts) out.push_back(part.quantity);
    return out;
}

}  // namespace

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
    if (!is_made_of_quantities(facts)) return std::make_shared<InScenario>(quantity, scenario);
    for (NamedQuantity& part : facts.parts) part.quantity = in_scenario(part.quantity, scenario);
    if (facts.kind == Kind::worst) return std::make_shared<Worst>(quantities_of(facts.parts), quantity->is_greatest_branch());
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
    return is_made_of_quantities(facts) && !facts.parts.empty() &&
           std::all_of(facts.parts.begin(), facts.parts.end(), [](const NamedQuantity& part) { return has_scenario(*part.quantity); });
}

const description::ClearanceRange* clearance_of(const Quantity& quantity) { return without_scenario(quantity).facts().clearance; }

}  // namespace fettle::design::quantities
