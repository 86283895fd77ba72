// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/link_face.hpp"
#include "fettle/design/shapes/linkage_parts.hpp"

namespace fettle::design::shapes {
namespace {

LinkOutline coupler_outline(const Dimensions& d) {
    return {.length = d.at("coupler_length"),
            .big_end_radius = d.at("crank_end_radius"),
            .small_end_radius = d.at("rocker_end_radius"),
            .origin_x = -d.at("point_x"),
            .origin_y = -d.at("point_y")};
}

std::vector<Relation> coupler_relations(const Dimensions& d, int segments) {
    const double flat = flat_ratio(segments);
    const auto value = [&](const char* name) { return d.at(name).value; };
    const LinkOutline outline = coupler_outline(d);
    const char *thin_wall = "or the bore breaks through its end", *thin_side = "or the bore breaks through a side";
    const char* short_wing = "or the point does not stand out of the bar; point_y can be larger too";
    return {
        {"crank_end_radius", value("crank_end_radius"), value("coupler_length") - value("rocker_end_radius"), "or the two ends overlap"},
        {"crank_bore_radius", value("crank_bore_radius"), value("crank_end_radius") * flat * flat, thin_wall},
        {"rocker_bore_radius", value("rocker_bore_radius"), value("rocker_end_radius") * flat * flat, thin_wall},
        {"crank_bore_radius", value("crank_bore_radius"), half_width_near_big_end(outline).value * flat, thin_side},
        {"rocker_bore_radius", value("rocker_bore_radius"), half_width_near_small_end(outline).value * flat, thin_side},
        {"tip_half_width", value("tip_half_width"), value("point_x") - value("crank_end_radius"),
         "or the wing stands over the crank's end; point_x can be larger too"},
        {"tip_half_width", value("tip_half_width"), value("coupler_length") - value("rocker_end_radius") - value("point_x"),
         "or the wing stands over the rocker's end; point_x can be smaller too"},
        {"crank_end_radius", value("crank_end_radius"), value("point_y"), short_wing},
        {"rocker_end_radius", value("rocker_end_radius"), value("point_y"), short_wing},
    };
}

struct CouplerFace {
    LinkFace link;
    int tip_left = 0, tip_right = 0;

    Ring outline() const { return link.outline({tip_right, tip_left}); }
};

CouplerFace add_coupler_face(const Dimensions& d, const DimensionDual& z, Facing facing, ShapeBuilder& builder) {
    const double bore_scale = 1 / flat_ratio(builder.segments());
    CouplerFace face;
    face.link = add_link_face_vertices(coupler_outline(d), d.at("crank_bore_radius") * bore_scale, d.at("rocker_bore_radius") * bore_scale,
                                       z, builder);
    face.tip_left = builder.add_vertex({-d.at("tip_half_width"), 0, z});
    face.tip_right = builder.add_vertex({d.at("tip_half_width"), 0, z});
    add_link_face(face.link, facing, builder);
    builder.add_quadrilateral(face.link.left_top, face.link.right_top, face.tip_right, face.tip_left, facing);
    return face;
}

void build_coupler(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual half = d.at("thickness") / 2;
    const CouplerFace bottom = add_coupler_face(d, -half, Facing::backward, builder);
    const CouplerFace top = add_coupler_face(d, half, Facing::forward, builder);
    builder.add_strip(bottom.outline(), top.outline());
    builder.add_strip(top.link.big_ring, bottom.link.big_ring);
    builder.add_strip(top.link.small_ring, bottom.link.small_ring);
}

}  // namespace

ShapeDefinition coupler_definition() {
    return {{"coupler",
             "four-bar linkage: flat link with two bores and a wing that ends in the coupler point; origin at that point, crank's bore at "
             "(-point_x, -point_y), rocker's bore at (coupler_length - point_x, -point_y), mid-plane z = 0",
             {{"coupler_length", 0.055, "distance of the two bores' axes"},
              {"point_x", 0.025, "place of the coupler point along the link, from the crank's bore"},
              {"point_y", 0.02, "its distance from the line of the bores"},
              {"crank_bore_radius", 0.0034, "distance of the flats of the crank pin's bore from its axis"},
              {"rocker_bore_radius", 0.0034, "distance of the flats of the rocker pin's bore from its axis"},
              {"crank_end_radius", 0.0064, "radius of the rounded end about the crank's bore"},
              {"rocker_end_radius", 0.0064, "radius of the rounded end about the rocker's bore"},
              {"tip_half_width", 0.003, "half the width of the wing at the point"},
              {"thickness", 0.004, "extent along z"}}},
            coupler_relations,
            build_coupler};
}

}  // namespace fettle::design::shapes
