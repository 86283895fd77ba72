// SPDX-License-Identifier: MIT
/// A rigid body's mass matrix (kinematics/mass_matrix.hpp), as the terms name it.
#pragma once

#include "fettle/core/kinematics/mass_matrix.hpp"

namespace fettle::core::energy {

using kinematics::mass_matrix;

}  // namespace fettle::core::energy
