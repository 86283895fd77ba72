// SPDX-License-Identifier: MIT
/// A mesh from what a file has: vertices that may stand in it several times. The rest of connectivity is mesh.hpp's.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Vertices with exactly equal coordinates (-0 equals +0) merged in the order of first occurrence, triangles without those that become
/// degenerate by index, connectivity built; shells are called "name/0", "name/1", ...
/// @param edges  Beside those of the triangles; those that become points are dropped.
/// Contract: indices in range.
Mesh welded_mesh(std::string name, const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Edge>& edges);

}  // namespace fettle::core::geometry
