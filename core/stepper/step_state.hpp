// SPDX-License-Identifier: MIT
/// What a simulation carries from step to step.
#pragma once

#include "core/energy/time_integration.hpp"

namespace fettle::core::stepper {

struct StepState {
    double time = 0;  ///< at the start of the step [s]
    energy::History history;
    double kappa = 0;  ///< what the barrier's stiffness has come to
};

}  // namespace fettle::core::stepper
