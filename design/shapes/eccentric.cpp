// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/cam_parts.hpp"

namespace fettle::design::shapes {
namespace {

std::vector<Relation> eccentric_relations(const Dimensions& d, int segments) {
    const auto value = [&](const char* name) { return d.at(name).value; };
    return {
        {"shaft_radius", value("shaft_radius"), value("disc_radius"), "or the shaft is wider than the disc"},
        // The supporting half-planes of both polygons have the same normals: nested exactly if the flats' distance exceeds the offset.
        {"eccentricity", value("eccentricity"), (value("disc_radius") - value("shaft_radius")) * flat_ratio(segments),
         "or the shaft leaves the disc; disc_radius can be larger too"},
    };
}

void build_eccentric(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual half = d.at("width") / 2, end = half + d.at("shaft_length");
    const auto shaft = [&](const DimensionDual& x) {
        return builder.add_ring({.axis = Axis::x, .along = x, .radius = d.at("shaft_radius")});
    };
    const auto disc = [&](const DimensionDual& x) {
        return builder.add_ring({.axis = Axis::x, .along = x, .radius = d.at("disc_radius"), .centre_v = -d.at("eccentricity")});
    };
    const std::vector<Ring> profile = {shaft(-end), shaft(-half), disc(-half), disc(half), shaft(half), shaft(end)};
    builder.add_cap(builder.add_vertex({-end, 0, 0}), profile.front(), Facing::backward);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
    builder.add_cap(builder.add_vertex({end, 0, 0}), profile.back(), Facing::forward);
}

}  // namespace

ShapeDefinition eccentric_definition() {
    return {
        {"eccentric",
         "eccentric and follower: round disc on a shaft along x; origin on the shaft's axis, the disc's centre at (0, 0, -eccentricity)",
         {{"eccentricity", 0.004, "distance of the disc's centre from the shaft's axis: half the rise"},
          {"disc_radius", 0.012, "radius of the disc"},
          {"width", 0.006, "extent of the disc along x"},
          {"shaft_radius", 0.0035, "radius of the shaft"},
          {"shaft_length", 0.004, "how far the shaft stands out of the disc on either side"}}},
        eccentric_relations,
        build_eccentric};
}

}  // namespace fettle::design::shapes
