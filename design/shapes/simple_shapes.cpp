// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/simple_shapes.hpp"

#include <algorithm>

namespace fettle::design::shapes {
namespace {

struct BoxCorners {
    RectangleCorners bottom, top;
};

BoxCorners add_box_corners(const Dimensions& d, const DimensionDual& size_z, ShapeBuilder& builder) {
    const DimensionDual x = d.at("size_x") / 2, y = d.at("size_y") / 2, z = size_z / 2;
    const RectangleCorners bottom = builder.add_rectangle(Axis::z, -z, {-x, x}, {-y, y});
    return {bottom, builder.add_rectangle(Axis::z, z, {-x, x}, {-y, y})};
}

Ring as_ring(const RectangleCorners& corners) { return Ring(corners.begin(), corners.end()); }

std::vector<Relation> no_relations(const Dimensions&, int) { return {}; }

void build_box(const Dimensions& d, ShapeBuilder& builder) {
    const auto [bottom, top] = add_box_corners(d, d.at("size_z"), builder);
    builder.add_quadrilateral(bottom[0], bottom[1], bottom[2], bottom[3], Facing::backward);
    builder.add_strip(as_ring(bottom), as_ring(top));
    builder.add_quadrilateral(top[0], top[1], top[2], top[3]);
}

void build_pin(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual& radius = d.at("radius");
    const DimensionDual half = d.at("length") / 2;
    const Ring bottom = builder.add_ring({.along = -half, .radius = radius});
    const Ring top = builder.add_ring({.along = half, .radius = radius});
    builder.add_cap(builder.add_vertex({0, 0, -half}), bottom, Facing::backward);
    builder.add_strip(bottom, top);
    builder.add_cap(builder.add_vertex({0, 0, half}), top, Facing::forward);
}

std::vector<Relation> plate_relations(const Dimensions& d, int segments) {
    const double hole = d.at("hole_radius").value;
    const double half = std::min(d.at("size_x").value, d.at("size_y").value) / 2;
    return {{"hole_radius", hole, half * flat_ratio(segments), "or the hole breaks through the plate's sides"}};
}

void build_plate_with_hole(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual& thickness = d.at("thickness");
    const DimensionDual radius = d.at("hole_radius") / flat_ratio(builder.segments());
    const auto [bottom, top] = add_box_corners(d, thickness, builder);
    const Ring hole_bottom = builder.add_ring({.along = -thickness / 2, .radius = radius});
    const Ring hole_top = builder.add_ring({.along = thickness / 2, .radius = radius});
    builder.add_rectangle_with_hole(bottom, hole_bottom, Facing::backward);
    builder.add_strip(as_ring(bottom), as_ring(top));
    builder.add_strip(hole_top, hole_bottom);
    builder.add_rectangle_with_hole(top, hole_top, Facing::forward);
}

}  // namespace

ShapeDefinition box_definition() {
    return {{"box",
             "cuboid centred at the origin",
             {{"size_x", 0.02, "extent along x"}, {"size_y", 0.02, "extent along y"}, {"size_z", 0.02, "extent along z"}}},
            no_relations,
            build_box};
}

ShapeDefinition pin_definition() {
    return {{"pin",
             "cylinder along z, centred at the origin, inscribed polygon",
             {{"radius", 0.005, "radius of the vertices"}, {"length", 0.02, "extent along z"}}},
            no_relations,
            build_pin};
}

ShapeDefinition plate_with_hole_definition() {
    return {{"plate_with_hole",
             "rectangular plate centred at the origin with a hole along z, circumscribed polygon",
             {{"size_x", 0.03, "extent along x"},
              {"size_y", 0.03, "extent along y"},
              {"thickness", 0.005, "extent along z"},
              {"hole_radius", 0.0054, "distance of the hole's flats from its axis"}}},
            plate_relations,
            build_plate_with_hole};
}

}  // namespace fettle::design::shapes
