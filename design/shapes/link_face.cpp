// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/link_face.hpp"

namespace fettle::design::shapes {
namespace {

// `x` is measured from the big end's axis.
DimensionDual link_half_width(const LinkOutline& o, const DimensionDual& x) {
    return o.big_end_radius + (o.small_end_radius - o.big_end_radius) * (x / o.length);
}

// Points of a ring over the same angles as the end arc that starts at `first`.
Ring ring_arc(const Ring& ring, int first) {
    const int n = count_of(ring);
    Ring arc;
    for (int i = first; i <= first + n / 2; ++i) arc.push_back(ring[i % n]);
    return arc;
}

void add_link_end(const Ring& arc, const Ring& ring_half, Facing facing, ShapeBuilder& builder) {
    if (facing == Facing::forward) {
        builder.add_open_strip(arc, ring_half);
    } else {
        builder.add_open_strip(ring_half, arc);
    }
}

}  // namespace

DimensionDual half_width_near_big_end(const LinkOutline& outline) { return link_half_width(outline, outline.big_end_radius); }

DimensionDual half_width_near_small_end(const LinkOutline& outline) {
    return link_half_width(outline, outline.length - outline.small_end_radius);
}

Ring LinkFace::outline(const Ring& between) const {
    Ring ring = big_arc;
    ring.insert(ring.end(), {left_bottom, right_bottom});
    ring.insert(ring.end(), small_arc.begin(), small_arc.end());
    ring.push_back(right_top);
    ring.insert(ring.end(), between.begin(), between.end());
    ring.push_back(left_top);
    return ring;
}

LinkFace add_link_face_vertices(const LinkOutline& o, const DimensionDual& big_ring, const DimensionDual& small_ring,
                                const DimensionDual& z, ShapeBuilder& builder) {
    const int n = builder.segments();
    const DimensionDual &x0 = o.origin_x, &y0 = o.origin_y;
    const DimensionDual x1 = x0 + o.length, left_x = x0 + o.big_end_radius, right_x = x1 - o.small_end_radius;
    const DimensionDual left_width = half_width_near_big_end(o), right_width = half_width_near_small_end(o);
    LinkFace face;
    face.big_ring = builder.add_ring({.along = z, .radius = big_ring, .centre_u = x0, .centre_v = y0});
    face.small_ring = builder.add_ring({.along = z, .radius = small_ring, .centre_u = x1, .centre_v = y0});
    face.big_arc = builder.add_arc({.along = z, .radius = o.big_end_radius, .centre_u = x0, .centre_v = y0}, n / 4, 3 * n / 4);
    face.small_arc = builder.add_arc({.along = z, .radius = o.small_end_radius, .centre_u = x1, .centre_v = y0}, 3 * n / 4, 5 * n / 4);
    face.left_top = builder.add_vertex({left_x, y0 + left_width, z});
    face.left_bottom = builder.add_vertex({left_x, y0 - left_width, z});
    face.right_top = builder.add_vertex({right_x, y0 + right_width, z});
    face.right_bottom = builder.add_vertex({right_x, y0 - right_width, z});
    return face;
}

void add_link_face(const LinkFace& f, Facing facing, ShapeBuilder& builder) {
    const int n = builder.segments();
    const auto big = [&](int i) { return f.big_ring[i]; };
    const auto small = [&](int i) { return f.small_ring[i]; };
    add_link_end(f.big_arc, ring_arc(f.big_ring, n / 4), facing, builder);
    builder.add_quadrant_outside(f.left_top, f.big_ring, 0, facing);
    builder.add_quadrant_outside(f.left_bottom, f.big_ring, 3, facing);
    builder.add_triangle(f.left_top, f.big_arc.front(), big(n / 4), facing);
    builder.add_triangle(f.left_bottom, big(3 * n / 4), f.big_arc.back(), facing);
    builder.add_triangle(f.left_top, big(0), f.left_bottom, facing);

    builder.add_quadrilateral(f.left_bottom, f.right_bottom, f.right_top, f.left_top, facing);

    add_link_end(f.small_arc, ring_arc(f.small_ring, 3 * n / 4), facing, builder);
    builder.add_quadrant_outside(f.right_top, f.small_ring, 1, facing);
    builder.add_quadrant_outside(f.right_bottom, f.small_ring, 2, facing);
    builder.add_triangle(f.right_top, small(n / 4), f.small_arc.back(), facing);
    builder.add_triangle(f.right_bottom, f.small_arc.front(), small(3 * n / 4), facing);
    builder.add_triangle(f.right_top, f.right_bottom, small(n / 2), facing);
}

}  // namespace fettle::design::shapes
