// SPDX-License-Identifier: MIT
/// One surface in several regions: a bore that a slot splits, two halves with a seam, a groove across.
#pragma once

#include <vector>

#include "core/features/regions.hpp"

namespace fettle::core::features {

/// Joins regions that one surface fits as well, to within the tolerance, with the material on the same side. Cylinders and cones are
/// joined along the axis over gaps of at most half the shorter one's length: the knuckles of a hinge stay as many bores.
std::vector<Region> merged_regions(const Patches& patches, std::vector<Region> regions, const RegionOptions& options);

/// From where to where the patch's corners reach along a direction.
struct Reach {
    double low = 0, high = 0;
};
Reach reach_along(const Patches& patches, int patch, const Vector3& direction);

}  // namespace fettle::core::features
