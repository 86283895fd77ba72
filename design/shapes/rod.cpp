// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/engine_parts.hpp"
#include "fettle/design/shapes/link_face.hpp"

namespace fettle::design::shapes {
namespace {

LinkOutline rod_outline(const Dimensions& d) {
    return {.length = d.at("rod_length"), .big_end_radius = d.at("big_end_radius"), .small_end_radius = d.at("small_end_radius")};
}

std::vector<Relation> rod_relations(const Dimensions& d, int segments) {
    const double flat = flat_ratio(segments);
    const auto value = [&](const char* name) { return d.at(name).value; };
    const LinkOutline outline = rod_outline(d);
    const char* thin_wall = "or the bore breaks through its end";
    return {
        {"big_end_radius", value("big_end_radius"), value("rod_length") - value("small_end_radius"), "or the two ends overlap"},
        // The end's flats lie at flat * radius, the bore's vertices at radius / flat.
        {"big_bore_radius", value("big_bore_radius"), value("big_end_radius") * flat * flat, thin_wall},
        {"small_bore_radius", value("small_bore_radius"), value("small_end_radius") * flat * flat, thin_wall},
        {"big_bore_radius", value("big_bore_radius"), half_width_near_big_end(outline).value * flat, "or the bore breaks through a side"},
        {"small_bore_radius", value("small_bore_radius"), half_width_near_small_end(outline).value * flat,
         "or the bore breaks through a side"},
    };
}

void build_rod(const Dimensions& d, ShapeBuilder& builder) {
    const LinkOutline outline = rod_outline(d);
    const double bore_scale = 1 / flat_ratio(builder.segments());
    const DimensionDual big_bore = d.at("big_bore_radius") * bore_scale, small_bore = d.at("small_bore_radius") * bore_scale;
    const DimensionDual half = d.at("thickness") / 2;
    const LinkFace bottom = add_link_face_vertices(outline, big_bore, small_bore, -half, builder);
    const LinkFace top = add_link_face_vertices(outline, big_bore, small_bore, half, builder);
    add_link_face(bottom, Facing::backward, builder);
    add_link_face(top, Facing::forward, builder);
    builder.add_strip(bottom.outline(), top.outline());
    builder.add_strip(top.big_ring, bottom.big_ring);
    builder.add_strip(top.small_ring, bottom.small_ring);
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
