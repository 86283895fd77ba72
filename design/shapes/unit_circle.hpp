// SPDX-License-Identifier: MIT
/// Points of the unit circle with exact symmetry, and what a polygon in place of a circle means for clearances.
///
/// Convention of all generators, for a circle of nominal radius R with N segments:
/// - a pin (outer surface) is inscribed: its vertices lie at R;
/// - a bore (inner surface) is circumscribed: its flats are at R, its vertices at R / cos(pi/N).
/// So a pin of radius r, concentric in a bore of radius R, keeps at least R - r at every angle between the two, exactly R - r
/// where a vertex of the pin faces the middle of a flat. The clearance that is certified, as assembled and concentric, is never less than
/// the nominal one.
#pragma once

#include <array>
#include <vector>

namespace fettle::design::shapes {

/// (cos, sin)(2 pi i / N), i = 0 .. N-1; exact at multiples of 90 degrees and exactly symmetric about both axes and the diagonals.
/// Contract: segments is a positive multiple of 4.
std::vector<std::array<double, 2>> unit_circle(int segments);

/// cos(pi / N): distance of the flats over distance of the vertices.
double flat_ratio(int segments);

}  // namespace fettle::design::shapes
