// SPDX-License-Identifier: MIT
/// A rotation that goes on at a constant rate, as a path of rotation vectors: continuous, where the logarithm would jump at half a turn.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::stepper {

struct RotationNode {
    double s = 1;
    Vector3 theta = Vector3::Zero();
};

/// Nodes after s = 0, the last at s = 1, such that exp of the polygon from `theta` through them follows exp(s [turn]) exp([theta]) to 1e-4
/// rad at every s. One node where `turn` is parallel to `theta` or either is zero: then it follows exactly.
/// exp has no derivative across |theta| = 2 pi k, k >= 1: a path that turns aside there goes round that sphere, where the rotation rests.
std::vector<RotationNode> lifted_turn(const Vector3& theta, const Vector3& turn);

}  // namespace fettle::core::stepper
