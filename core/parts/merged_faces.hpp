// SPDX-License-Identifier: MIT
/// What a cut leaves of a flat face is many triangles, with corners where diagonals of one solid cross edges of the other: corners that are
/// none of the result's, which rounding moves off their lines and which grow from cut to cut. Here a face becomes one again.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {

/// The cut with the pieces of each flat face put together, triangulated anew between their edges. A corner within a face is left out, and
/// one on a straight stretch of the edge between two faces. A face that cannot be triangulated leaves all as it was.
/// @param face_of_a  Per triangle of the mesh: which flat face it is of; -1: of none, and it is a face by itself. The same of b.
/// @param points     Where the corners of the cut are.
/// @param rounding   What they may be off by [m].
SolidCut with_merged_faces(SolidCut cut, const std::vector<int>& face_of_a, const std::vector<int>& face_of_b,
                           const std::vector<Vector3>& points, double rounding);

}  // namespace fettle::core::parts
