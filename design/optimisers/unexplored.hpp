// SPDX-License-Identifier: MIT
/// Directions of which a first-order verdict knows nothing. Where a point is symmetric, a step across the symmetry changes nothing to first
/// order, and a search that begins there never leaves it, though the point may be a saddle: a lever that lies along its housing's middle
/// could be longer aslant.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::optimisers {

/// Unit vectors, orthogonal to each other, the columns, that keep what holds a point to within a tenth of its slope.
/// @param holding  k x n: gradients of what holds it (constraints, bounds), of any length but 0.
MatrixX free_directions(const MatrixX& holding);

/// Unit vectors, orthogonal to each other, which keep what holds a point to within a tenth of its slope, and along which the known points
/// reach less than 0.03 of the ranges; the least known first.
/// @param holding  k x n: gradients of what holds the point (constraints, bounds), of any length but 0.
/// @param steps    m x n: from the point to the known ones near it.
/// @param most     At most so many.
std::vector<VectorX> unexplored_directions(const MatrixX& holding, const MatrixX& steps, int most);

}  // namespace fettle::design::optimisers
