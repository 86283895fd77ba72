// SPDX-License-Identifier: MIT
/// Triangles of one mesh that cross each other, exactly. In linear time for a usual mesh, on several threads.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

/// Pairs of triangles of one mesh that intersect other than in a shared vertex or edge, the smaller index first, in order. Triangles
/// without area are left out: they are faults of their own. Exact. Where there are `max_count` or more, that many of them: which depends on
/// the mesh alone. Contract: vertex indices in range, coordinates finite.
std::vector<std::pair<int, int>> self_intersections(const geometry::Mesh& mesh, int max_count);

/// Exact test of two triangles in space (touching counts as intersecting).
bool triangles_intersect(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b);

/// For each triangle: are its corners on one line (exactly)? Contract: vertex indices in range, coordinates finite.
std::vector<char> triangles_without_area(const geometry::Mesh& mesh);

}  // namespace fettle::core::solids
