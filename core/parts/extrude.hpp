// SPDX-License-Identifier: MIT
/// Solids from profiles that are moved along z.
#pragma once

#include <vector>

#include "core/parts/layer.hpp"
#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// Walls stand for planes and cylinders, with chamfers for planes and cones; other curves for extruded ones.
/// Errors: an empty profile, heights out of order ("`collar` has no height: 0 mm"), facets that cross each other (the number of segments is
/// too small for what is near), a chamfer larger than the solid it is cut from.
Result<Solid> extruded(Drawing& drawing, const Profile& profile, const Number& from, const Number& to, const End& lower = {},
                       const End& upper = {});

/// Layers stacked on each other, in order, without gaps: each begins where the one before ends (same value, or it is an error). They share
/// the faces between them: a crank is a collar, a disc and a pin. Each layer must touch the next in some area.
Result<Solid> stacked(Drawing& drawing, const std::vector<Layer>& layers);

}  // namespace fettle::core::parts
