// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/cam_parts.hpp"

namespace fettle::design::shapes {
namespace {

// z where the tip's surface has this distance from the axis.
DimensionDual tip_height(const Dimensions& d, const DimensionDual& radius) {
    using std::sqrt;
    const DimensionDual& tip = d.at("tip_radius");
    return tip - sqrt(tip * tip - radius * radius);
}

std::vector<Relation> follower_relations(const Dimensions& d, int /*segments*/) {
    const auto value = [&](const char* name) { return d.at(name).value; };
    return {
        {"shank_radius", value("shank_radius"), value("tip_radius"), "or the tip does not reach the shank; tip_radius can be larger too"},
        {"shank_radius", value("shank_radius"), value("head_radius"), "or the head does not stand out of the shank"},
        // The tip is never higher than a hemisphere.
        {"shank_radius", value("shank_radius"), value("length"), "or the tip reaches the head; length can be larger too"},
    };
}

// Rings of the tip, from the lowest to the one where the shank begins: radii in equal parts of the shank's.
std::vector<Ring> add_tip(const Dimensions& d, ShapeBuilder& builder) {
    const int count = builder.segments() / 2;
    std::vector<Ring> rings;
    for (int k = 1; k <= count; ++k) {
        const DimensionDual radius = d.at("shank_radius") * (static_cast<double>(k) / count);
        rings.push_back(builder.add_ring({.along = tip_height(d, radius), .radius = radius}));
    }
    return rings;
}

void build_follower(const Dimensions& d, ShapeBuilder& builder) {
    const DimensionDual &head_bottom = d.at("length"), head_top = head_bottom + d.at("head_thickness");
    std::vector<Ring> profile = add_tip(d, builder);
    profile.push_back(builder.add_ring({.along = head_bottom, .radius = d.at("shank_radius")}));
    profile.push_back(builder.add_ring({.along = head_bottom, .radius = d.at("head_radius")}));
    profile.push_back(builder.add_ring({.along = head_top, .radius = d.at("head_radius")}));
    builder.add_cap(builder.add_vertex({0, 0, 0}), profile.front(), Facing::backward);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
    builder.add_cap(builder.add_vertex({0, 0, head_top}), profile.back(), Facing::forward);
}

}  // namespace

ShapeDefinition follower_definition() {
    return {{"follower",
             "eccentric and follower: round shank along z with a spherical tip below and a head above; origin at the tip's lowest point",
             {{"shank_radius", 0.0048, "radius of the shank in the guide's bore"},
              {"length", 0.032, "from the tip's lowest point to the head"},
              {"tip_radius", 0.009, "radius of the sphere that the tip is a part of: above the shank's"},
              {"head_radius", 0.007, "radius of the head"},
              {"head_thickness", 0.002, "thickness of the head"}}},
            follower_relations,
            build_follower};
}

}  // namespace fettle::design::shapes
