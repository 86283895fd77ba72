// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/mesh.hpp"

namespace fettle::tests::support {

/// Axis-aligned box [low, high], outward oriented, 8 vertices, 12 triangles; vertex i is at high where bit 0, 1, 2 of i is set for x, y, z.
inline core::geometry::Mesh box_mesh(const Vector3& low, const Vector3& high) {
    Matrix3X v(3, 8);
    for (int i = 0; i < 8; ++i) v.col(i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
    return core::geometry::make_mesh("box", v,
                                     {{0, 2, 3},
                                      {0, 3, 1},
                                      {4, 5, 7},
                                      {4, 7, 6},
                                      {0, 1, 5},
                                      {0, 5, 4},
                                      {2, 6, 7},
                                      {2, 7, 3},
                                      {0, 4, 6},
                                      {0, 6, 2},
                                      {1, 3, 7},
                                      {1, 7, 5}});
}

}  // namespace fettle::tests::support
