// SPDX-License-Identifier: MIT
/// Is a mesh the boundary of a solid that can be made? Exact predicates decide; nothing depends on a tolerance.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mesh.hpp"
#include "core/solids/point_in_solid.hpp"
#include "core/solids/self_intersection.hpp"

namespace fettle::core::solids {

struct MeshRequirements {
    bool closed = true;  ///< every edge in exactly two triangles, each direction once; positive volume per solid
    bool no_self_intersection = true;
};

/// Every fault: non-finite vertices, index out of range, degenerate (exactly zero-area) triangles, open / non-manifold / wrongly oriented
/// edges, inside-out solids, intersecting triangles (which, and where). At most `max_per_kind` of each kind, then a count. Empty: valid.
/// `where` is "<mesh name>: triangle 12" and the like.
Errors validate_mesh(const geometry::Mesh& mesh, const MeshRequirements& requirements, int max_per_kind = 5);

bool is_closed(const geometry::Mesh& mesh);
bool is_closed(const std::vector<geometry::HalfEdge>& halves);  ///< the same of triangles whose indices are in range

/// Faults of the numbers alone, before anything else has a meaning: coordinates that are not finite, indices out of range.
Errors faults_of_numbers(const geometry::Mesh& mesh, int max_per_kind = 5);

}  // namespace fettle::core::solids
