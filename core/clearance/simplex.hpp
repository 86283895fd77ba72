// SPDX-License-Identifier: MIT
/// A step of Gilbert, Johnson and Keerthi's method: of which points of a simplex its point nearest to the origin is made.
#pragma once

#include <array>

#include "core/base/types.hpp"

namespace fettle::core::clearance {

struct SimplexPoint {
    Vector3 point = Vector3::Zero();
    std::array<double, 4> weight{};  ///< of the simplex's points; of four, all zero if they hold the origin
};

/// The nearest to the origin of the hull of the first `count` points. Contract: 1 to 4.
SimplexPoint nearest_to_origin(const std::array<Vector3, 4>& points, int count);

}  // namespace fettle::core::clearance
