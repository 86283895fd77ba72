// SPDX-License-Identifier: MIT
/// How far bodies go in a motion: a mechanism that transmits nothing is seen at once.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::design::answers {

/// From its start, at the ends of the steps.
struct Travel {
    double distance = 0;  ///< largest of its centre of mass (of its reference point) [m]
    /// Largest length of the sum of its steps' rotation vectors [rad]: about a fixed axis the angle, whole turns counted; a step turns by
    /// less than half a turn.
    double turn = 0;
    bool is_motion() const { return distance > 1e-6 || turn > 1e-4; }  ///< more than a micrometre, or a hundredth of a degree
};

/// One per body.
std::vector<Travel> travels(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// "moved: crank (turned 360 deg), piston (30 mm); not moved: block", in the model's unit of length. Where there are many: those that went
/// farthest; empty: there are no steps.
std::string travels_text(const core::model::Model& model, const std::vector<Travel>& travels);

}  // namespace fettle::design::answers
