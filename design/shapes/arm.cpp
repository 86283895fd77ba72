// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/link_face.hpp"
#include "fettle/design/shapes/linkage_parts.hpp"

namespace fettle::design::shapes {
namespace {

LinkOutline arm_outline(const Dimensions& d) {
    return {.length = d.at("arm_length"), .big_end_radius = d.at("journal_end_radius"), .small_end_radius = d.at("pin_end_radius")};
}

std::vector<Relation> arm_relations(const Dimensions& d, int /*segments*/) {
    const auto value = [&](const char* name) { return d.at(name).value; };
    const LinkOutline outline = arm_outline(d);
    const char* off_bar = "or it leaves the bar";
    return {
        {"journal_end_radius", value("journal_end_radius"), value("arm_length") - value("pin_end_radius"), "or the two ends overlap"},
        {"journal_radius", value("journal_radius"), value("shoulder_radius"), "or there is no shoulder to run on the base"},
        {"journal_radius", value("journal_radius"), value("journal_collar_radius"), "or the collar does not retain the journal"},
        {"pin_radius", value("pin_radius"), value("pin_head_radius"), "or the pin's head does not retain the coupler"},
        {"shoulder_radius", value("shoulder_radius"), value("journal_end_radius"), off_bar},
        {"shoulder_radius", value("shoulder_radius"), half_width_near_big_end(outline).value, off_bar},
        {"foot_radius", value("foot_radius"), value("pin_end_radius"), off_bar},
        {"foot_radius", value("foot_radius"), half_width_near_small_end(outline).value, off_bar},
        {"pin_radius", value("pin_radius"), value("pin_end_radius"), off_bar},
        {"pin_radius", value("pin_radius"), half_width_near_small_end(outline).value, off_bar},
    };
}

// From the collar's lower face up to the ring in the bar's lower face.
void add_journal(const Dimensions& d, const DimensionDual& bar_bottom, const Ring& root, ShapeBuilder& builder) {
    const DimensionDual shoulder_bottom = bar_bottom - d.at("shoulder_height");
    const DimensionDual journal_bottom = shoulder_bottom - d.at("journal_length");
    const DimensionDual collar_bottom = journal_bottom - d.at("journal_collar_thickness");
    const auto ring = [&](const DimensionDual& z, const char* radius) { return builder.add_ring({.along = z, .radius = d.at(radius)}); };
    const std::vector<Ring> profile = {ring(collar_bottom, "journal_collar_radius"), ring(journal_bottom, "journal_collar_radius"),
                                       ring(journal_bottom, "journal_radius"),       ring(shoulder_bottom, "journal_radius"),
                                       ring(shoulder_bottom, "shoulder_radius"),     root};
    builder.add_cap(builder.add_vertex({0, 0, collar_bottom}), profile.front(), Facing::backward);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
}

void add_foot(const Dimensions& d, const DimensionDual& bar_bottom, const Ring& root, ShapeBuilder& builder) {
    const DimensionDual &length = d.at("arm_length"), foot_bottom = bar_bottom - d.at("shoulder_height");
    const Ring sole = builder.add_ring({.along = foot_bottom, .radius = d.at("foot_radius"), .centre_u = length});
    builder.add_cap(builder.add_vertex({length, 0, foot_bottom}), sole, Facing::backward);
    builder.add_strip(sole, root);
}

void add_arm_pin(const Dimensions& d, const Ring& root, ShapeBuilder& builder) {
    const DimensionDual &length = d.at("arm_length"), head_bottom = d.at("bar_top") + d.at("pin_length");
    const DimensionDual head_top = head_bottom + d.at("pin_head_thickness");
    const auto ring = [&](const DimensionDual& z, const char* radius) {
        return builder.add_ring({.along = z, .radius = d.at(radius), .centre_u = length});
    };
    const std::vector<Ring> profile = {root, ring(head_bottom, "pin_radius"), ring(head_bottom, "pin_head_radius"),
                                       ring(head_top, "pin_head_radius")};
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) builder.add_strip(profile[i], profile[i + 1]);
    builder.add_cap(builder.add_vertex({length, 0, head_top}), profile.back(), Facing::forward);
}

void build_arm(const Dimensions& d, ShapeBuilder& builder) {
    const LinkOutline outline = arm_outline(d);
    const DimensionDual &bar_top = d.at("bar_top"), bar_bottom = bar_top - d.at("bar_thickness");
    const LinkFace bottom = add_link_face_vertices(outline, d.at("shoulder_radius"), d.at("foot_radius"), bar_bottom, builder);
    const LinkFace top = add_link_face_vertices(outline, d.at("shoulder_radius"), d.at("pin_radius"), bar_top, builder);
    add_link_face(bottom, Facing::backward, builder);
    add_link_face(top, Facing::forward, builder);
    builder.add_strip(bottom.outline(), top.outline());
    builder.add_cap(builder.add_vertex({0, 0, bar_top}), top.big_ring, Facing::forward);
    add_journal(d, bar_bottom, bottom.big_ring, builder);
    add_foot(d, bar_bottom, bottom.small_ring, builder);
    add_arm_pin(d, top.small_ring, builder);
}

}  // namespace

ShapeDefinition arm_definition() {
    return {
        {"arm",
         "four-bar linkage, crank or rocker: flat bar with a journal below one end and a pin on the other; origin on the journal's axis, "
         "at the coupler's mid-plane, pin at (arm_length, 0)",
         {{"arm_length", 0.018, "distance of the pin's axis from the journal's"},
          {"journal_radius", 0.0042, "radius of the journal in the base's bore"},
          {"pin_radius", 0.0032, "radius of the pin in the coupler's bore"},
          {"journal_end_radius", 0.0075, "radius of the bar's rounded end about the journal"},
          {"pin_end_radius", 0.006, "radius of the bar's rounded end about the pin"},
          {"bar_top", -0.0023, "z of the bar's top face, on which the coupler rides", DimensionKind::coordinate},
          {"bar_thickness", 0.004, "thickness of the bar"},
          {"shoulder_radius", 0.0065, "radius of the step about the journal that runs on the base"},
          {"foot_radius", 0.004, "radius of the foot under the pin that runs on the base"},
          {"shoulder_height", 0.001, "height of that step and of the foot"},
          {"journal_length", 0.0056, "length of the journal: the base's thickness and the play above and below it"},
          {"journal_collar_radius", 0.0062, "radius of the collar that retains the journal under the base"},
          {"journal_collar_thickness", 0.002, "thickness of that collar"},
          {"pin_length", 0.0046, "length of the pin: the coupler's thickness and the play above and below it"},
          {"pin_head_radius", 0.0048, "radius of the head that retains the coupler on the pin"},
          {"pin_head_thickness", 0.0016, "thickness of that head"}}},
        arm_relations,
        build_arm};
}

}  // namespace fettle::design::shapes
