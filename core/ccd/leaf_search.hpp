// SPDX-License-Identifier: MIT
/// Which primitives of close leaves come close themselves.
#pragma once

#include <vector>

#include "fettle/core/ccd/swept_pair.hpp"
#include "fettle/core/geometry/primitive_pair.hpp"

namespace fettle::core::ccd {

/// Appends to the lists of `out` every pair of primitives of the given pairs of leaves that may come within pair.margin along the
/// segments, with lower bounds of their distances: proven ones, by a plane that separates the pair at both ends (four_separations.hpp);
/// -infinity where nothing is finite. Without pairs of edges of which one is left out (SweptPair::plane_a). Contract: no pair of leaves
/// comes twice.
void search_leaves(const SweptPair& pair, const std::vector<NodePair>& leaves, geometry::PrimitivePairs& out);

}  // namespace fettle::core::ccd
