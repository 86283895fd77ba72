// SPDX-License-Identifier: MIT
#include "core/parts/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/contract.hpp"
#include "core/base/units.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/curve_meetings.hpp"
#include "core/parts/fault_words.hpp"

namespace fettle::core::parts {
namespace {

Error fault(const std::string& feature, const std::string& message) { return {ErrorCode::inconsistent, feature, message}; }

void replace_start(Curve& curve, const Point2& start) {
    if (auto* bezier = std::get_if<Bezier>(&curve))
        bezier->points.front() = start;
    else
        std::visit(
            [&](auto& c) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(c)>, Bezier>) c.start = start;
            },
            curve);
}

void replace_end(Curve& curve, const Point2& end) {
    if (auto* bezier = std::get_if<Bezier>(&curve))
        bezier->points.back() = end;
    else
        std::visit(
            [&](auto& c) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(c)>, Bezier>) c.end = end;
            },
            curve);
}

double size_of(const std::vector<Segment>& segments) {
    Vector2 low = Vector2::Constant(INFINITY), high = -low;
    for (const Segment& segment : segments) {
        for (const double u : {0.0, 0.5, 1.0}) {
            const Vector2 p = at(segment.curve, u).position;
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    return segments.empty() ? 0 : (high - low).norm();
}

Vector2 direction_of(const Vector2& v) { return v.norm() > 0 ? Vector2(v.normalized()) : Vector2(Vector2::Zero()); }
Vector2 direction_at(const Curve& curve, double u) {
    const Vector2 v = at(curve, u).velocity;
    return direction_of(v.norm() > 0 ? v : at(curve, u < 0.5 ? u + 1e-7 : u - 1e-7).velocity);
}

// What is left of two curves that meet in a corner, and the curve between them.
struct CutCorner {
    Curve before, between, after;
};

Cut touching(const Curve& curve, const Cut& on_beside, const Point2& centre, const Number& radius) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Point2 d = line->end - line->start;
        const Number u = dot(centre - line->start, d) / dot(d, d);
        return {u.value, u, line->start + u * d};
    }
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const Point2 out = centre - arc->centre;
        return {on_beside.u, on_beside.u, arc->centre + (arc->radius / length(out)) * out};
    }
    (void)radius;
    return {on_beside.u, on_beside.parameter, point_at(curve, on_beside.parameter)};
}

Result<CutCorner> rounded_corner(const Curve& before, const Curve& after, const Number& radius, const std::string& feature) {
    const Vector2 in = direction_at(before, 1), out = direction_at(after, 0);
    const double turn = in.x() * out.y() - in.y() * out.x();
    const Number aside = turn > 0 ? radius : -radius;
    const auto a = beside(before, aside), b = beside(after, aside);
    const Vector2 corner = value(end_of(before));
    const auto too_large = [&] {
        return fault(feature, "the radius " + millimetres(radius.value) + " at " + place(corner) + " of " + quoted_outline(feature) +
                                  " is too large for the curves that meet there: take a smaller one");
    };
    if (!a || !b) return too_large();
    const double size = std::max(sampled_length(before), sampled_length(after));
    std::optional<CutCorner> best;
    double nearest = INFINITY;
    for (const Meeting& m : extended_meetings(*a, *b, same_place * size)) {
        const Point2& centre = m.on_a.point;
        const Cut end = touching(before, m.on_a, centre, radius), start = touching(after, m.on_b, centre, radius);
        // On the curves, from the corner on; the whole of one may go.
        if (end.u < -1e-12 || end.u > 1 || start.u < 0 || start.u > 1 + 1e-12) continue;
        const double far = (value(end.point) - corner).norm() + (value(start.point) - corner).norm();
        if (far >= nearest) continue;
        nearest = far;
        best = CutCorner{parts::between(before, {0, 0, start_of(before)}, end), Arc{end.point, start.point, centre, radius, turn > 0},
                         parts::between(after, start, {1, 1, end_of(after)})};
    }
    if (!best) return too_large();
    return *best;
}

// The point at a distance along a curve from its end (or start).
std::optional<Cut> at_length(const Curve& curve, const Number& distance, bool from_end) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Point2 d = line->end - line->start;
        const Number share = distance / length(d), u = from_end ? 1.0 - share : share;
        if (u.value < -1e-12 || u.value > 1 + 1e-12) return std::nullopt;
        return Cut{u.value, u, line->start + u * d};
    }
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const Number share = distance / (arc->radius * abs(sweep_of(*arc))), u = from_end ? 1.0 - share : share;
        if (u.value < 0 || u.value > 1) return std::nullopt;
        return Cut{u.value, u, point_at(curve, u)};
    }
    return std::nullopt;
}

Result<CutCorner> chamfered_corner(const Curve& before, const Curve& after, const Corner& corner, const std::string& feature) {
    const auto end = at_length(before, corner.before, true), start = at_length(after, corner.after, false);
    const std::string where = place(value(end_of(before))) + " of " + quoted_outline(feature);
    if (is_general(before) || is_general(after))
        return fault(feature, "the chamfer at " + where + " meets a spline or a curve of a law: round the corner instead");
    if (!end || !start)
        return fault(feature, "the chamfer of " + millimetres(std::max(corner.before.value, corner.after.value)) + " at " + where +
                                  " is longer than the curves that meet there: take a smaller one");
    return CutCorner{parts::between(before, {0, 0, start_of(before)}, *end), Line{end->point, start->point},
                     parts::between(after, *start, {1, 1, end_of(after)})};
}

bool has_angle(const Curve& before, const Curve& after) {
    const Vector2 in = direction_at(before, 1), out = direction_at(after, 0);
    return std::abs(in.x() * out.y() - in.y() * out.x()) > 1e-7 || in.dot(out) < 0;
}

// Corners before segments, by index; cut one after another, since one segment may lose at both ends.
Result<Loop> with_corners(Loop loop, const std::vector<std::pair<std::size_t, Corner>>& corners) {
    const std::size_t n = loop.segments.size();
    std::vector<std::optional<Segment>> cuts(n);
    Errors errors;
    for (const auto& [index, corner] : corners) {
        if (n < 2) break;
        Segment &before = loop.segments[(index + n - 1) % n], &after = loop.segments[index % n];
        if (!has_angle(before.curve, after.curve)) continue;
        const std::string& feature = before.feature;
        const auto cut = corner.radius.value > 0 ? rounded_corner(before.curve, after.curve, corner.radius, feature)
                                                 : chamfered_corner(before.curve, after.curve, corner, feature);
        if (!cut) {
            errors.insert(errors.end(), cut.errors().begin(), cut.errors().end());
            continue;
        }
        cuts[index % n] = Segment{cut->between, corner.feature.empty() ? before.feature : corner.feature, before.facets};
        before.curve = cut->before;
        after.curve = cut->after;
    }
    if (!errors.empty()) return errors;
    const double size = size_of(loop.segments);
    Loop out;
    const auto add = [&](const Segment& segment) {
        // A curve that corners have used up is left out.
        if (!std::holds_alternative<Arc>(segment.curve) && sampled_length(segment.curve) <= same_place * size) return;
        const auto* arc = std::get_if<Arc>(&segment.curve);
        if (arc != nullptr && n > 1 && (value(arc->start) - value(arc->end)).norm() <= same_place * size) return;
        out.segments.push_back(segment);
    };
    for (std::size_t k = 0; k < n; ++k) {
        if (cuts[k]) add(*cuts[k]);
        add(loop.segments[k]);
    }
    // What was left out leaves its neighbours with ends that differ by rounding.
    const std::size_t left = out.segments.size();
    for (std::size_t k = 0; k < left; ++k) replace_start(out.segments[(k + 1) % left].curve, end_of(out.segments[k].curve));
    return out;
}

}  // namespace

Path::Path(const Point2& start, std::string feature) : start_(start), feature_(std::move(feature)) {}

Path& Path::feature(std::string name) {
    feature_ = std::move(name);
    return *this;
}

Path& Path::facets(const Facets& facets) {
    facets_ = facets;
    return *this;
}

Point2 Path::end() const { return segments_.empty() ? start_ : end_of(segments_.back().curve); }

Path& Path::add(Curve curve) {
    segments_.push_back({std::move(curve), feature_, facets_});
    return *this;
}

Path& Path::line_to(const Point2& end) {
    if (value(end) == value(this->end())) {
        faults_.push_back(fault(feature_, "a line of " + quoted_outline(feature_) + " at " + place(value(end)) + " has no length"));
        return *this;
    }
    return add(Line{this->end(), end});
}

Path& Path::arc_about(const Point2& centre, const Point2& end, bool counter_clockwise) {
    const Point2 start = this->end();
    const double at_start = (value(start) - value(centre)).norm(), at_end = (value(end) - value(centre)).norm();
    if (!(at_start > 0) || !(std::abs(at_start - at_end) <= same_place * at_start)) {
        faults_.push_back(fault(feature_, "an arc of " + quoted_outline(feature_) + " about " + place(value(centre)) + " begins " +
                                              millimetres(at_start) + " from its centre and ends " + millimetres(at_end) +
                                              " from it: the two must be equal"));
        return *this;
    }
    return add(Arc{start, end, centre, length(start - centre), counter_clockwise});
}

Path& Path::arc_through(const Point2& middle, const Point2& end) {
    const Point2 start = this->end(), a = middle - start, b = end - start;
    const Number twice_area = cross(a, b);
    if (!(std::abs(twice_area.value) > 1e-9 * value(a).norm() * value(b).norm())) {
        faults_.push_back(fault(feature_, "an arc of " + quoted_outline(feature_) + " through " + place(value(start)) + ", " +
                                              place(value(middle)) + " and " + place(value(end)) + ": the points lie on one line"));
        return *this;
    }
    const Number aa = dot(a, a), bb = dot(b, b);
    const Point2 to_centre{(aa * b.y - bb * a.y) / (2.0 * twice_area), (bb * a.x - aa * b.x) / (2.0 * twice_area)};
    // Through the middle counter-clockwise: the end is to the left of the way to the middle.
    return add(Arc{start, end, start + to_centre, length(to_centre), twice_area.value > 0});
}

Path& Path::tangent_arc_to(const Point2& end) {
    if (segments_.empty()) {
        faults_.push_back(fault(feature_, "a tangent arc of " + quoted_outline(feature_) + " has no curve before it"));
        return *this;
    }
    const Point2 tangent = tangent_at(segments_.back().curve, 1.0), start = this->end(), chord = end - start;
    const Number side = cross(tangent, chord);
    if (!(std::abs(side.value) > 1e-9 * value(tangent).norm() * value(chord).norm())) {
        faults_.push_back(fault(feature_, "a tangent arc of " + quoted_outline(feature_) + " to " + place(value(end)) +
                                              ": it would go straight on or straight back; draw a line"));
        return *this;
    }
    // The centre is at `radius` to the left of the tangent, as far from the end: radius = |chord|^2 |tangent| / (2 cross).
    const Number scale = dot(chord, chord) / (2.0 * side);
    const Point2 centre = start + scale * left_of(tangent);
    return add(Arc{start, end, centre, abs(scale) * length(tangent), side.value > 0});
}

Path& Path::bulge_to(const Point2& end, const Number& bulge) {
    const Point2 start = this->end(), chord = end - start;
    if (!(std::abs(bulge.value) > 1e-12) || value(chord).norm() == 0) {
        faults_.push_back(
            fault(feature_, "an arc of " + quoted_outline(feature_) + " to " + place(value(end)) + " has no bulge: draw a line"));
        return *this;
    }
    // tan(sweep / 2) = 2 b / (1 - b^2): the centre is at |chord| (1 - b^2) / (4 b) to the left of the chord's middle.
    const Point2 centre = start + 0.5 * chord + ((1.0 - bulge * bulge) / (4.0 * bulge)) * left_of(chord);
    return add(Arc{start, end, centre, length(chord) * (1.0 + bulge * bulge) / abs(4.0 * bulge), bulge.value > 0});
}

Path& Path::arc_by(const Point2& centre, const Number& angle) {
    const Point2 start = this->end();
    if (!(std::abs(angle.value) > 0) || std::abs(angle.value) >= full_turn || value(start) == value(centre)) {
        faults_.push_back(fault(feature_, "an arc of " + quoted_outline(feature_) + " about " + place(value(centre)) +
                                              " turns by some angle between 0 and 360 deg, at a distance from its centre"));
        return *this;
    }
    return add(Arc{start, centre + turned(start - centre, direction(angle)), centre, length(start - centre), angle.value > 0});
}

Path& Path::spline_through(const std::vector<Point2>& points) {
    std::vector<Point2> all{end()};
    all.insert(all.end(), points.begin(), points.end());
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
        if (value(all[k]) != value(all[k + 1])) continue;
        faults_.push_back(fault(feature_, "a spline of " + quoted_outline(feature_) + " goes twice through " + place(value(all[k]))));
        return *this;
    }
    if (all.size() > 1)
        for (const Bezier& bezier : parts::spline_through(all)) add(bezier);
    return *this;
}

Path& Path::spline_by(const std::vector<Point2>& control_points) {
    std::vector<Point2> all{end()};
    all.insert(all.end(), control_points.begin(), control_points.end());
    if (all.size() > 1)
        for (const Bezier& bezier : b_spline(all)) add(bezier);
    return *this;
}

Path& Path::along(const LawCurve& curve) { return along(std::vector<Segment>{{curve, feature_, facets_}}); }

Path& Path::along(const std::vector<Segment>& segments) {
    if (segments.empty()) return *this;
    const Vector2 there = value(start_of(segments.front().curve)), here = value(end());
    std::vector<Segment> follow = segments;
    if ((there - here).norm() > same_place * size_of(segments))
        line_to(start_of(segments.front().curve));
    else
        replace_start(follow.front().curve, end());
    segments_.insert(segments_.end(), follow.begin(), follow.end());
    return *this;
}

Path& Path::round(const Number& radius, std::string feature) {
    if (radius.value > 0) corners_.push_back({segments_.size(), {radius, 0, 0, std::move(feature)}});
    if (radius.value < 0)
        faults_.push_back(
            fault(feature_, "the radius " + millimetres(radius.value) + " of a corner of " + quoted_outline(feature_) + " is negative"));
    return *this;
}

Path& Path::chamfer(const Number& distance, std::string feature) { return chamfer(distance, distance, std::move(feature)); }

Path& Path::chamfer(const Number& before, const Number& after, std::string feature) {
    if (before.value > 0 && after.value > 0)
        corners_.push_back({segments_.size(), {0, before, after, std::move(feature)}});
    else if (before.value < 0 || after.value < 0 || before.value != after.value)
        faults_.push_back(fault(feature_, "a chamfer of " + quoted_outline(feature_) + " is " + millimetres(before.value) + " by " +
                                              millimetres(after.value) + ": both must be greater than 0, or both 0"));
    return *this;
}

Result<Loop> Path::closed() const {
    if (!faults_.empty()) return faults_;
    Loop loop{segments_};
    if (loop.segments.empty()) return fault(feature_, quoted_outline(feature_) + " has no curves");
    const double gap = (value(end()) - value(start_)).norm();
    if (gap > same_place * size_of(segments_))
        loop.segments.push_back({Line{end(), start_}, feature_, facets_});
    else if (gap > 0)
        replace_end(loop.segments.back().curve, start_of(loop.segments.front().curve));
    if (loop.segments.size() == 1 && std::holds_alternative<Line>(loop.segments.front().curve))
        return fault(feature_, quoted_outline(feature_) + " is a single line");
    return with_corners(std::move(loop), corners_);
}

Loop circle(const Point2& centre, const Number& radius, std::string feature) {
    const Point2 start = centre + Point2{radius, 0};
    return {{{Arc{start, start, centre, radius, true}, std::move(feature), std::nullopt}}};
}

Loop rectangle(const Point2& corner, const Number& width, const Number& height, std::string feature) {
    return polygon({corner, corner + Point2{width, 0}, corner + Point2{width, height}, corner + Point2{0, height}}, std::move(feature));
}

Loop polygon(const std::vector<Point2>& corners, std::string feature) {
    Loop loop;
    for (std::size_t k = 0; k < corners.size(); ++k)
        loop.segments.push_back({Line{corners[k], corners[(k + 1) % corners.size()]}, feature, std::nullopt});
    return loop;
}

Loop slot(const Point2& a, const Point2& b, const Number& radius, std::string feature) {
    const Point2 d = b - a, aside = (radius / length(d)) * left_of(d);
    const Point2 al = a + aside, ar = a - aside, bl = b + aside, br = b - aside;
    return {{{Line{ar, br}, feature, {}},
             {Arc{br, bl, b, radius, true}, feature, {}},
             {Line{bl, al}, feature, {}},
             {Arc{al, ar, a, radius, true}, feature, {}}}};
}

namespace {

Result<Loop> with_all_corners(const Loop& loop, const Corner& corner, Corners which) {
    const std::size_t n = loop.segments.size();
    double area = 0;  // by the segments' samples: which way round it runs
    for (const Segment& segment : loop.segments) {
        const int count = sample_count(segment.curve);
        for (int k = 0; k < count; ++k) {
            const Vector2 p = at(segment.curve, static_cast<double>(k) / count).position, q = at(segment.curve, (k + 1.0) / count).position;
            area += p.x() * q.y() - p.y() * q.x();
        }
    }
    std::vector<std::pair<std::size_t, Corner>> corners;
    for (std::size_t k = 0; k < n; ++k) {
        const Curve &before = loop.segments[(k + n - 1) % n].curve, &after = loop.segments[k].curve;
        const Vector2 in = direction_at(before, 1), out = direction_at(after, 0);
        const bool convex = (in.x() * out.y() - in.y() * out.x() > 0) == (area > 0);
        if (which == Corners::all || convex == (which == Corners::convex)) corners.push_back({k, corner});
    }
    return with_corners(loop, corners);
}

}  // namespace

Result<Loop> rounded(const Loop& loop, const Number& radius, Corners which, std::string feature) {
    if (radius.value == 0) return loop;
    if (radius.value < 0) return fault(feature, "a radius of corners is " + millimetres(radius.value) + ": it must not be negative");
    return with_all_corners(loop, {radius, 0, 0, std::move(feature)}, which);
}

Result<Loop> chamfered(const Loop& loop, const Number& distance, Corners which, std::string feature) {
    if (distance.value == 0) return loop;
    if (distance.value < 0) return fault(feature, "a chamfer is " + millimetres(distance.value) + ": it must not be negative");
    return with_all_corners(loop, {0, distance, distance, std::move(feature)}, which);
}

}  // namespace fettle::core::parts
