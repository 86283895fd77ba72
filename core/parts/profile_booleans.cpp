// SPDX-License-Identifier: MIT
#include "fettle/core/parts/profile_booleans.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fettle/core/base/units.hpp"
#include "fettle/core/parts/arrangement.hpp"
#include "fettle/core/parts/sampled_profile.hpp"

namespace fettle::core::parts {
namespace {

constexpr double same_place = 1e-9;  // of the size of what is cut

enum class Operation { unite, subtract, intersect };

double joint_size(const Profile& a, const Profile& b) {
    const SampledProfile sa(a), sb(b);
    return (sa.high().cwiseMax(sb.high()) - sa.low().cwiseMin(sb.low())).norm();
}

// Pieces that lie on a piece of the other group, by the nodes they join.
class Coincidence {
public:
    explicit Coincidence(const Arrangement& arrangement) : arrangement_(arrangement) {
        for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) by_nodes_[key(arrangement.pieces[k])].push_back(k);
    }

    /// 1, -1: one lies on it in the same, the opposite direction; 0: none. `other` is which.
    int find(std::size_t piece, bool of_other_group, std::size_t& other) const {
        const Piece& a = arrangement_.pieces[piece];
        for (const std::size_t k : by_nodes_.at(key(a))) {
            const Piece& b = arrangement_.pieces[k];
            if (k == piece || (of_other_group && group(a) == group(b))) continue;
            other = k;
            if (const int way = arrangement_.coincide(a, b); way != 0) return way;
        }
        return 0;
    }

private:
    int group(const Piece& piece) const { return arrangement_.curves[piece.source].group; }
    static std::pair<int, int> key(const Piece& piece) { return std::minmax(piece.from, piece.to); }

    const Arrangement& arrangement_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> by_nodes_;
};

Result<Profile> combined(const Profile& a, const Profile& b, Operation operation) {
    if (a.loops.empty()) return operation == Operation::unite ? b : Profile{};
    if (b.loops.empty()) return operation == Operation::intersect ? Profile{} : a;
    std::vector<ArrangedCurve> curves;
    for (const int group : {0, 1})
        for (const Loop& loop : (group == 0 ? a : b).loops)
            for (const Segment& segment : loop.segments) curves.push_back({segment, group});
    const Arrangement arrangement = arranged(std::move(curves), same_place * joint_size(a, b), false);
    const SampledProfile in_a(a), in_b(b);
    const Coincidence coincidence(arrangement);
    std::vector<Piece> kept;
    for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
        const Piece& piece = arrangement.pieces[k];
        const bool of_a = arrangement.curves[piece.source].group == 0;
        std::size_t other = 0;
        if (const int way = coincidence.find(k, true, other); way != 0) {
            // Once, and only where the material of both is on the same side (for a difference: on opposite ones).
            if (of_a && (way > 0) == (operation != Operation::subtract)) kept.push_back(piece);
            continue;
        }
        const bool inside = (of_a ? in_b : in_a).contains(arrangement.middle_of(piece));
        if (operation == Operation::subtract && !of_a) {
            if (inside) kept.push_back(turned_round(piece));
        } else if (inside == (operation == Operation::intersect)) {
            kept.push_back(piece);
        }
    }
    auto loops = loops_from(arrangement, kept);
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
            const int parts = is_general(segment.curve) ? std::max(6, static_cast<int>(std::ceil(turning(segment.curve) / 0.4))) : 1;
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
            const bool turns_left = in.x() * away.y() - in.y() * away.x() > 0;
            if (turns_left == (distance.value > 0)) continue;  // they overlap there
            out.push_back({{Arc{start, end, corner, abs(distance), turns_left}, loop.segments[k].feature, loop.segments[k].facets}, 0});
        }
    }
    return out;
}

}  // namespace

Result<Profile> united(const Profile& a, const Profile& b) { return combined(a, b, Operation::unite); }
Result<Profile> difference(const Profile& a, const Profile& b) { return combined(a, b, Operation::subtract); }
Result<Profile> intersection(const Profile& a, const Profile& b) { return combined(a, b, Operation::intersect); }

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
    const SampledProfile original(profile);
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
