// SPDX-License-Identifier: MIT
/// Any objective's quantity, kept between bounds: a stroke, a mass, a play, a marker's deviation.
#pragma once

#include <memory>

#include "fettle/design/constraints/constraint.hpp"

namespace fettle::design::constraints {

class BoundedObjective : public Constraint {
public:
    BoundedObjective(std::string name, const Bounds& bounds, std::unique_ptr<objectives::Objective> objective)
        : Constraint(std::move(name), bounds), objective_(std::move(objective)) {}

    objectives::Quantity value(const objectives::Simulated& simulated) const override { return objective_->value(simulated); }
    void add_seeds(const objectives::Simulated& simulated, const objectives::Quantity& quantity, double scale,
                   objectives::Seeds& seeds) const override {
        objective_->add_seeds(simulated, quantity, scale, seeds);
    }

private:
    std::unique_ptr<objectives::Objective> objective_;
};

}  // namespace fettle::design::constraints
