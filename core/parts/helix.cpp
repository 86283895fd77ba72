// SPDX-License-Identifier: MIT
#include "core/parts/helix.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/turned_sections.hpp"

namespace fettle::core::parts {
namespace {

int steps_of(Drawing& drawing, const std::string& name, double radius, double angle) {
    return drawing.count("steps of the turn of " + quoted_profile(name), [&] {
        // A turn's worth of segments for each turn.
        const double turns = std::abs(angle) / full_turn, a_turn = segments_of(drawing.facets, radius, full_turn);
        return std::max(1, static_cast<int>(std::ceil(turns * a_turn - 1e-9)));
    });
}

}  // namespace

Result<Solid> along_helix(Drawing& drawing, const Profile& profile, const Number& pitch, const Number& turns) {
    const auto section = faceted(drawing, profile);
    if (!section) return section.errors();
    const std::string name = profile.loops.front().segments.front().feature;
    if (!(turns.value > 0)) return Error{ErrorCode::out_of_range, name, quoted_profile(name) + " runs along a helix of no turns"};
    double nearest = INFINITY, farthest = 0, low = INFINITY, high = -INFINITY;
    for (const FacetedLoop& loop : section->loops) {
        for (const Point2& p : loop.points) {
            nearest = std::min(nearest, p.x.value);
            farthest = std::max(farthest, p.x.value);
            low = std::min(low, p.y.value);
            high = std::max(high, p.y.value);
        }
    }
    if (!(nearest > 0))
        return Error{ErrorCode::out_of_range, name,
                     quoted_profile(name) + " reaches over the axis of its helix by " + millimetres(-nearest)};
    if (turns.value >= 1 && !(high - low < std::abs(pitch.value)))
        return Error{ErrorCode::out_of_range, name,
                     quoted_profile(name) + " is " + millimetres(high - low) + " high and meets itself after a turn: the pitch is " +
                         millimetres(std::abs(pitch.value))};
    const Number angle = full_turn * turns;
    return turned_section(drawing, *section, SectionPlane::through_axis, 0, angle, pitch * turns,
                          steps_of(drawing, name, farthest, angle.value), name);
}

Result<Solid> twisted(Drawing& drawing, const Profile& profile, const Number& from, const Number& to, const Number& twist, int steps) {
    const auto section = faceted(drawing, profile);
    if (!section) return section.errors();
    const std::string name = profile.loops.front().segments.front().feature;
    if (!(to.value > from.value))
        return Error{ErrorCode::out_of_range, name, quoted_profile(name) + " has no height: " + millimetres(to.value - from.value)};
    double farthest = 0;
    for (const FacetedLoop& loop : section->loops)
        for (const Point2& p : loop.points) farthest = std::max(farthest, value(p).norm());
    if (steps <= 0) steps = steps_of(drawing, name, farthest, twist.value);
    return turned_section(drawing, *section, SectionPlane::across, from, twist, to - from, steps, name);
}

}  // namespace fettle::core::parts
