// SPDX-License-Identifier: MIT
#include "core/parts/levels.hpp"

#include <algorithm>

#include "core/base/units.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/inset.hpp"

namespace fettle::core::parts {
namespace {

bool same_shape(const FacetedProfile& a, const FacetedProfile& b) {
    if (a.loops.size() != b.loops.size()) return false;
    for (std::size_t l = 0; l < a.loops.size(); ++l)
        if (a.loops[l].curve != b.loops[l].curve) return false;
    return true;
}

// The profile, curve for curve with as many segments as the model has.
FacetedProfile polygons_like(const FacetedProfile& model, const Profile& profile, const Facets& facets) {
    FacetedProfile out;
    for (std::size_t l = 0; l < profile.loops.size(); ++l) {
        FacetedLoop polygon;
        const std::vector<int>& edges = model.loops[l].curve;
        for (const Segment& segment : profile.loops[l].segments) {
            const int index = count_of(out.curves);
            const int count = static_cast<int>(std::count(edges.begin(), edges.end(), index));
            const Lean lean = segment.facets ? segment.facets->lean : facets.lean;
            const auto* arc = std::get_if<Arc>(&segment.curve);
            // An arc whose flats touch the circle begins and ends with half a flat.
            const bool has_halves =
                arc != nullptr && !is_whole_circle(*arc) && lean != Lean::through && arc->counter_clockwise == (lean == Lean::cover);
            const Chain chain = chain_of(segment.curve, std::max(1, has_halves ? count - 1 : count), lean);
            out.curves.push_back({segment.curve, segment.feature, chain.out, chain.in, chain.proven});
            if (chain.through_start) polygon.points.push_back(start_of(segment.curve));
            polygon.points.insert(polygon.points.end(), chain.inner.begin(), chain.inner.end());
            polygon.curve.resize(polygon.points.size(), index);
        }
        out.loops.push_back(std::move(polygon));
    }
    return out;
}

bool is_none(const End& end) { return end.inset.is_constant() && end.inset.value == 0; }

}  // namespace

const std::string& name_of(const Layer& layer) {
    static const std::string none;
    if (!layer.feature.empty()) return layer.feature;
    const auto& loops = layer.profile.loops;
    return loops.empty() || loops.front().segments.empty() ? none : loops.front().segments.front().feature;
}

Result<std::vector<Level>> levels_of(Drawing& drawing, const Layer& layer) {
    const double height = layer.to.value - layer.from.value;
    const std::string& name = name_of(layer);
    if (!(height > 0)) return Error{ErrorCode::out_of_range, name, quoted_profile(name) + " has no height: " + millimetres(height)};
    double ends = 0;
    for (const End* end : {&layer.lower, &layer.upper}) {
        if (is_none(*end)) continue;
        if (!(end->height.value > 0))
            return Error{ErrorCode::out_of_range, name,
                         "the end of " + quoted_profile(name) + " draws in by " + millimetres(end->inset.value) + " over no height"};
        ends += end->height.value;
    }
    if (ends > height * (1 + 1e-12))
        return Error{ErrorCode::out_of_range, name,
                     "the ends of " + quoted_profile(name) + " draw in over " + millimetres(ends) + ", which is more than its height, " +
                         millimetres(height)};
    auto base = faceted(drawing, layer.profile);
    if (!base) return base.errors();
    const auto drawn_in = [&](const End& end) -> Result<FacetedProfile> {
        auto profile = inset(layer.profile, end.inset);
        if (!profile) return profile.errors();
        FacetedProfile out = polygons_like(*base, *profile, drawing.facets);
        if (!same_shape(*base, out))
            return Error{ErrorCode::out_of_range, name,
                         "the end of " + quoted_profile(name) + " cannot be drawn in: an edge vanishes; take a smaller inset"};
        return out;
    };
    std::vector<Level> levels;
    if (is_none(layer.lower)) {
        levels.push_back({*base, layer.from, true});
    } else {
        auto end = drawn_in(layer.lower);
        if (!end) return end.errors();
        levels.push_back({std::move(*end), layer.from, false});
        if (!(layer.lower.height.value >= height * (1 - 1e-12))) levels.push_back({*base, layer.from + layer.lower.height, true});
    }
    if (is_none(layer.upper)) {
        levels.push_back({std::move(*base), layer.to, true});
    } else {
        auto end = drawn_in(layer.upper);
        if (!end) return end.errors();
        const bool has_base = layer.to.value - layer.upper.height.value > levels.back().z.value + 1e-12 * height;
        if (has_base) levels.push_back({std::move(*base), layer.to - layer.upper.height, true});
        levels.back().straight_above = false;
        levels.push_back({std::move(*end), layer.to, true});
    }
    return levels;
}

}  // namespace fettle::core::parts
