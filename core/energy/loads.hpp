// SPDX-License-Identifier: MIT
/// Constant forces and torques as a term of the incremental potential:  - weight (f . (q - q_t0) + tau . theta). docs/method.md section 3.
/// tau is the constant gradient in the chart's theta that acts as the body's torque (time_integration.hpp). Gravity is in the inertia's
/// P_hat, but its energy is reported here, with that of the forces.
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const Term loads_term;

}  // namespace fettle::core::energy
