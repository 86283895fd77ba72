// SPDX-License-Identifier: MIT
/// Certified clearance of two bodies of at least `minimum`, as assembled or over the motion (or a window of it: the least distance over a
/// long motion jumps between times that are far apart, and is not smooth there; as one constraint per window each follows its own).
#pragma once

#include <utility>

#include "fettle/design/constraints/constraint.hpp"

namespace fettle::design::constraints {

struct ClearanceRequirement {
    int a = 0, b = 0;             ///< bodies
    bool motion = false;          ///< over the trajectory; false: as assembled
    int window = 0, windows = 1;  ///< which of how many equal parts of the motion
};

class ClearanceConstraint : public Constraint {
public:
    ClearanceConstraint(std::string name, const Bounds& bounds, const ClearanceRequirement& requirement)
        : Constraint(std::move(name), bounds), requirement_(requirement) {}

    objectives::Quantity value(const objectives::Simulated& simulated) const override;
    void add_seeds(const objectives::Simulated& simulated, const objectives::Quantity& quantity, double scale,
                   objectives::Seeds& seeds) const override;
    bool is_clearance() const override { return true; }

private:
    ClearanceRequirement requirement_;
};

/// Steps [first, last) of window w of n: [floor(w steps / n), floor((w + 1) steps / n)), and one step where that is empty (n > steps).
std::pair<int, int> window_steps(int steps, int window, int windows);

}  // namespace fettle::design::constraints
