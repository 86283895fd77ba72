// SPDX-License-Identifier: MIT
/// Rotations as scene files write them: three angles, or a rotation vector.
#pragma once

#include "core/base/types.hpp"

namespace fettle::core::scene {

double radians(double degrees);

/// R = Rz(c) Ry(b) Rx(a) for [a, b, c] in degrees; exact for multiples of 90.
Matrix3 rotation_from_degrees(const Vector3& angles);

/// A rotation as it was written.
struct Orientation {
    enum class Kind {
        angles,  ///< R = Rz(c) Ry(b) Rx(a)
        vector   ///< R = exp([x])
    };
    Kind kind = Kind::angles;
    Vector3 numbers = Vector3::Zero();  ///< [a, b, c] or x [rad]
};
Matrix3 rotation_of(const Orientation& orientation);
/// dR = [W d(numbers)]x R: the axes, in the world, about which each number turns.
Matrix3 rotation_axes(const Orientation& orientation);

}  // namespace fettle::core::scene
