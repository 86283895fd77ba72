// SPDX-License-Identifier: MIT
/// Curved surfaces in a mesh of patches: which patches are facets of one cylinder, cone, sphere or torus (docs/method/features.md).
#pragma once

#include <vector>

#include "core/features/patches.hpp"
#include "core/features/surface.hpp"

namespace fettle::core::features {

struct RegionOptions {
    double tolerance = 0;   ///< how far corners of facets may lie from their surface [m]
    double limit = 0;       ///< the most that two facets of one surface lean against each other [rad]
    bool is_noise = false;  ///< corners are known to be off by about the tolerance; else a few that are are no surface's
};

struct Region {
    Surface surface;
    bool hollow = false;       ///< the material is on the outside: a bore
    std::vector<int> patches;  ///< sorted
    double residual = 0;       ///< the largest distance of a corner that should lie on it [m]
    double area = 0;           ///< of its facets [m^2]
};

/// Regions have no patch in common. Patches in none of them are flat faces, or facets of what is no such surface (free_form.hpp).
std::vector<Region> curved_regions(const Patches& patches, const RegionOptions& options);

/// The corners of the facets that should lie on the surface, as far as it is known which: ends of creases within the region; of spheres and
/// tori those at no sharp edge, for a face may be cut within a facet. Sorted.
std::vector<int> corners_on(const Patches& patches, SurfaceKind kind, const std::vector<int>& members, double limit);

}  // namespace fettle::core::features
