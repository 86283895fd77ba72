// SPDX-License-Identifier: MIT
/// A profile as polygons: what solids are made of.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/drawing.hpp"
#include "core/parts/profile.hpp"
#include "core/parts/surface.hpp"
#include "core/parts/triangulation.hpp"

namespace fettle::core::parts {

/// What polygon edges stand for.
struct FacetedCurve {
    Curve curve;
    std::string feature;
    double out = 0, in = 0;  ///< the curve is so far outside, inside of its polygon [m]
    bool proven = true;
};

/// Material to the left. Edge k runs from point k to the next.
struct FacetedLoop {
    std::vector<Point2> points;
    std::vector<int> curve;  ///< per edge: index into FacetedProfile::curves
};

struct FacetedProfile {
    std::vector<FacetedLoop> loops;
    std::vector<FacetedCurve> curves;

    std::size_t point_count() const;
};

/// Numbers of segments are decisions of the drawing. Errors: an empty profile; fewer than 3 segments.
Result<FacetedProfile> faceted(Drawing& drawing, const Profile& profile);

/// The polygons' points, numbered through, in place.
PlaneRegion region_of(const FacetedProfile& profile);

/// Triangles between the polygons, as indices of region_of's points; a decision of the drawing, called "end face of `...`".
/// Errors: polygons that cross or touch, by the names of their curves.
Result<std::vector<geometry::Triangle>> face_triangles(Drawing& drawing, const FacetedProfile& profile, const std::string& feature);

/// Polygons that cross or touch, where no end face is needed.
std::optional<Error> face_fault(const FacetedProfile& profile);

/// Which side the true surface is on for so much outside, inside.
Side side_of(double out, double in);

}  // namespace fettle::core::parts
