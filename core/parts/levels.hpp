// SPDX-License-Identifier: MIT
/// A layer of an extrusion (extrude.hpp) as polygons at heights, from below; neighbours are joined edge by edge.
#pragma once

#include <string>
#include <vector>

#include "core/parts/faceted_profile.hpp"
#include "core/parts/layer.hpp"

namespace fettle::core::parts {

struct Level {
    FacetedProfile polygons;
    Number z;
    bool straight_above = true;  ///< the outline at the next level is the same
};

/// Errors: as of extruded.
Result<std::vector<Level>> levels_of(Drawing& drawing, const Layer& layer);

/// The name of a layer, or else of its profile.
const std::string& name_of(const Layer& layer);

}  // namespace fettle::core::parts
