// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/engine_parts.hpp"

namespace fettle::design::shapes {
namespace {

// x and half-width of the two points on each straight side from which the inner quadrants of the bores are fanned.
struct SidePoint {
    DimensionDual x, half_width;
};

DimensionDual half_width_at(const Dimensions& d, const DimensionDual& x) {
    const DimensionDual& big = d.at("big_end_radius");
    return big + (d.at("small_end_radius") - big) * (x / d.at("rod_length"));
}

SidePoint side_point_near_big_end(const Dimensions& d) {
    const DimensionDual& x = d.at("big_end_radius");
    return {x, half_width_at(d, x)};
}

SidePoint side_point_near_small_end(const Dimensions& d) {
    const DimensionDual x = d.at("rod_length") - d.at("small_end_radius");
    return {x, half_width_at(d, x)};
}

// One of the two faces: a big end, a small end, and the trapezium between the side points.
struct RodFace {
    Ring big_bore, small_bore;
    Ring big_arc, small_arc;  // ends of the outline, counter-clockwise: 90 to 270 and 270 to 450 degrees
    int left_top = 0, left_bottom = 0, right_top = 0, right_bottom = 0;

    Ring outline() const {
        Ring ring = big_arc;
        ring.insert(ring.end(), {left_bottom, right_bottom});
        ring.insert(ring.end(), small_arc.begin(), small_arc.end());
        ring.insert(ring.end(), {right_top, left_top});
        return ring;
    }
};

RodFace add_face_vertices(const Dimensions& d, const DimensionDual& z, ShapeBuilder& builder) {
    const int n = builder.segments();
    const double bore_scale = 1 / flat_ratio(n);
    const DimensionDual& length = d.at("rod_length");
    const SidePoint left = side_point_near_big_end(d), right = side_point_near_small_end(d);
    RodFace face;
    face.big_bore = builder.add_ring({.along = z, .radius = d.at("big_bore_radius") * bore_scale});
    face.small_bore = builder.add_ring({.along = z, .radius = d.at("small_bore_radius") * bore_scale, .centre_u = length});
    face.big_arc = builder.add_arc({.along = z, .radius = d.at("big_end_radius")}, n / 4, 3 * n / 4);
    face.small_arc = builder.add_arc({.along = z, .radius = d.at("small_end_radius"), .centre_u = length}, 3 * n / 4, 5 * n / 4);
    face.left_top = builder.add_vertex({left.x, left.half_width, z});
    face.left_bottom = builder.add_vertex({left.x, -left.half_width, z});
    face.right_top = builder.add_vertex({right.x, right.half_width, z});
    face.right_bottom = builder.add_vertex({right.x, -right.half_width, z});
    return face;
}

// Points of a bore's ring over the same angles as the end arc that starts at `first`.
Ring bore_arc(const Ring& bore, int first) {
    const int n = static_cast<int>(bore.size());
    Ring arc;
    for (int i = first; i <= first + n / 2; ++i) arc.push_back(bore[static_cast<std::size_t>(i % n)]);
    return arc;
}

void add_end(const Ring& arc, const Ring& bore_half, Facing facing, ShapeBuilder& builder) {
    if (facing == Facing::forward) {
        builder.add_open_strip(arc, bore_half);
    } else {
        builder.add_open_strip(bore_half, arc);
    }
}

void add_face(const RodFace& f, Facing facing, ShapeBuilder& builder) {
    const int n = builder.segments();
    const auto big = [&](int i) { return f.big_bore[static_cast<std::size_t>(i)]; };
    const auto small = [&](int i) { return f.small_bore[static_cast<std::size_t>(i)]; };
    add_end(f.big_arc, bore_arc(f.big_bore, n / 4), facing, builder);
    builder.add_quadrant_outside(f.left_top, f.big_bore, 0, facing);
    builder.add_quadrant_outside(f.left_bottom, f.big_bore, 3, facing);
    builder.add_triangle(f.left_top, f.big_arc.front(), big(n / 4), facing);
    builder.add_triangle(f.left_bottom, big(3 * n / 4), f.big_arc.back(), facing);
    builder.add_triangle(f.left_top, big(0), f.left_bottom, facing);

    builder.add_quadrilateral(f.left_bottom, f.right_bottom, f.right_top, f.left_top, facing);

    add_end(f.small_arc, bore_arc(f.small_bore, 3 * n / 4), facing, builder);
    builder.add_quadrant_outside(f.right_top, f.small_bore, 1, facing);
    builder.add_quadrant_outside(f.right_bottom, f.small_bore, 2, facing);
    builder.add_triangle(f.right_top, small(n / 4), f.small_arc.back(), facing);
    builder.add_triangle(f.right_bottom, f.small_arc.front(), small(3 * n / 4), facing);
    builder.add_triangle(f.right_top, f.right_bottom, small(n / 2), facing);
}

std::vector<Relation> rod_relations(const Dimensions& d, int segments) {
    const double flat = flat_ratio(segments);
    const auto value = [&](const char* name) { return d.at(name).value; };
    const char* thin_wall = "or the bore breaks through its end";
    return {
        {"big_end_radius", value("big_end_radius"), value("rod_length") - value("small_end_radius"), "or the two ends overlap"},
        // The end's flats lie at flat * radius, the bore's vertices at radius / flat.
        {"big_bore_radius", value("big_bore_radius"), value("big_end_radius") * flat * flat, thin_wall},
        {"small_bore_radius", value("small_bore_radius"), value("small_end_radius") * flat * flat, thin_wall},
        {"big_bore_radius", value("big_bore_radius"), side_point_near_big_end(d).half_width.value * flat,
         "or the bore breaks through a side"},
        {"small_bore_radius", value("small_bore_radius"), side_point_near_small_end(d).half_width.value * flat,
         "or the bore breaks through a side"},
    };
}

void build_rod(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual half = d.at("thickness") / 2;
    const RodFace bottom = add_face_vertices(d, -half, builder);
    const RodFace top = add_face_vertices(d, half, builder);
    add_face(bottom, Facing::backward, builder);
    add_face(top, Facing::forward, builder);
    builder.add_strip(bottom.outline(), top.outline());
    builder.add_strip(top.big_bore, bottom.big_bore);
    builder.add_strip(top.small_bore, bottom.small_bore);
}

}  // namespace

ShapeDefinition rod_definition() {
    return {{"rod",
             "slider-crank engine: flat link with two bores; origin at the big bore's axis, small bore at (rod_length, 0), mid-plane z = 0",
             {{"rod_length", 0.045, "distance of the two bores' axes"},
              {"big_bore_radius", 0.0044, "distance of the flats of the crank pin's bore from its axis"},
              {"small_bore_radius", 0.0034, "distance of the flats of the wrist pin's bore from its axis"},
              {"big_end_radius", 0.0074, "radius of the rounded end about the big bore"},
              {"small_end_radius", 0.0056, "radius of the rounded end about the small bore"},
              {"thickness", 0.004, "extent along z"}}},
            rod_relations,
            build_rod};
}

}  // namespace fettle::design::shapes
