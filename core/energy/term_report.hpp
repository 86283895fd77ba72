// SPDX-License-Identifier: MIT
/// What the terms of the incremental potential report about a step that is solved: energies, momenta, forces between bodies.
#pragma once

#include <vector>

#include "fettle/core/base/types.hpp"

namespace fettle::core::energy {

/// Between two bodies, at the end of a step.
struct ContactForce {
    int a = 0, b = 0;                    ///< a < b
    Vector3 force = Vector3::Zero();     ///< on a, friction included, world [N]
    Vector3 torque = Vector3::Zero();    ///< on a, about the world's origin [N m]
    double normal = 0;                   ///< sum of the contacts' normal forces [N]
    Vector3 friction = Vector3::Zero();  ///< on a [N]
    double distance = 0;                 ///< least of the contacts' [m]
    int contacts = 0;
};

struct TermReport {
    double kinetic_energy = 0;                   ///< of the bodies with mass [J]
    double potential_energy = 0;                 ///< of gravity and constant forces, zero at the world's origin [J]
    double contact_energy = 0;                   ///< of the barrier [J]
    Vector3 linear_momentum = Vector3::Zero();   ///< [kg m/s]
    Vector3 angular_momentum = Vector3::Zero();  ///< about the world's origin [kg m^2/s]
    std::vector<ContactForce> contacts;          ///< by (a, b)
    double spring_energy = 0;                    ///< of springs and stops [J]
    double supplied_power = 0;             ///< by what is no potential: motors, prescribed coordinates, forces along measures, torques [W]
    double dissipated_power = 0;           ///< by friction of contacts and joints, dampers, damping of bodies and contacts [W]
    std::vector<double> measure_forces{};  ///< per term of the mechanism: force or torque along its measure [N], [N m]
};

/// The entry of these two bodies, in either order; made where there is none. Valid until the next one is made.
ContactForce& force_between(TermReport& report, int first, int second);

}  // namespace fettle::core::energy
