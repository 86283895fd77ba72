// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/engine_parts.hpp"

namespace fettle::design::shapes {
namespace {

// z of each step of the profile, from the disc's top downwards and upwards.
struct CrankLevels {
    DimensionDual collar_bottom, journal_bottom, shoulder_bottom, disc_bottom, disc_top, head_bottom, head_top;
};

CrankLevels crank_levels(const Dimensions& d) {
    CrankLevels z;
    z.disc_top = d.at("disc_top");
    z.disc_bottom = z.disc_top - d.at("disc_thickness");
    z.shoulder_bottom = z.disc_bottom - d.at("shoulder_height");
    z.journal_bottom = z.shoulder_bottom - d.at("journal_length");
    z.collar_bottom = z.journal_bottom - d.at("journal_collar_thickness");
    z.head_bottom = z.disc_top + d.at("crank_pin_length");
    z.head_top = z.head_bottom + d.at("crank_pin_head_thickness");
    return z;
}

std::vector<Relation> crank_relations(const Dimensions& d, int segments) {
    const auto value = [&](const char* name) { return d.at(name).value; };
    return {
        {"journal_radius", value("journal_radius"), value("journal_collar_radius"), "or the collar does not retain the journal"},
        {"journal_radius", value("journal_radius"), value("shoulder_radius"), "or there is no shoulder to run on the plate"},
        {"shoulder_radius", value("shoulder_radius"), value("disc_radius"), "the disc is the wider step"},
        {"crank_pin_radius", value("crank_pin_radius"), value("crank_pin_head_radius"), "or the pin's head does not retain the rod"},
        {"crank_pin_radius", value("crank_pin_radius"), value("disc_radius"), "or the pin is wider than the disc"},
        // The supporting half-planes of both polygons have the same normals: nested exactly if the flats' distance exceeds the offset.
        {"crank_radius", value("crank_radius"), (value("disc_radius") - value("crank_pin_radius")) * flat_ratio(segments),
         "or the crank pin leaves the disc"},
    };
}

void build_crank(const Dimensions& d, ShapeBuilder& builder) {
    const CrankLevels z = crank_levels(d);
    const DimensionDual& offset = d.at("crank_radius");
    const auto on_axis = [&](const DimensionDual& along, const char* radius) {
        return builder.add_ring({.along = along, .radius = d.at(radius)});
    };
    const auto on_pin = [&](const DimensionDual& along, const char* radius) {
        return builder.add_ring({.along = along, .radius = d.at(radius), .centre_u = offset});
    };
    const std::vector<Ring> profile = {
        on_axis(z.collar_bottom, "journal_collar_radius"),
        on_axis(z.journal_bottom, "journal_collar_radius"),
        on_axis(z.journal_bottom, "journal_radius"),
        on_axis(z.shoulder_bottom, "journal_radius"),
        on_axis(z.shoulder_bottom, "shoulder_radius"),
        on_axis(z.disc_bottom, "shoulder_radius"),
        on_axis(z.disc_bottom, "disc_radius"),
        on_axis(z.disc_top, "disc_radius"),
        on_pin(z.disc_top, "crank_pin_radius"),
        on_pin(z.head_bottom, "crank_pin_radius"),
        on_pin(z.head_bottom, "crank_pin_head_radius"),
        on_pin(z.head_top, "crank_pin_head_radius"),
    };
    builder.add_cap(builder.add_vertex({0, 0, z.collar_bottom}), profile.front(), Facing::backward);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
    builder.add_cap(builder.add_vertex({offset, 0, z.head_top}), profile.back(), Facing::forward);
}

}  // namespace

ShapeDefinition crank_definition() {
    return {{"crank",
             "slider-crank engine: disc with a journal below and an eccentric crank pin above; origin on the axis, at the rod's mid-plane",
             {{"crank_radius", 0.015, "distance of the crank pin's axis from the crank's axis: half the stroke"},
              {"journal_radius", 0.00505, "radius of the journal in the block's bearing bore"},
              {"crank_pin_radius", 0.00405, "radius of the crank pin in the rod's big bore"},
              {"disc_radius", 0.021, "radius of the disc"},
              {"disc_thickness", 0.004, "thickness of the disc"},
              {"disc_top", -0.0024, "z of the disc's top face, on which the rod rides", DimensionKind::coordinate},
              {"shoulder_radius", 0.009, "radius of the step under the disc that runs on the block's plate"},
              {"shoulder_height", 0.0075, "height of that step"},
              {"journal_length", 0.0058, "length of the journal: the plate's thickness and the play above and below it"},
              {"journal_collar_radius", 0.0075, "radius of the collar that retains the journal under the plate"},
              {"journal_collar_thickness", 0.0025, "thickness of that collar"},
              {"crank_pin_length", 0.0048, "length of the crank pin: the rod's thickness and the play above and below it"},
              {"crank_pin_head_radius", 0.006, "radius of the head that retains the rod on the crank pin"},
              {"crank_pin_head_thickness", 0.0016, "thickness of that head"}}},
            crank_relations,
            build_crank};
}

}  // namespace fettle::design::shapes
