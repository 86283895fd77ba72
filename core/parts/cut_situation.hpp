// SPDX-License-Identifier: MIT
/// How two meshes lie to each other, before one cuts the other (solid_booleans.hpp).
#pragma once

#include <array>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {

using TriangleCorners = std::array<Vector3, 3>;
TriangleCorners corners_of(const geometry::Mesh& mesh, int triangle);

/// All that decides how two meshes cut each other, but for where: how many triangles meet, which sides of them go through which, and which
/// shells that do not meet the other mesh are inside of it.
std::vector<int> situation_of(const geometry::Mesh& a, const geometry::Mesh& b);

/// Would meshes that do not meet do so, but for rounding?
bool touch(const geometry::Mesh& a, const geometry::Mesh& b, double rounding);

/// The whole shells of meshes that do not meet which make up their combination.
SolidCut shells_of(const geometry::Mesh& a, const geometry::Mesh& b, Combination combination);

}  // namespace fettle::core::parts
