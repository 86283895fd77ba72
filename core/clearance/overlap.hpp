// SPDX-License-Identifier: MIT
/// How far two closed solids are in each other at one instant: bounds of the depth and of the volume of what they share. All bounds are
/// proven (for self-intersecting meshes: of the material as disjoint_solids.hpp has it); how close they are depends on a budget.
///   depth   the least distance by which one of them has to be moved, without turning, to part them.
///           From below: a ball of radius r inside both keeps them together for every move shorter than 2 r.
///           From above: the move along a direction that parts their convex hulls; the best of the axes and of many faces' normals.
///   volume  cells of the common box are halved; those within both count for the lower bound, those not known to leave one of them for the
///           upper one.
/// Inside or outside of a cell follows from the distance of its middle to the surface, which changes by at most what one moves.
#pragma once

#include <optional>

#include "fettle/core/certificate/disjoint_solids.hpp"
#include "fettle/core/clearance/piece_tree.hpp"
#include "fettle/core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

struct Overlap {
    double depth_lower = 0, depth_upper = 0;    ///< [m]; depth_lower > 0 proves that the solids overlap
    double volume_lower = 0, volume_upper = 0;  ///< [m^3]
    double time = 0;                            ///< [s]
    Vector3 center = Vector3::Zero();           ///< of the largest ball found in both, world [m]; of no meaning if depth_lower is 0
};

/// A body, for this.
struct SolidBody {
    const PieceTree& tree;
    const certificate::SolidMesh& solid;
};

/// @param cells  how many cells are looked at, at most
/// @return       nothing if a body is not closed or has no triangles, or if their boxes are apart; times and places are relative to body
///               b's reference point: the caller knows where that is.
std::optional<Overlap> overlap_at(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s, int cells);

}  // namespace fettle::core::clearance
