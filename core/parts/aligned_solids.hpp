// SPDX-License-Identifier: MIT
/// Two solids before they cut each other: coordinates that rounding alone tells apart become one, so that faces that were drawn to be flush
/// are, exactly. 1 mm + 8 x 1 mm is not 9 x 1 mm in floating point; a cut that is exact would keep the sliver in between.
#pragma once

#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// Along each axis, coordinates of both within usual_rounding of each other become the least of them, and those within it of 0 become 0.
/// Derivatives stay. What was moved, and how far, is added to Solid::rounding.
void align(Solid& a, Solid& b);

}  // namespace fettle::core::parts
