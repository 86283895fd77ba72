// SPDX-License-Identifier: MIT
/// Face of a flat link: two round ends, straight sides, a ring about the axis of each end. What a ring leads to is its caller's:
/// the wall of a bore (rod, coupler), the side of a pin, a cap in the face's plane (arm).
///
///          left_top ________ right_top
///       .-'                     '-.
///      ( (ring)                (ring) )      --> x, z towards the viewer
///       '-. _____________________.-'
///          left_bottom      right_bottom
#pragma once

#include "fettle/design/shapes/shape_definition.hpp"

namespace fettle::design::shapes {

/// Outline of a link from the big end's axis at (origin_x, origin_y) to the small end's, at (origin_x + length, origin_y) [m]. The
/// straight sides touch both ends at 90 and 270 degrees. "Big" and "small" are names: either may be the wider one.
struct LinkOutline {
    DimensionDual length, big_end_radius, small_end_radius;
    DimensionDual origin_x = 0, origin_y = 0;
};

/// Half-width of the link at the two points of each side from which the inner quadrants of the rings are fanned: big_end_radius from
/// the big end's axis, small_end_radius from the small end's. A ring keeps inside the sides if its vertices' radius is less.
DimensionDual half_width_near_big_end(const LinkOutline& outline);
DimensionDual half_width_near_small_end(const LinkOutline& outline);

struct LinkFace {
    Ring big_ring, small_ring;
    Ring big_arc, small_arc;  ///< ends of the outline, counter-clockwise: 90 to 270 and 270 to 450 degrees
    int left_top = 0, left_bottom = 0, right_top = 0, right_bottom = 0;

    /// Counter-clockwise; from right_top to left_top over the vertices `between`, if any.
    Ring outline(const Ring& between = {}) const;
};

/// @param big_ring, small_ring  Radii of the rings' vertices [m].
LinkFace add_link_face_vertices(const LinkOutline& outline, const DimensionDual& big_ring, const DimensionDual& small_ring,
                                const DimensionDual& z, ShapeBuilder& builder);

/// Triangles between the outline and the rings. Valid for rings inside the outline (half_width_near_big_end) and ends apart.
void add_link_face(const LinkFace& face, Facing facing, ShapeBuilder& builder);

}  // namespace fettle::design::shapes
