// SPDX-License-Identifier: MIT
#include "core/parts/faceted_profile.hpp"

#include <algorithm>

#include "core/base/units.hpp"
#include "core/parts/fault_words.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Edge;
using geometry::Triangle;

void add_point(FacetedLoop& loop, const Point2& p, int curve) {
    // Points that coincide are one: a curve may end where it begins to rounding.
    if (!loop.points.empty() && value(loop.points.back()) == value(p)) {
        loop.curve.back() = curve;
        return;
    }
    loop.points.push_back(p);
    loop.curve.push_back(curve);
}

// Triangles and the loops that they belong to, as plain numbers.
std::vector<int> packed(const PlaneRegion& region, const std::vector<Triangle>& triangles) {
    std::vector<int> out{count_of(region.loops)};
    for (const auto& loop : region.loops) out.push_back(count_of(loop));
    for (const Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
    return out;
}

std::vector<Triangle> unpacked(const PlaneRegion& region, const std::vector<int>& numbers) {
    const std::size_t head = region.loops.size() + 1;
    if (numbers.size() < head || (numbers.size() - head) % 3 != 0 || numbers[0] != count_of(region.loops)) return {};
    for (std::size_t k = 0; k < region.loops.size(); ++k)
        if (numbers[k + 1] != count_of(region.loops[k])) return {};
    std::vector<Triangle> out;
    for (std::size_t k = head; k < numbers.size(); k += 3) out.push_back({numbers[k], numbers[k + 1], numbers[k + 2]});
    return out;
}

Error fault_of(const FacetedProfile& profile, const std::optional<std::array<Edge, 2>>& crossing, const std::string& what) {
    if (!crossing)
        return {ErrorCode::inconsistent, profile.curves.front().feature, what + ": its loops overlap or run the wrong way round"};
    const auto at_point = [&](int point) {
        for (const FacetedLoop& loop : profile.loops) {
            const int count = count_of(loop.points);
            if (point < count) {
                const auto k = static_cast<std::size_t>(point);
                return std::pair{profile.curves[loop.curve[k]].feature, value(loop.points[k])};
            }
            point -= count;
        }
        return std::pair{std::string(), Vector2(0, 0)};
    };
    const auto [a, p] = at_point((*crossing)[0][0]);
    const std::string b = at_point((*crossing)[1][0]).first;
    return {ErrorCode::inconsistent, a,
            "the facets of " + quoted_curve(a) + (a == b ? " cross each other" : " cross those of " + quoted_curve(b)) + " near " +
                place(p) + ": take more segments, or leave more room"};
}

}  // namespace

std::size_t FacetedProfile::point_count() const {
    std::size_t count = 0;
    for (const FacetedLoop& loop : loops) count += loop.points.size();
    return count;
}

Result<FacetedProfile> faceted(Drawing& drawing, const Profile& profile) {
    if (profile.loops.empty()) return Error{ErrorCode::inconsistent, {}, "a profile is empty: nothing of it is left"};
    FacetedProfile out;
    std::vector<int> kinds;
    for (const Loop& loop : profile.loops) {
        kinds.push_back(-count_of(loop.segments));
        for (const Segment& segment : loop.segments) kinds.push_back(static_cast<int>(segment.curve.index()));
    }
    drawing.note("outline of " + quoted_curve(profile.loops.front().segments.front().feature), kinds);
    for (const Loop& loop : profile.loops) {
        FacetedLoop polygon;
        for (const Segment& segment : loop.segments) {
            const Facets& facets = segment.facets ? *segment.facets : drawing.facets;
            if (!(facets.chord > 0) && facets.segments < 3)
                return Error{ErrorCode::out_of_range, segment.feature,
                             "a circle is drawn with " + std::to_string(facets.segments) + " segments: it takes at least 3"};
            const int index = count_of(out.curves);
            Chain chain;
            if (!std::holds_alternative<Line>(segment.curve)) {
                const int count =
                    drawing.count("segments of " + quoted_curve(segment.feature), [&] { return facet_count(segment.curve, facets); });
                if (count >= most_segments) return too_many_segments(segment.feature, quoted_curve(segment.feature), facets);
                chain = chain_of(segment.curve, count, facets.lean);
            }
            out.curves.push_back({segment.curve, segment.feature, chain.out, chain.in, chain.proven});
            if (chain.through_start) add_point(polygon, start_of(segment.curve), index);
            for (const Point2& p : chain.inner) add_point(polygon, p, index);
        }
        if (polygon.points.size() > 1 && value(polygon.points.front()) == value(polygon.points.back())) {
            polygon.points.pop_back();
            polygon.curve.pop_back();
        }
        if (polygon.points.size() < 3) {
            const std::string& feature = loop.segments.front().feature;
            return Error{
                ErrorCode::out_of_range, feature,
                quoted_curve(feature) + " becomes a polygon of " + std::to_string(polygon.points.size()) + " points: take more segments"};
        }
        out.loops.push_back(std::move(polygon));
    }
    return out;
}

PlaneRegion region_of(const FacetedProfile& profile) {
    PlaneRegion region;
    for (const FacetedLoop& loop : profile.loops) {
        std::vector<int> indices;
        for (const Point2& p : loop.points) {
            indices.push_back(count_of(region.points));
            region.points.push_back(value(p));
        }
        region.loops.push_back(std::move(indices));
    }
    return region;
}

Result<std::vector<Triangle>> face_triangles(Drawing& drawing, const FacetedProfile& profile, const std::string& feature) {
    const PlaneRegion region = region_of(profile);
    std::optional<std::array<Edge, 2>> crossing;
    const std::string what = "end face of " + quoted_curve(feature);
    const auto numbers = drawing.decision(
        what,
        [&](const std::vector<int>& kept) {
            const auto triangles = unpacked(region, kept);
            return !triangles.empty() && fits(region, triangles);
        },
        [&] {
            const Triangulation made = triangulated(region);
            crossing = made.crossing;
            return packed(region, made.triangles);
        });
    std::vector<Triangle> triangles = unpacked(region, numbers);
    if (!triangles.empty()) return triangles;
    return fault_of(profile, crossing, what);
}

std::optional<Error> face_fault(const FacetedProfile& profile) {
    const Triangulation made = triangulated(region_of(profile));
    if (!made.triangles.empty()) return std::nullopt;
    return fault_of(profile, made.crossing, "the profile");
}

Side side_of(double out, double in) {
    if (out > 0) return in > 0 ? Side::both : Side::outside;
    return in > 0 ? Side::inside : Side::on;
}

}  // namespace fettle::core::parts
