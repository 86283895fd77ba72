// SPDX-License-Identifier: MIT
/// Cross products that do not cancel: for normals of directions that are nearly parallel. Elsewhere Eigen's costs a fifth.
#pragma once

#include <cmath>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

/// a b - c d within 2 units in the last place (Kahan's difference of products); what fma rounds away is added back.
inline double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d, lost = std::fma(-c, d, cd);
    return std::fma(a, b, -cd) + lost;
}

/// a x b, each component within 2 units in the last place.
inline Vector3 accurate_cross(const Vector3& a, const Vector3& b) {
    return {difference_of_products(a.y(), b.z(), a.z(), b.y()), difference_of_products(a.z(), b.x(), a.x(), b.z()),
            difference_of_products(a.x(), b.y(), a.y(), b.x())};
}

}  // namespace fettle::core::geometry
