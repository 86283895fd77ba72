// SPDX-License-Identifier: MIT
/// Where edges of two solids meet to within rounding, an exact cut has two corners for one, an atom apart: as doubles they are one point,
/// or lie in another order along an edge. Here such corners become one.
#pragma once

#include <vector>

#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {

/// The cut with edges of at most `shortest` drawn together to one of their ends: of the corners that so become one, that with the largest
/// `worth`. Triangles that this leaves without a third corner are left out, and two that then lie on each other back to back; of one that
/// is no higher than `shortest` the middle corner goes into the neighbour across its longest side.
/// @param worth  per corner: how well its place is known by its formula
/// Contract: SolidCut::points are there.
SolidCut without_short_edges(SolidCut cut, const std::vector<double>& worth, double shortest);

}  // namespace fettle::core::parts
