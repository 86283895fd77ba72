// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "fettle/design/shapes/engine_parts.hpp"

namespace fettle::design::shapes {
namespace {

std::vector<Relation> piston_relations(const Dimensions& d, int segments) {
    const auto value = [&](const char* name) { return d.at(name).value; };
    const double rim = value("piston_radius") * flat_ratio(segments);
    const double top = value("lug_top"), bottom = top - value("lug_height");
    const double furthest = std::max(std::abs(top), std::abs(bottom));
    const double widest = rim > furthest ? std::sqrt(rim * rim - furthest * furthest) : 0;
    const char* off_lug = "or the wrist pin leaves the lug";
    return {
        {"wrist_pin_radius", value("wrist_pin_radius"), value("lug_half_width"), off_lug},
        {"wrist_pin_radius", value("wrist_pin_radius"), value("lug_reach"), off_lug},
        {"wrist_pin_radius", value("wrist_pin_radius"), value("face_offset"), off_lug},
        {"wrist_pin_radius", value("wrist_pin_radius"), value("wrist_pin_head_radius"), "or the pin's head does not retain the rod"},
        {"wrist_pin_head_radius", value("wrist_pin_head_radius"), value("face_offset"), "or the pin's head runs into the piston's face"},
        {"lug_half_width", value("lug_half_width"), widest,
         "or the lug's corners leave the piston's face; piston_radius can be larger too"},
    };
}

// Lug: corners of its free end and of its root in the piston's face, both as rectangles across x (quadrants of y, z).
struct Lug {
    RectangleCorners free_end, root;

    // Its top as a rectangle across z (quadrants of x, y), for the pin's hole pattern.
    RectangleCorners top() const { return {root[0], free_end[0], free_end[1], root[1]}; }
};

void add_lug(const Lug& lug, ShapeBuilder& builder) {
    const auto& [e, r] = lug;
    builder.add_quadrilateral(e[0], e[1], e[2], e[3], Facing::backward);
    builder.add_quadrilateral(e[1], e[2], r[2], r[1]);  // y < 0
    builder.add_quadrilateral(e[2], e[3], r[3], r[2]);  // below
    builder.add_quadrilateral(e[3], e[0], r[0], r[3]);  // y > 0
}

void add_wrist_pin(const Dimensions& d, const Lug& lug, ShapeBuilder& builder) {
    const DimensionDual& bottom = d.at("lug_top");
    const DimensionDual head_bottom = bottom + d.at("wrist_pin_length");
    const DimensionDual head_top = head_bottom + d.at("wrist_pin_head_thickness");
    const DimensionDual &pin = d.at("wrist_pin_radius"), &head = d.at("wrist_pin_head_radius");
    const std::vector<Ring> profile = {
        builder.add_ring({.along = bottom, .radius = pin}), builder.add_ring({.along = head_bottom, .radius = pin}),
        builder.add_ring({.along = head_bottom, .radius = head}), builder.add_ring({.along = head_top, .radius = head})};
    builder.add_rectangle_with_hole(lug.top(), profile.front(), Facing::forward);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
    builder.add_cap(builder.add_vertex({0, 0, head_top}), profile.back(), Facing::forward);
}

void build_piston(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual& face = d.at("face_offset");
    const DimensionDual crown = face + d.at("piston_length");
    const DimensionDual &radius = d.at("piston_radius"), &half_width = d.at("lug_half_width"), &lug_top = d.at("lug_top");
    const DimensionDual lug_bottom = lug_top - d.at("lug_height");

    const RectangleCorners free_end = builder.add_rectangle(Axis::x, -d.at("lug_reach"), {-half_width, half_width}, {lug_bottom, lug_top});
    const Lug lug{free_end, builder.add_rectangle(Axis::x, face, {-half_width, half_width}, {lug_bottom, lug_top})};
    const Ring rim = builder.add_ring({.axis = Axis::x, .along = face, .radius = radius});
    const Ring crown_rim = builder.add_ring({.axis = Axis::x, .along = crown, .radius = radius});

    add_lug(lug, builder);
    add_wrist_pin(d, lug, builder);
    builder.add_disc_with_rectangle(rim, lug.root, Facing::backward);
    builder.add_strip(rim, crown_rim);
    builder.add_cap(builder.add_vertex({crown, 0, 0}), crown_rim, Facing::forward);
}

}  // namespace

ShapeDefinition piston_definition() {
    return {{"piston",
             "slider-crank engine: cylinder along x with a lug towards the crank that carries the wrist pin; origin on the wrist pin's "
             "axis, at "
             "the rod's mid-plane",
             {{"piston_radius", 0.01165, "radius of the piston in the cylinder bore"},
              {"piston_length", 0.022, "length of the cylindrical part"},
              {"wrist_pin_radius", 0.00305, "radius of the wrist pin in the rod's small bore"},
              {"face_offset", 0.0074, "distance from the wrist pin's axis to the cylindrical part: leaves room for the rod's small end"},
              {"lug_reach", 0.0046, "distance from the wrist pin's axis to the lug's free end, towards the crank"},
              {"lug_half_width", 0.0046, "half the extent of the lug along y"},
              {"lug_top", -0.0024, "z of the lug's top face, on which the rod rides", DimensionKind::coordinate},
              {"lug_height", 0.0035, "extent of the lug along z"},
              {"wrist_pin_length", 0.0048, "length of the wrist pin: the rod's thickness and the play above and below it"},
              {"wrist_pin_head_radius", 0.0048, "radius of the head that retains the rod on the wrist pin"},
              {"wrist_pin_head_thickness", 0.0016, "thickness of that head"}}},
            piston_relations,
            build_piston};
}

}  // namespace fettle::design::shapes
