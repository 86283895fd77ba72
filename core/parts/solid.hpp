// SPDX-License-Identifier: MIT
/// A solid while it is drawn: a closed, outward oriented triangle mesh without T-junctions, whose vertices are recorded numbers, and the
/// true surfaces that its facets stand for. Made by extrude.hpp, revolve.hpp, helix.hpp; cut and united by solid_booleans.hpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"
#include "core/parts/drawing.hpp"
#include "core/parts/surface.hpp"

namespace fettle::core::parts {

using geometry::Deviation;

/// The rounding of vertices whose formulas are some tens of operations long, where the largest coordinate is so large [m].
inline double usual_rounding(double largest) { return 64 * 0x1p-52 * largest; }

struct Solid {
    std::vector<Point3> vertices;
    std::vector<geometry::Triangle> triangles;
    std::vector<Facet> facets;  ///< per triangle
    std::vector<Surface> surfaces;
    Deviation deviation;
    /// What vertices may be off by beyond the usual rounding (some tens of units in the last place of the largest coordinate) [m]: points
    /// where solids cut each other at small angles.
    double rounding = 0;
};

Solid moved(const Solid& solid, const Point3& by);
/// About the line through `about` along `axis`, which has any length but 0.
Solid turned(const Solid& solid, const Point3& axis, const Number& angle, const Point3& about = {});
/// In the plane through `point` with the normal `normal`.
Solid mirrored(const Solid& solid, const Point3& normal, const Point3& point = {});

/// Copies 0 .. count-1 turned by k * step about a line (by a full turn / count), moved by k * step.
std::vector<Solid> polar_copies(const Solid& solid, int count, const Point3& axis = {0, 0, 1}, const Point3& about = {});
std::vector<Solid> polar_copies(const Solid& solid, int count, const Number& step, const Point3& axis, const Point3& about);
std::vector<Solid> linear_copies(const Solid& solid, int count, const Point3& step);

/// One solid of several shells that do not touch each other, which is the caller's contract: validity (drawn_part.hpp) finds out.
/// Solids that meet are united (solid_booleans.hpp).
Solid together(const std::vector<Solid>& solids);

}  // namespace fettle::core::parts
