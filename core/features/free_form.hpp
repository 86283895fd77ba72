// SPDX-License-Identifier: MIT
/// What of a mesh is no plane, cylinder, cone, sphere or torus. A few facets of any smooth surface lie on some torus to within a tolerance;
/// so a region counts only if it ends where a surface ends: at sharp edges, or at other surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "core/features/regions.hpp"

namespace fettle::core::features {

/// Drops regions that go on smoothly, along more than a third of their border, into facets of no surface.
/// @return  1 per patch that is a facet of none of the kinds
std::vector<std::uint8_t> drop_unbounded(const Patches& patches, std::vector<Region>& regions, const RegionOptions& options);

}  // namespace fettle::core::features
