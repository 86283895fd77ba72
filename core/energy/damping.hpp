// SPDX-License-Identifier: MIT
/// Resistance to the motion of single bodies in proportion to their mass, as a term of the incremental potential. With the end velocity
/// V = (P - P_slip)/slip_time of the integrator in use (time_integration.hpp) and C of damping_moments.hpp, its potential is
///   slip_time/2 tr(V C V^T),   times the weight  damping_weight/2 tr((P - P_slip) C (P - P_slip)^T).
/// docs/method/energy.md#integrators. Reports nothing.
#pragma once

#include "fettle/core/energy/damping_moments.hpp"
#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const BodyTerm damping_term;

}  // namespace fettle::core::energy
