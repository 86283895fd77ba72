// SPDX-License-Identifier: MIT
/// Is a mesh the boundary of a solid that can be made? Exact predicates decide; nothing depends on a tolerance.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/geometry/mesh.hpp"
#include "fettle/core/geometry/point_in_solid.hpp"

namespace fettle::core::geometry {

struct MeshRequirements {
    bool closed = true;  ///< every edge in exactly two triangles, each direction once; positive volume per solid
    bool no_self_intersection = true;
};

/// Every fault: non-finite vertices, index out of range, degenerate (exactly zero-area) triangles, open / non-manifold / wrongly oriented
/// edges, inside-out solids, intersecting triangles (which, and where). At most `max_per_kind` of each kind, then a count. Empty: valid.
/// `where` is "<mesh name>: triangle 12" and the like.
Errors validate_mesh(const Mesh& mesh, const MeshRequirements& requirements, int max_per_kind = 5);

bool is_closed(const Mesh& mesh);

/// Pairs of triangles of one mesh that intersect other than in a shared vertex or edge. Exact.
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, int max_count);

/// Exact test of two triangles in space (touching counts as intersecting).
bool triangles_intersect(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b);

}  // namespace fettle::core::geometry
