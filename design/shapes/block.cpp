// SPDX-License-Identifier: MIT
#include <algorithm>

#include "fettle/design/shapes/engine_parts.hpp"

namespace fettle::design::shapes {
namespace {

std::vector<Relation> block_relations(const Dimensions& d, int segments) {
    const double flat = flat_ratio(segments);
    const auto value = [&](const char* name) { return d.at(name).value; };
    const double plate_room = std::min({value("plate_end"), value("half_width"), value("wall_near")});
    const double wall_room = std::min({value("half_width"), value("wall_top"), -value("plate_top")});
    return {
        {"wall_near", value("wall_near"), value("wall_far"), "or the tall part has no length"},
        {"bearing_bore_radius", value("bearing_bore_radius"), plate_room * flat, "or the bearing bore leaves the plate"},
        {"cylinder_bore_radius", value("cylinder_bore_radius"), wall_room * flat,
         "or the cylinder bore breaks through a side of the tall part or through the plate's top face"},
    };
}

// Corners of the L-profile at one y, in the order of the outline in the xz plane.
struct Profile {
    int end_bottom, far_bottom, far_top, near_top, inner, end_top;
};

Profile add_profile(const Dimensions& d, const DimensionDual& y, ShapeBuilder& builder) {
    const DimensionDual &near = d.at("wall_near"), &far = d.at("wall_far"), &top = d.at("wall_top"), &plate_top = d.at("plate_top");
    const DimensionDual end = -d.at("plate_end"), bottom = plate_top - d.at("plate_thickness");
    return {builder.add_vertex({end, y, bottom}), builder.add_vertex({far, y, bottom}),     builder.add_vertex({far, y, top}),
            builder.add_vertex({near, y, top}),   builder.add_vertex({near, y, plate_top}), builder.add_vertex({end, y, plate_top})};
}

// The L, fanned from its inner corner, which sees all of it. Forward looks to -y: x then z is counter-clockwise from there.
void add_side(const Profile& p, Facing facing, ShapeBuilder& builder) {
    builder.add_triangle(p.inner, p.end_top, p.end_bottom, facing);
    builder.add_triangle(p.inner, p.end_bottom, p.far_bottom, facing);
    builder.add_triangle(p.inner, p.far_bottom, p.far_top, facing);
    builder.add_triangle(p.inner, p.far_top, p.near_top, facing);
}

void build_block(const Dimensions& d, ShapeBuilder& builder) {
    const double bore_scale = 1 / flat_ratio(builder.segments());
    const DimensionDual& half_width = d.at("half_width");
    const Profile l = add_profile(d, -half_width, builder), r = add_profile(d, half_width, builder);
    add_side(l, Facing::forward, builder);
    add_side(r, Facing::backward, builder);

    const DimensionDual bearing = d.at("bearing_bore_radius") * bore_scale, &plate_top = d.at("plate_top");
    const Ring bearing_bottom = builder.add_ring({.along = plate_top - d.at("plate_thickness"), .radius = bearing});
    const Ring bearing_top = builder.add_ring({.along = plate_top, .radius = bearing});
    builder.add_strip(bearing_top, bearing_bottom);
    builder.add_rectangle_with_hole({r.inner, r.end_top, l.end_top, l.inner}, bearing_top, Facing::forward);
    builder.add_rectangle_with_hole({r.far_bottom, r.end_bottom, l.end_bottom, l.far_bottom}, bearing_bottom, Facing::backward);

    const DimensionDual cylinder = d.at("cylinder_bore_radius") * bore_scale;
    const Ring near = builder.add_ring({.axis = Axis::x, .along = d.at("wall_near"), .radius = cylinder});
    const Ring far = builder.add_ring({.axis = Axis::x, .along = d.at("wall_far"), .radius = cylinder});
    builder.add_strip(far, near);
    builder.add_rectangle_with_hole({r.near_top, l.near_top, l.inner, r.inner}, near, Facing::backward);
    builder.add_rectangle_with_hole({r.far_top, l.far_top, l.far_bottom, r.far_bottom}, far, Facing::forward);

    builder.add_quadrilateral(r.far_top, r.near_top, l.near_top, l.far_top);      // top of the tall part
    builder.add_quadrilateral(r.end_top, r.end_bottom, l.end_bottom, l.end_top);  // the plate's free end
}

}  // namespace

ShapeDefinition block_definition() {
    return {
        {"block",
         "slider-crank engine: L of a plate with the journal's bearing bore and a tall part with the cylinder bore along x; origin on the "
         "crank's axis, at the cylinder's axis",
         {{"bearing_bore_radius", 0.0054, "distance of the flats of the journal's bore from its axis"},
          {"cylinder_bore_radius", 0.012, "distance of the flats of the cylinder bore from its axis"},
          {"plate_top", -0.0143, "z of the plate's top face: below the cylinder bore", DimensionKind::coordinate},
          {"plate_thickness", 0.005, "extent of the plate along z"},
          {"plate_end", 0.012, "extent of the plate beyond the crank's axis, away from the cylinder"},
          {"wall_near", 0.042, "x where the tall part begins"},
          {"wall_far", 0.082, "x where it ends"},
          {"wall_top", 0.016, "z of its top"},
          {"half_width", 0.017, "half the extent along y"}}},
        block_relations,
        build_block};
}

}  // namespace fettle::design::shapes
