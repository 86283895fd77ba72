// SPDX-License-Identifier: MIT
/// Resistance to the motion of single bodies in proportion to their mass (scene::Damping), as a term of the incremental potential. With the
/// end velocity V = (P - P_slip)/slip_time of the integrator in use (time_integration.hpp), its potential is
///   slip_time/2 tr(V C V^T),   C = angular M + (linear - angular) M e4 (M e4)^T / m,
/// whose gradient is the force linear m v at the centre of mass and the torque angular I omega about it: the second part of C is the mass
/// gathered there, the rest the second moments about it. Times the weight: damping_weight/2 tr((P - P_slip) C (P - P_slip)^T).
/// docs/method.md section 3. Reports nothing.
#pragma once

#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

inline bool is_damped(const model::Body& body) { return body.damping.linear > 0 || body.damping.angular > 0; }

/// C [kg m^2/s, kg m/s, kg/s]. Contract: the body has mass.
Matrix4 damping_moments(const model::Body& body);

extern const Term damping_term;

}  // namespace fettle::core::energy
