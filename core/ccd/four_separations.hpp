// SPDX-License-Identifier: MIT
/// Lower bounds of the distances of four pairs of primitives at once, along straight motions: what a search for candidates does thousands
/// of times. Each by one plane, normal to the difference of the closest points half-way, that separates the pair at both ends; why that is
/// certain, rounding included: linear_ccd.hpp. The four share nothing but the instructions.
#pragma once

#include <array>

#include "core/base/four.hpp"
#include "core/geometry/primitive_pair.hpp"

namespace fettle::core::ccd {

/// A vertex at the start of a motion and at its end, x y z each.
using SweptVertex = std::array<double, 6>;

/// [vertex of the pair, as in geometry::PairVertices][pair].
using FourPairs = std::array<std::array<const SweptVertex*, base::lanes>, 4>;

/// All four pairs are of one type. @return per pair [m]: the primitives are nowhere on the way nearer than that, 0 where no plane says so
/// (they are next to each other, move a long way, or something is not finite).
/// A pair whose distance is far below its size, or nearly parallel edges, may get less than the planes of separating_plane.hpp would give.
std::array<double, base::lanes> four_separations(geometry::PairType type, const FourPairs& x);

}  // namespace fettle::core::ccd
