// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "fettle/design/shapes/linkage_parts.hpp"

namespace fettle::design::shapes {
namespace {

std::vector<Relation> base_plate_relations(const Dimensions& d, int segments) {
    const double flat = flat_ratio(segments);
    const auto value = [&](const char* name) { return d.at(name).value; };
    const double y = value("pivot_y"), half = value("pivot_x") / 2;
    const double crank_room = std::min({value("reach_left"), half, value("reach_below"), value("reach_above")});
    const double rocker_room = std::min({value("reach_right"), half, value("reach_below") + y, value("reach_above") - y});
    const char* reason = "or the bore leaves its half of the plate";
    return {{"crank_bore_radius", value("crank_bore_radius"), crank_room * flat, reason},
            {"rocker_bore_radius", value("rocker_bore_radius"), rocker_room * flat, reason}};
}

// One face: two rectangles that meet midway between the bores, each with its hole. Corners as in RectangleCorners.
struct BasePlateFace {
    RectangleCorners crank_side, rocker_side;
    Ring crank_bore, rocker_bore;

    Ring outline() const { return {crank_side[2], crank_side[3], rocker_side[3], rocker_side[0], crank_side[0], crank_side[1]}; }
};

BasePlateFace add_base_plate_face(const Dimensions& d, const DimensionDual& z, Facing facing, ShapeBuilder& builder) {
    const double bore_scale = 1 / flat_ratio(builder.segments());
    const DimensionDual &x = d.at("pivot_x"), below = -d.at("reach_below"), &above = d.at("reach_above");
    BasePlateFace face;
    face.crank_side = builder.add_rectangle(Axis::z, z, {-d.at("reach_left"), x / 2}, {below, above});
    const DimensionDual right = x + d.at("reach_right");
    const int top = builder.add_vertex({right, above, z}), bottom = builder.add_vertex({right, below, z});
    face.rocker_side = {top, face.crank_side[0], face.crank_side[3], bottom};
    face.crank_bore = builder.add_ring({.along = z, .radius = d.at("crank_bore_radius") * bore_scale});
    face.rocker_bore =
        builder.add_ring({.along = z, .radius = d.at("rocker_bore_radius") * bore_scale, .centre_u = x, .centre_v = d.at("pivot_y")});
    builder.add_rectangle_with_hole(face.crank_side, face.crank_bore, facing);
    builder.add_rectangle_with_hole(face.rocker_side, face.rocker_bore, facing);
    return face;
}

void build_base_plate(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual& top_z = d.at("plate_top");
    const BasePlateFace bottom = add_base_plate_face(d, top_z - d.at("plate_thickness"), Facing::backward, builder);
    const BasePlateFace top = add_base_plate_face(d, top_z, Facing::forward, builder);
    builder.add_strip(bottom.outline(), top.outline());
    builder.add_strip(top.crank_bore, bottom.crank_bore);
    builder.add_strip(top.rocker_bore, bottom.rocker_bore);
}

}  // namespace

ShapeDefinition base_plate_definition() {
    return {{"base_plate",
             "four-bar linkage: rectangular plate with two bores along z; origin on the crank bore's axis, at the coupler's mid-plane",
             {{"pivot_x", 0.05, "x of the rocker bore's axis"},
              {"pivot_y", 0, "y of the rocker bore's axis", DimensionKind::coordinate},
              {"crank_bore_radius", 0.0045, "distance of the flats of the crank's bore from its axis"},
              {"rocker_bore_radius", 0.0045, "distance of the flats of the rocker's bore from its axis"},
              {"plate_top", -0.0076, "z of the plate's top face, on which the arms run", DimensionKind::coordinate},
              {"plate_thickness", 0.005, "extent of the plate along z"},
              {"reach_left", 0.028, "extent of the plate beyond the crank's axis, away from the rocker"},
              {"reach_right", 0.025, "extent of the plate beyond the rocker bore's axis, away from the crank"},
              {"reach_below", 0.028, "extent of the plate towards -y"},
              {"reach_above", 0.055, "extent of the plate towards +y"}}},
            base_plate_relations,
            build_base_plate};
}

}  // namespace fettle::design::shapes
