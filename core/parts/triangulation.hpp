// SPDX-License-Identifier: MIT
/// Triangles of a plane region with holes: constrained Delaunay, by inserting points and flipping edges. Orientations are exact, so no
/// triangle is turned over or without area; the same region gives the same triangles. Used for end faces; no points are added.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::parts {

/// Loops of point indices with the region to their left: outlines counter-clockwise, holes clockwise. Every point is in a loop; in several,
/// or in one more than once, where loops touch.
struct PlaneRegion {
    std::vector<Vector2> points;
    std::vector<std::vector<int>> loops;
};

struct Triangulation {
    std::vector<geometry::Triangle> triangles;  ///< counter-clockwise; empty: a fault
    /// Two edges of loops, each by its points, that cross or touch (a point that lies on an edge, or on another point: with itself).
    std::optional<std::array<geometry::Edge, 2>> crossing;
};

/// A fault without `crossing`: loops that run the wrong way round, or no points.
Triangulation triangulated(const PlaneRegion& region);

/// Do triangles of an earlier region with the same loops fit this one: none is turned over or without area?
bool fits(const PlaneRegion& region, const std::vector<geometry::Triangle>& triangles);

}  // namespace fettle::core::parts
