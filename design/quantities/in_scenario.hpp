// SPDX-License-Identifier: MIT
/// A quantity of one scenario of the design (description/design.hpp): it asks, and is differentiated in, that scenario alone. An expression
/// can name quantities of several: `"travel_up - travel_down"` is the lost motion between two.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

class InScenario : public description::Quantity {
public:
    InScenario(std::shared_ptr<const Quantity> quantity, int scenario) : quantity_(std::move(quantity)), scenario_(scenario) {}

    const std::shared_ptr<const Quantity>& quantity() const { return quantity_; }
    int scenario() const { return scenario_; }
    Dimension dimension() const override { return quantity_->dimension(); }
    description::QuantityFacts facts() const override {
        return {.kind = description::QuantityFacts::Kind::in_scenario, .parts = {{"", quantity_}}, .scenario = scenario_};
    }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    VectorX deviations(const description::Simulated& simulated) const override;
    void add_deviation_seeds(const description::Simulated& simulated, int i, double scale, description::Seeds& seeds) const override;
    std::vector<description::Branch> branches(const description::Simulated& simulated, const description::Measurement& measured,
                                              double limit) const override;
    bool is_greatest_branch() const override { return quantity_->is_greatest_branch(); }
    std::string doubt(const description::Simulated& simulated, const description::Measurement& measured) const override {
        return quantity_->doubt(simulated.in(scenario_), measured);
    }
    std::optional<description::Continuation> continuation(const description::Simulated& simulated, const description::Measurement& measured,
                                                          const description::Bounds& bounds) const override {
        return quantity_->continuation(simulated.in(scenario_), measured, bounds);
    }
    bool is_at_rest() const override { return quantity_->is_at_rest(); }
    bool is_about(int scenario) const override { return scenario == scenario_; }
    std::vector<std::string> parameters() const override { return quantity_->parameters(); }
    std::string explanation(const description::Measurement& measured) const override { return quantity_->explanation(measured); }
    Errors check(const core::model::Model& model, int steps) const override { return quantity_->check(model, steps); }

private:
    std::shared_ptr<const Quantity> quantity_;
    int scenario_;
};

/// The quantity in that scenario. An expression, and the worst of several, have those of their parts in it that are of no scenario yet.
std::shared_ptr<const description::Quantity> in_scenario(const std::shared_ptr<const description::Quantity>& quantity, int scenario);

/// What is measured, in whichever scenario: the quantity itself where it is of none.
const description::Quantity& without_scenario(const description::Quantity& quantity);
/// The number of the scenario that it is of; 0 where it is of none, or an expression of several.
int scenario_of(const description::Quantity& quantity);

/// What a clearance is over, in whichever scenario; null: it is none.
const description::ClearanceRange* clearance_of(const description::Quantity& quantity);

/// Is it of a scenario already, and each part of an expression, or of the worst of several?
bool has_scenario(const description::Quantity& quantity);

}  // namespace fettle::design::quantities
