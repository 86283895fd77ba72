// SPDX-License-Identifier: MIT
/// Plane figures as files for laser and water jet cutters, in millimetres: lines and arcs as they are, so that a machine cuts round what is
/// round, other curves as lines within a chord tolerance (Beziers in SVG as they are).
#pragma once

#include <string>

#include "core/parts/profile.hpp"

namespace fettle::design::exports {

/// DXF of release 12, which every program reads: a closed POLYLINE for each loop, arcs by their bulges; whole circles are CIRCLEs. Layers
/// `outline` and `hole`. Contract: chord > 0 [m].
std::string profile_dxf(const core::parts::Profile& profile, double chord = 1e-5);

/// SVG whose size is the figure's in millimetres, x to the right and y up as in the part; one path, filled where there is material.
std::string profile_svg(const core::parts::Profile& profile, double chord = 1e-5);

}  // namespace fettle::design::exports
