// SPDX-License-Identifier: MIT
#include "core/parts/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/contract.hpp"
#include "core/base/units.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/curve_meetings.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/sampled_loops.hpp"

namespace fettle::core::parts {
namespace {

std::string degrees(double radians) {
    const double turn = radians < 0 ? radians + 2 * std::numbers::pi : radians;
    return format_quantity(turn, "deg", 4);
}

Loop reversed(const Loop& loop) {
    Loop out;
    for (auto segment = loop.segments.rbegin(); segment != loop.segments.rend(); ++segment)
        out.segments.push_back({reversed(segment->curve), segment->feature, segment->facets});
    return out;
}

const std::string& name_of(const Loop& loop) {
    static const std::string none;
    return loop.segments.empty() ? none : loop.segments.front().feature;
}

Vector2 middle_of(const Loop& loop) {
    if (loop.segments.size() == 1)
        if (const auto* arc = std::get_if<Arc>(&loop.segments.front().curve)) return value(arc->centre);
    const SampledLoops sampled({loop});
    return (sampled.low() + sampled.high()) / 2;
}

// A curve runs up to its end but for rounding and for what arc_about allows: how far two that are joined do not.
double gap_between(const Curve& before, const Curve& after) {
    return (at(before, 1).position - value(end_of(before))).norm() + (at(after, 0).position - value(start_of(after))).norm();
}

// Where a hole is nearest to the edge of what it is in, negative where it is outside of it.
struct Wall {
    double thickness = INFINITY;
    Vector2 place;
    std::string feature;  ///< of the edge
};

Wall thinnest_wall(const Profile& profile, const Loop& hole) {
    const SampledLoops sampled(profile.loops);
    Wall wall;
    const auto look = [&](const Vector2& p) {
        const auto nearest = sampled.nearest(p);
        const double thickness = sampled.contains(p) ? nearest.distance : -nearest.distance;
        if (thickness < wall.thickness) wall = {thickness, p, profile.loops[nearest.loop].segments[nearest.segment].feature};
        return thickness;
    };
    for (const Segment& segment : hole.segments) {
        const Curve curve = frozen(segment.curve);
        const int count = 4 * std::max(4, sample_count(curve));
        int best = 0;
        double least = INFINITY;
        for (int k = 0; k <= count; ++k) {
            const double thickness = look(at(curve, static_cast<double>(k) / count).position);
            if (thickness < least) {
                least = thickness;
                best = k;
            }
        }
        double low = std::max(0.0, (best - 1.0) / count), high = std::min(1.0, (best + 1.0) / count);
        for (int k = 0; k < 40; ++k) {
            const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
            if (look(at(curve, a).position) < look(at(curve, b).position))
                high = b;
            else
                low = a;
        }
    }
    return wall;
}

// Whether the loop and the profile have a point in common.
bool meet(const Profile& profile, const Loop& loop, double tolerance) {
    std::vector<std::pair<Curve, Box2>> pieces;
    Box2 all{Vector2::Constant(INFINITY), Vector2::Constant(-INFINITY)};
    for (const Segment& segment : loop.segments) {
        pieces.push_back({frozen(segment.curve), box_of(segment.curve)});
        all = {all.low.cwiseMin(pieces.back().second.low), all.high.cwiseMax(pieces.back().second.high)};
    }
    for (const Loop& other : profile.loops) {
        for (const Segment& segment : other.segments) {
            const Box2 box = box_of(segment.curve);
            if (!box.meets(all)) continue;
            const Curve curve = frozen(segment.curve);
            for (const auto& [piece, its_box] : pieces)
                if (box.meets(its_box) && !meetings(piece, curve, tolerance).empty()) return true;
        }
    }
    return false;
}

Placement2 turn_by(const Point2& d, const Point2& about) { return {d, left_of(d), about - turned(about, d), false}; }

Loop placed(const Loop& loop, const Placement2& placement) {
    Loop out;
    for (const Segment& segment : loop.segments)
        out.segments.push_back({placed(segment.curve, placement), segment.feature, segment.facets});
    // Ends that were shared stay so: the same point under the same placement.
    return out;
}

Profile placed(const Profile& profile, const Placement2& placement) {
    Profile out;
    for (const Loop& loop : profile.loops)
        out.loops.push_back(placement.mirrors ? reversed(placed(loop, placement)) : placed(loop, placement));
    return out;
}

Placement2 mirror_in(const Point2& point, const Point2& along) {
    // x -> 2 (x . e) e - x about the point, e of length 1.
    const Number square = dot(along, along), cosine = (along.x * along.x - along.y * along.y) / square,
                 sine = 2.0 * along.x * along.y / square;
    const Point2 x{cosine, sine}, y{sine, -cosine};
    return {x, y, point - (point.x * x + point.y * y), true};
}

Loop numbered(Loop loop, int k) {
    for (Segment& segment : loop.segments)
        if (!segment.feature.empty()) segment.feature += " " + std::to_string(k + 1);
    return loop;
}

// Gauss and Legendre's five points on [0, 1].
constexpr std::array<double, 5> gauss_points{0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155, 0.95308992296933200};
constexpr std::array<double, 5> gauss_weights{0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
                                              0.11846344252809454};

}  // namespace

Result<Profile> filled(const Loop& loop) {
    Profile profile{{sampled_area(loop) < 0 ? reversed(loop) : loop}};
    Errors faults = faults_of(profile);
    if (!faults.empty()) return faults;
    return profile;
}

Result<Profile> with_hole(const Profile& profile, const Loop& hole) { return with_holes(profile, {hole}); }

Result<Profile> with_holes(const Profile& profile, const std::vector<Loop>& holes) {
    Errors errors;
    Profile out = profile;
    for (const Loop& hole : holes) {
        const Loop inwards = sampled_area(hole) > 0 ? reversed(hole) : hole;
        const std::string& name = name_of(hole);
        for (const Error& error : faults_of(Profile{{reversed(inwards)}})) errors.push_back(error);
        if (profile.loops.empty()) {
            errors.push_back({ErrorCode::inconsistent, name, "hole " + quoted_curve(name) + " is in nothing: the profile is empty"});
            continue;
        }
        const SampledLoops around(out.loops);
        if (!around.contains(at(inwards.segments.front().curve, 0.3).position) || meet(out, inwards, same_place * around.size())) {
            const Wall wall = thinnest_wall(out, inwards);
            const Vector2 from_middle = wall.place - middle_of(inwards);
            errors.push_back({ErrorCode::inconsistent, name,
                              "hole " + quoted_curve(name) + " breaks through " + quoted_curve(wall.feature) + ": wall " +
                                  millimetres(wall.thickness) + " at " + degrees(std::atan2(from_middle.y(), from_middle.x()))});
            continue;
        }
        // What lies within the hole would float in it.
        const SampledLoops of_hole({inwards});
        for (const Loop& other : out.loops)
            if (of_hole.contains(at(other.segments.front().curve, 0.3).position))
                errors.push_back(
                    {ErrorCode::inconsistent, name, "hole " + quoted_curve(name) + " lies around " + quoted_curve(name_of(other))});
        out.loops.push_back(inwards);
    }
    if (!errors.empty()) return errors;
    return out;
}

Result<Profile> together(const std::vector<Profile>& profiles) {
    Profile out;
    for (const Profile& profile : profiles) out.loops.insert(out.loops.end(), profile.loops.begin(), profile.loops.end());
    Errors faults = faults_of(out);
    if (!faults.empty()) return faults;
    return out;
}

Errors faults_of(const Profile& profile) {
    struct Piece {
        Curve curve;
        const std::string* feature;
        std::size_t loop, index, count;
        Box2 box;
    };
    Errors faults;
    std::vector<Piece> pieces;
    Vector2 low = Vector2::Constant(INFINITY), high = -low;
    for (std::size_t l = 0; l < profile.loops.size(); ++l) {
        const Loop& loop = profile.loops[l];
        if (loop.segments.empty()) {
            faults.push_back({ErrorCode::inconsistent, {}, "a loop has no curves"});
            continue;
        }
        for (std::size_t s = 0; s < loop.segments.size(); ++s) {
            const Segment& segment = loop.segments[s];
            const Box2 box = box_of(segment.curve);
            if (!box.low.allFinite() || !box.high.allFinite()) {
                faults.push_back(
                    {ErrorCode::not_finite, segment.feature, quoted_curve(segment.feature) + " has points that are not finite"});
                return faults;
            }
            pieces.push_back({frozen(segment.curve), &segment.feature, l, s, loop.segments.size(), box});
            low = low.cwiseMin(box.low);
            high = high.cwiseMax(box.high);
        }
    }
    const double size = pieces.empty() ? 0 : (high - low).norm(), tolerance = same_place * size;
    for (std::size_t l = 0; l < profile.loops.size(); ++l)
        if (!profile.loops[l].segments.empty() && !(std::abs(sampled_area(profile.loops[l])) > tolerance * size))
            faults.push_back(
                {ErrorCode::inconsistent, name_of(profile.loops[l]), quoted_curve(name_of(profile.loops[l])) + " encloses no area"});
    if (!faults.empty()) return faults;

    std::vector<std::size_t> order(pieces.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return pieces[a].box.low.x() < pieces[b].box.low.x(); });
    for (std::size_t i = 0; i < order.size() && faults.size() < 5; ++i) {
        for (std::size_t j = i + 1; j < order.size() && pieces[order[j]].box.low.x() <= pieces[order[i]].box.high.x(); ++j) {
            const Piece &a = pieces[std::min(order[i], order[j])], &b = pieces[std::max(order[i], order[j])];
            if (!a.box.meets(b.box)) continue;
            const bool same_loop = a.loop == b.loop, b_follows = same_loop && (a.index + 1) % a.count == b.index,
                       a_follows = same_loop && (b.index + 1) % b.count == a.index;
            const auto is_joint = [&](const Curve& before, const Curve& after, const Vector2& p) {
                return (p - value(end_of(before))).norm() <= 4 * tolerance + 4 * gap_between(before, after);
            };
            for (const Meeting& m : meetings(a.curve, b.curve, tolerance)) {
                const Vector2 p = value(m.on_a.point);
                if (b_follows && is_joint(a.curve, b.curve, p)) continue;
                if (a_follows && is_joint(b.curve, a.curve, p)) continue;
                const std::string names = *a.feature == *b.feature
                                              ? (same_loop ? quoted_curve(*a.feature) + " crosses or touches itself"
                                                           : "two curves of " + quoted_curve(*a.feature) + " cross or touch")
                                              : quoted_curve(*a.feature) + " and " + quoted_curve(*b.feature) + " cross or touch";
                faults.push_back({ErrorCode::inconsistent, *a.feature, names + " at " + place(p)});
                break;
            }
            if (faults.size() >= 5) break;
        }
    }
    return faults;
}

Loop moved(const Loop& loop, const Point2& by) { return placed(loop, {{1, 0}, {0, 1}, by, false}); }
Loop turned(const Loop& loop, const Number& angle, const Point2& about) { return placed(loop, turn_by(direction(angle), about)); }
Loop mirrored(const Loop& loop, const Point2& point, const Point2& along) { return placed(loop, mirror_in(point, along)); }
Profile moved(const Profile& profile, const Point2& by) { return placed(profile, {{1, 0}, {0, 1}, by, false}); }
Profile turned(const Profile& profile, const Number& angle, const Point2& about) {
    return placed(profile, turn_by(direction(angle), about));
}
Profile turned(const Profile& profile, int k, int n, const Point2& about) { return placed(profile, turn_by(direction(k, n), about)); }
Profile mirrored(const Profile& profile, const Point2& point, const Point2& along) { return placed(profile, mirror_in(point, along)); }

std::vector<Loop> polar_copies(const Loop& loop, int count, const Point2& about) {
    std::vector<Loop> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(placed(loop, turn_by(direction(k, count), about)), k));
    return out;
}

std::vector<Loop> polar_copies(const Loop& loop, int count, const Number& step, const Point2& about) {
    std::vector<Loop> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(turned(loop, static_cast<double>(k) * step, about), k));
    return out;
}

std::vector<Loop> linear_copies(const Loop& loop, int count, const Point2& step) {
    std::vector<Loop> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(moved(loop, Number(k) * step), k));
    return out;
}

Number area(const Profile& profile) {
    Number twice = 0;
    for (const Loop& loop : profile.loops) {
        for (const Segment& segment : loop.segments) {
            const Curve& curve = segment.curve;
            if (!is_general(curve)) {
                const Point2 a = start_of(curve), b = end_of(curve);
                twice += cross(a, b);
                if (const auto* arc = std::get_if<Arc>(&curve)) {
                    const Number sweep = sweep_of(*arc);
                    twice += arc->radius * arc->radius * (sweep - sin(sweep));
                }
                continue;
            }
            const int pieces = std::holds_alternative<Bezier>(curve) ? 1 : sample_count(curve);
            for (int k = 0; k < pieces; ++k) {
                for (std::size_t g = 0; g < gauss_points.size(); ++g) {
                    const Number u = (k + gauss_points[g]) / pieces;
                    twice += (gauss_weights[g] / pieces) * cross(point_at(curve, u), tangent_at(curve, u));
                }
            }
        }
    }
    return 0.5 * twice;
}

}  // namespace fettle::core::parts
