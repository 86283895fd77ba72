// SPDX-License-Identifier: MIT
/// Which pieces of round surfaces (geometry/round_surfaces.hpp) of two bodies are near each other, as their primitives' candidates say.
#pragma once

#include <vector>

#include "core/geometry/primitive_pair.hpp"
#include "core/model/model.hpp"

namespace fettle::core::ccd {

/// The corners and rectangles of one side of each of two bodies that are near the other's, ascending.
struct SidePieces {
    int side_a = 0, side_b = 0;  ///< into RoundSurfaces::sides
    std::vector<int> corners_a, rectangles_a, corners_b, rectangles_b;
};

/// The pieces of all sides that are near each other and not both without round corners, by (side_a, side_b). A corner that a candidate has
/// is near with its neighbours, so that the arc or plane is among them which is nearest there. Without Model::facet_sides. Empty where one
/// of the bodies has no round surfaces.
std::vector<SidePieces> side_pieces(const model::Model& model, int a, int b, const geometry::PrimitivePairs& candidates);

}  // namespace fettle::core::ccd
