// SPDX-License-Identifier: MIT
/// Inside or outside of what triangles bound, exactly.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/half_edges.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

/// How often closed triangles wind round the point: 1 inside a solid, 0 outside and in a cavity, 2 where two solids of one mesh overlap,
/// -1 inside what is inside out. Exact: crossings of a ray, with their signs. nullopt: the point is on a triangle.
/// Contract: the triangles have no boundary (each directed edge has its reverse as often), or the number depends on the ray.
std::optional<int> winding_number(const Vector3& point, const Matrix3X& vertices, const std::vector<geometry::Triangle>& triangles);

/// Is the point strictly inside the material: is its winding number neither 0 nor undefined? The material of parts that overlap is their
/// union. (For containment of whole bodies.) Contract: as above.
bool point_in_solid(const Vector3& point, const Matrix3X& vertices, const std::vector<geometry::Triangle>& triangles);

/// One vertex of everything that hangs together in a mesh with connectivity: enough to tell inside from outside where surfaces do not
/// cross.
std::vector<int> samples_of(const geometry::Mesh& mesh);

/// Has every directed edge of the triangles its reverse, as often? Then inside and outside have a meaning, even where more than two
/// triangles meet in an edge. False without triangles.
bool bounds_a_solid(const geometry::Mesh& mesh);
bool bounds_a_solid(const std::vector<geometry::HalfEdge>& halves);

}  // namespace fettle::core::solids
