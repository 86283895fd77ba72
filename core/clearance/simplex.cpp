// SPDX-License-Identifier: MIT
#include "core/clearance/simplex.hpp"

#include <Eigen/Geometry>

#include "core/geometry/distance.hpp"

namespace fettle::core::clearance {

SimplexPoint nearest_to_origin(const std::array<Vector3, 4>& x, int count) {
    SimplexPoint nearest;
    if (count == 1) {
        nearest.point = x[0];
        nearest.weight[0] = 1;
        return nearest;
    }
    // The last one is repeated where there are fewer than three.
    const auto of_triangle = [&](int i, int j, int k) {
        const geometry::ClosestPoints closest = geometry::point_triangle_closest(Vector3::Zero(), x[i], x[j], x[k]);
        SimplexPoint found;
        found.point = -closest.difference;
        found.weight[i] -= closest.weight[1];
        found.weight[j] -= closest.weight[2];
        found.weight[k] -= closest.weight[3];
        return found;
    };
    if (count <= 3) return of_triangle(0, 1, count - 1);
    bool outside = false;
    double least = 0;
    for (const auto& [i, j, k, other] : {std::array{0, 1, 2, 3}, std::array{0, 1, 3, 2}, std::array{0, 2, 3, 1}, std::array{1, 2, 3, 0}}) {
        const Vector3& origin = x[i];
        const Vector3 normal = (x[j] - origin).cross(x[k] - origin);
        const double inside = normal.dot(x[other] - origin);
        if (normal.dot(-origin) * inside > 0) continue;
        const SimplexPoint found = of_triangle(i, j, k);
        const double squared = found.point.squaredNorm();
        if (outside && !(squared < least)) continue;
        outside = true;
        least = squared;
        nearest = found;
    }
    return nearest;
}

}  // namespace fettle::core::clearance
