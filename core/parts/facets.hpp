// SPDX-License-Identifier: MIT
/// How curves become polygons, and so true surfaces facets: how many, and on which side of the true surface.
///
/// For an arc of radius r in steps of the angle delta:
/// - vertices on the circle leave it up to r (1 - cos(delta/2)) outside the polygon;
/// - flats that touch the circle, with vertices at r / cos(delta/2), leave it as much times 1 / cos(delta/2) inside. An arc that joins
///   other curves begins and ends on the circle: half a flat, whole ones, half a flat.
/// Curves that are neither line nor arc have their vertices on the curve, whatever the rule.
#pragma once

namespace fettle::core::parts {

/// Which side of the true surface the facets of an arc keep to.
enum class Lean {
    cover,   ///< the mesh covers the part: pins circumscribed, holes inscribed. Clearances of meshes are then at most those of the part
    within,  ///< the mesh lies within the part: pins inscribed, holes circumscribed. For what is cut away from a part that is covered
    through  ///< vertices on the true surface
};
/// The lean of what is cut away from a part with `lean`: cover <-> within.
Lean opposite(Lean lean);

struct Facets {
    /// Largest distance of a chord from its curve [m]; 0: `segments` counts instead.
    double chord = 0;
    /// Segments of a full circle; of an arc its share, and of other curves the share of a circle that they turn by, rounded up.
    /// At least 3, or the function that draws refuses them.
    int segments = 48;
    Lean lean = Lean::cover;
};

/// The most segments of one curve or turn. What would take more is drawn with so many, and its chord is not kept: who draws, refuses that.
inline constexpr int most_segments = 100'000;

/// Segments for an arc of `radius` [m] that turns by `angle` [rad]: the least number that keeps the chord, or by Facets::segments. At least
/// 1; whole circles take at least 3 and, by chord, a multiple of 4, which keeps polygons symmetric. Perhaps infinite.
double segments_wanted(const Facets& facets, double radius, double angle);
/// The same, and never more than most_segments.
int segments_of(const Facets& facets, double radius, double angle);

}  // namespace fettle::core::parts
