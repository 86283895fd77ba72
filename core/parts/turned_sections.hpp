// SPDX-License-Identifier: MIT
/// A section that turns about z while it rises: what twisted extrusions (extrude.hpp) and helices (helix.hpp) have in common.
#pragma once

#include <vector>

#include "core/parts/faceted_profile.hpp"
#include "core/parts/solid_builder.hpp"

namespace fettle::core::parts {

/// Where the section is drawn: in the plane of x and y, or in the half plane through the z axis, x = distance from it, y = z.
enum class SectionPlane { across, through_axis };

/// Sections at `steps` + 1 even stations, joined edge by edge, with plane ends.
/// @param angle, rise  Over all steps. @param section  Polygons; their edges stand for helical surfaces.
/// Deviation: nodes are on the surface S(s, t) of the polygon's edges, of which |S - linear interpolation| <=
/// (2 |S_st| + |S_tt|) / 8 per step, since edges are straight in s; what curves leave their edges by is added.
Result<Solid> turned_section(Drawing& drawing, const FacetedProfile& section, SectionPlane plane, const Number& from, const Number& angle,
                             const Number& rise, int steps, const std::string& feature);

}  // namespace fettle::core::parts
