// SPDX-License-Identifier: MIT
/// A requirement on a simulated design: lower <= quantity <= upper. The optimiser aims at bounds narrowed by a margin and sees the
/// quantity's `value`; whether a design meets the requirement is judged by the proven side of the quantity alone: quantity.lower >= lower
/// and quantity.upper <= upper. (For a clearance, `value` is the distance at the witness, `lower` the certificate.) Two kinds:
/// clearance_constraint.hpp, and bounds on any objective's quantity, bounded_objective.hpp.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "fettle/design/objectives/objective.hpp"

namespace fettle::design::constraints {

struct Bounds {
    double lower = -std::numeric_limits<double>::infinity();  ///< SI
    double upper = std::numeric_limits<double>::infinity();
    double margin = 0;  ///< by which the optimiser keeps away from both; less than half their distance
    double unit = 1;    ///< SI value of the unit that violations are counted in
};

class Constraint {
public:
    Constraint(std::string name, const Bounds& bounds) : name_(std::move(name)), bounds_(bounds) {}
    virtual ~Constraint() = default;

    const std::string& name() const { return name_; }
    const Bounds& bounds() const { return bounds_; }
    double target_lower() const { return bounds_.lower + bounds_.margin; }
    double target_upper() const { return bounds_.upper - bounds_.margin; }

    /// max(0, lower - quantity.lower, quantity.upper - upper) in `unit`s; 0: the requirement is met, proven.
    double violation(const objectives::Quantity& quantity) const;

    /// As Objective's.
    virtual objectives::Quantity value(const objectives::Simulated& simulated) const = 0;
    virtual void add_seeds(const objectives::Simulated& simulated, const objectives::Quantity& quantity, double scale,
                           objectives::Seeds& seeds) const = 0;

    /// Is it a certified clearance? Then its `quantity.clearance` belongs into the certificate of the final design.
    virtual bool is_clearance() const { return false; }

private:
    std::string name_;
    Bounds bounds_;
};

}  // namespace fettle::design::constraints
