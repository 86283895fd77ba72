// SPDX-License-Identifier: MIT
/// Angles in degrees, as both scene formats write them.
#pragma once

#include "fettle/core/base/types.hpp"

namespace fettle::core::scene {

double radians(double degrees);

/// R = Rz(c) Ry(b) Rx(a) for [a, b, c] in degrees; exact for multiples of 90.
Matrix3 rotation_from_degrees(const Vector3& angles);

}  // namespace fettle::core::scene
