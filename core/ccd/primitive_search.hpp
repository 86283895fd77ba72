// SPDX-License-Identifier: MIT
/// Which primitives of two bodies may come close along their segments.
#pragma once

#include <array>
#include <vector>

#include "core/ccd/swept_pair.hpp"
#include "core/geometry/primitive_pair.hpp"

namespace fettle::core::ccd {

/// A node of the hierarchy of a and one of b.
using NodePair = std::array<int, 2>;

/// Pairs of nodes that hold all that may come close, and no pair of elements twice: about `most` of them, or fewer where little is close.
std::vector<NodePair> close_nodes(const SweptPair& pair, std::size_t most);

/// Appends to the lists of `out` every pair of primitives below `from` that may come within pair.margin along the segments, with lower
/// bounds of their distances: proven ones, by a plane that separates the pair at both ends (four_separations.hpp); -infinity where nothing
/// is finite. Without pairs of edges of which one is left out (SweptPair::plane_a).
void search_primitives(const SweptPair& pair, const NodePair& from, geometry::PrimitivePairs& out);

/// Works out the distances of pairs that are known anew, along these segments, and drops those that do not come within pair.margin.
/// For lists of few pairs beside those that a search looks at.
void search_again(const SweptPair& pair, geometry::PrimitivePairs& pairs);

}  // namespace fettle::core::ccd
