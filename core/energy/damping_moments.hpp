// SPDX-License-Identifier: MIT
/// The resistance to a damped body's motion (scene::Damping): with Pdot = V its force and arm are those of V C,
///   C = angular M + (linear - angular) M e4 (M e4)^T / m,
/// the force linear m v at the centre of mass and the torque angular I omega about it: the second part of C is the mass gathered there, the
/// rest the second moments about it. As a term of the incremental potential: body_terms.hpp. docs/method/energy.md#integrators.
#pragma once

#include "core/model/model.hpp"

namespace fettle::core::energy {

inline bool is_damped(const model::Body& body) { return body.damping.linear > 0 || body.damping.angular > 0; }

/// C [kg m^2/s, kg m/s, kg/s]. Contract: the body has mass.
inline Matrix4 damping_moments(const model::Body& body) {
    const scene::Damping& c = body.damping;
    const Eigen::Vector4d first = body.moments.col(3);
    return c.angular * body.moments + (c.linear - c.angular) / first[3] * first * first.transpose();
}

}  // namespace fettle::core::energy
