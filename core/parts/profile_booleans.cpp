// SPDX-License-Identifier: MIT
#include "core/parts/profile_booleans.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/units.hpp"
#include "core/parts/arrangement.hpp"
#include "core/parts/sampled_loops.hpp"

namespace fettle::core::parts {
namespace {

double joint_size(const Profile& a, const Profile& b) {
    const SampledLoops sa(a.loops), sb(b.loops);
    return (sa.high().cwiseMax(sb.high()) - sa.low().cwiseMin(sb.low())).norm();
}

Result<Profile> combined(const Profile& a, const Profile& b, Combination combination) {
    if (a.loops.empty()) return combination == Combination::unite ? b : Profile{};
    if (b.loops.empty()) return combination == Combination::intersect ? Profile{} : a;
    std::vector<ArrangedCurve> curves;
    for (const int group : {0, 1})
        for (const Loop& loop : (group == 0 ? a : b).loops)
            for (const Segment& segment : loop.segments) curves.push_back({segment, group});
    const Arrangement arrangement = arranged(std::move(curves), same_place * joint_size(a, b), false);
    auto loops = loops_from(arrangement, bounding(arrangement, a.loops, b.loops, combination));
    if (!loops) return loops.errors();
    return Profile{std::move(*loops)};
}

Profile numbered(Profile profile, int k) {
    for (Loop& loop : profile.loops)
        for (Segment& segment : loop.segments)
            if (!segment.feature.empty()) segment.feature += " " + std::to_string(k + 1);
    return profile;
}

// Curves at the distance to the left, with arcs where they come apart at corners.
std::vector<ArrangedCurve> curves_beside(const Profile& profile, const Number& distance, double tolerance) {
    std::vector<ArrangedCurve> out;
    for (const Loop& loop : profile.loops) {
        const std::size_t n = loop.segments.size();
        std::vector<std::optional<Curve>> whole(n);
        for (std::size_t k = 0; k < n; ++k) {
            const Segment& segment = loop.segments[k];
            whole[k] = beside(segment.curve, distance);
            if (!whole[k]) continue;
            // A curve that bends more than the distance allows crosses itself: in parts it is cut there.
            const int parts =
                is_general(segment.curve) ? std::max(6, static_cast<int>(std::ceil(std::min(1e6, turning(segment.curve)) / 0.4))) : 1;
            Cut from{0, 0, start_of(*whole[k])};
            for (int i = 1; i <= parts; ++i) {
                const double u = static_cast<double>(i) / parts;
                const Cut to{u, u, i == parts ? end_of(*whole[k]) : point_at(*whole[k], u)};
                out.push_back({{parts == 1 ? *whole[k] : between(*whole[k], from, to), segment.feature, segment.facets}, 0});
                from = to;
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t next = (k + 1) % n;
            const Curve &before = loop.segments[k].curve, &after = loop.segments[next].curve;
            const Point2& corner = start_of(after);
            const auto foot = [&](const Curve& curve, double u, const std::optional<Curve>& moved) -> Point2 {
                if (moved) return u == 0 ? start_of(*moved) : end_of(*moved);
                const Point2 tangent = tangent_at(curve, u);  // its arc has shrunk to nothing, the corner has not
                return corner + (distance / length(tangent)) * left_of(tangent);
            };
            const Point2 start = foot(before, 1, whole[k]), end = foot(after, 0, whole[next]);
            if ((value(start) - value(end)).norm() <= 4 * tolerance) continue;
            const Vector2 in = at(before, 1).velocity, away = at(after, 0).velocity;
            const double turn = in.x() * away.y() - in.y() * away.x();
            // A cusp turns by half, either way: what its arc has too much of is cut off later.
            const bool is_cusp = in.dot(away) < 0 && std::abs(turn) <= 1e-6 * in.norm() * away.norm();
            const bool turns_left = is_cusp ? distance.value < 0 : turn > 0;
            if (turns_left == (distance.value > 0)) continue;  // they overlap there
            out.push_back({{Arc{start, end, corner, abs(distance), turns_left}, loop.segments[k].feature, loop.segments[k].facets}, 0});
        }
    }
    return out;
}

}  // namespace

Result<Profile> united(const Profile& a, const Profile& b) { return combined(a, b, Combination::unite); }
Result<Profile> difference(const Profile& a, const Profile& b) { return combined(a, b, Combination::subtract); }
Result<Profile> intersection(const Profile& a, const Profile& b) { return combined(a, b, Combination::intersect); }

Result<Profile> united(const std::vector<Profile>& profiles) {
    Profile out;
    for (const Profile& profile : profiles) {
        auto next = united(out, profile);
        if (!next) return next;
        out = std::move(*next);
    }
    return out;
}

Result<Profile> difference(const Profile& a, const std::vector<Profile>& cut) {
    Profile out = a;
    for (const Profile& profile : cut) {
        auto next = difference(out, profile);
        if (!next) return next;
        out = std::move(*next);
    }
    return out;
}

Result<Profile> polar_repeat(const Profile& profile, int count, const Point2& about) {
    std::vector<Profile> copies;
    for (int k = 0; k < count; ++k) copies.push_back(numbered(turned(profile, k, count, about), k));
    return united(copies);
}

Result<Profile> linear_repeat(const Profile& profile, int count, const Point2& step) {
    std::vector<Profile> copies;
    for (int k = 0; k < count; ++k) copies.push_back(numbered(moved(profile, Number(k) * step), k));
    return united(copies);
}

Result<Profile> offset(const Profile& profile, const Number& distance) {
    if (profile.loops.empty() || distance.value == 0) return profile;
    const SampledLoops original(profile.loops);
    const double tolerance = same_place * (original.size() + 2 * std::abs(distance.value));
    const Arrangement arrangement = arranged(curves_beside(profile, -distance, tolerance), tolerance, true);
    const Coincidence coincidence(arrangement);
    const double least = std::abs(distance.value) * (1 - 1e-7) - 4 * tolerance;
    std::vector<char> is_kept(arrangement.pieces.size(), 0);
    for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
        const Vector2 middle = arrangement.middle_of(arrangement.pieces[k]);
        is_kept[k] = original.nearest(middle).distance >= least && original.contains(middle) == (distance.value < 0);
    }
    std::vector<Piece> kept;
    for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
        if (!is_kept[k]) continue;
        std::size_t other = 0;
        const int way = coincidence.find(k, false, other);
        if (way < 0 && is_kept[other]) continue;               // nothing is left between the two
        if (way > 0 && is_kept[other] && other < k) continue;  // the same piece again
        kept.push_back(arrangement.pieces[k]);
    }
    auto loops = loops_from(arrangement, kept);
    if (!loops) return loops.errors();
    return Profile{std::move(*loops)};
}

}  // namespace fettle::core::parts
