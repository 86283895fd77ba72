// SPDX-License-Identifier: MIT
/// How far two closed solids are in each other at one instant: bounds of the depth and the volume of their common part. All bounds are
/// proven (for self-intersecting meshes: of the material as disjoint_solids.hpp has it); how close they are depends on a budget.
///   depth   the least distance by which one of them has to be moved, without turning, to part them.
///           From below: a ball of radius r inside both keeps them together for every move shorter than 2 r.
///           From above: the move along a direction that parts their convex hulls; the best of the axes and of many faces' normals. Where
///           that part is known, a move along a normal of its faces, as far as it is wide, and after which they are proven apart.
///   volume  that of the common part, cut exactly (parts/common_part.hpp), and how much rounding of the poses can change it. Where meshes
///           cannot be cut, cells of the common box are halved; those within both count for the lower bound, those not known to leave one
///           of them for the upper one, which is no more than the lesser body.
/// Inside or outside of a cell follows from the distance of its middle to the surface, which changes by at most what one moves.
#pragma once

#include <optional>

#include "core/certificate/disjoint_solids.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/clearance/piece_tree.hpp"
#include "core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

/// A body, for this.
struct SolidBody {
    const PieceTree& tree;
    const certificate::SolidMesh& solid;
};

/// By cells alone.
/// @param cells  how many cells are looked at, at most
/// @return       nothing if a body is not closed or has no triangles, or if their boxes are apart; times and places are relative to body
///               b's reference point: the caller knows where that is.
std::optional<Overlap> overlap_at(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s, int cells);

/// By an exact cut, where the meshes can be cut: closer, and a hundred times the work of a few cells. Nothing where the cut finds nothing
/// in common, too.
std::optional<Overlap> measured_overlap(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s, int cells);

}  // namespace fettle::core::clearance
