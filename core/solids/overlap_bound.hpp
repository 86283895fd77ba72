// SPDX-License-Identifier: MIT
/// What self-intersections can do to a volume. The signed volume of a mesh counts a place as often as the surface winds round it; the
/// solid that is meant has it once. This bounds the difference.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

/// |signed volume - volume of the union| <= the result [m^3], up to rounding. nullopt: it could not be bounded.
///   - Triangles of no pair, joined over shared edges, are patches: no other surface crosses them, so one place decides what their sides
///   are.
///     Where that is not outside (0) and inside (1), the patch is as doubtful as the triangles of pairs. A place that is wound otherwise
///     lies in the boxes of doubtful triangles, joined where they overlap, and at most as often as such a box has triangles: the sum of box
///     volume times count.
///   - If only different shells cross: all but the largest shell's volume, if that is less.
/// @param pairs  All of self_intersections(mesh). Contract: bounds_a_solid(mesh).
std::optional<double> overlap_volume_bound(const geometry::Mesh& mesh, const std::vector<std::pair<int, int>>& pairs);

}  // namespace fettle::core::solids
