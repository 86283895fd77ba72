// SPDX-License-Identifier: MIT
#include "core/parts/curve_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/contract.hpp"
#include "core/parts/law_chords.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Range;

constexpr double half_turn = std::numbers::pi;

template <class... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

// The whole number of things that are counted; the least where `count` is no number.
int whole_number(double count, int least) {
    return static_cast<int>(std::min<double>(most_segments, std::max<double>(least, std::ceil(count))));
}

double cross_of(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector2 turned_by(const Vector2& a, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * a.x() - s * a.y(), s * a.x() + c * a.y()};
}

double span_of(const LawCurve& curve) { return curve.to.value - curve.from.value; }

Jet<double> law_parameter(const LawCurve& curve, double u) { return Jet<double>::parameter(curve.from.value + u * span_of(curve)); }

// Bernstein's polynomials.
template <class T>
std::array<T, 4> bernstein(const T& u) {
    const T v = 1.0 - u;
    return {v * v * v, 3.0 * (u * (v * v)), 3.0 * ((u * u) * v), u * u * u};
}

template <class T>
std::array<T, 2> bezier_point(const Bezier& bezier, const T& u) {
    const auto b = bernstein<T>(u);
    std::array<T, 2> out{T(0.0), T(0.0)};
    for (std::size_t k = 0; k < 4; ++k) {
        out[0] = out[0] + b[k] * T(bezier.points[k].x);
        out[1] = out[1] + b[k] * T(bezier.points[k].y);
    }
    return out;
}

double largest_bend(const Bezier& bezier) {
    const auto p = [&](std::size_t k) { return value(bezier.points[k]); };
    return 6 * std::max((p(0) - 2 * p(1) + p(2)).norm(), (p(1) - 2 * p(2) + p(3)).norm());
}

// A Bezier as a law over u; for what only laws have.
std::shared_ptr<const Law> as_law(const Bezier& bezier) {
    auto law = std::make_shared<Law>([bezier](const auto& u) { return bezier_point<std::decay_t<decltype(u)>>(bezier, u); });
    law->largest_bend = [bezier](double, double) { return largest_bend(bezier); };
    return law;
}

// The law at a distance to the left of the direction of its rising parameter. Its jet has no second derivative.
template <class T>
std::array<Jet<T>, 2> jet_beside(const std::array<Jet<T>, 2>& p, const T& distance) {
    using std::hypot;
    const T x = p[0].first, y = p[1].first, speed = hypot(x, y);
    const T turn = (x * p[1].second - y * p[0].second) / (speed * speed);  // of the tangent, per parameter
    const T none = std::numeric_limits<double>::quiet_NaN();
    return {Jet<T>(p[0].value - distance * y / speed, x - distance * turn * x / speed, none),
            Jet<T>(p[1].value + distance * x / speed, y - distance * turn * y / speed, none)};
}

// The same over a stretch, with the second derivative. With the derivatives p1, p2, p3 of the law, its speed s and its curvature k they are
//     (1 - d k) p1,   (1 - d k) p2 - d k' p1,   where   k' = (x1 y3 - y1 x3) / s^3 - 3 k (p1 . p2) / s^2.
std::array<Jet<Range>, 2> ranges_beside(const Law& law, double distance, const Jet<Range>& t) {
    const auto [x, y] = law.higher_ranges({Jet<Range>::parameter(t.value), Jet<Range>(1.0), Jet<Range>(0.0)});
    const Range x1 = x.first.value, x2 = x.second.value, x3 = x.second.first, y1 = y.first.value, y2 = y.second.value, y3 = y.second.first;
    const Range speed = hypot(x1, y1), square = speed * speed, cube = square * speed;
    const Range curvature = (x1 * y2 - y1 * x2) / cube;
    const Range change = (x1 * y3 - y1 * x3) / cube - 3.0 * (curvature * (x1 * x2 + y1 * y2)) / square;
    const Range along = 1.0 - distance * curvature, bent = distance * change;
    const auto chained = [&](const Range& place, const Range& p1, const Range& p2) {
        const Range first = along * p1, second = along * p2 - bent * p1;
        return Jet<Range>(place, first * t.first, second * (t.first * t.first) + first * t.second);
    };
    return {chained(x.value.value - distance * (y1 / speed), x1, x2), chained(y.value.value + distance * (x1 / speed), y1, y2)};
}

std::shared_ptr<const Law> law_beside(const std::shared_ptr<const Law>& law, const Number& distance) {
    const auto base = law->offset_of ? law->offset_of : law;
    const Number all = law->offset_distance + distance;
    auto out = std::make_shared<Law>();
    out->offset_of = base;
    out->offset_distance = all;
    out->point = [base, all](const Number& t) {
        const auto p = base->jet(Jet<Number>::parameter(t));
        Point2 tangent{p[0].first, p[1].first};
        if (value(tangent).norm() == 0) tangent = {p[0].second, p[1].second};  // a cusp: it leaves in this direction
        const Number scale = all / length(tangent);
        return std::array<Number, 2>{p[0].value - scale * tangent.y, p[1].value + scale * tangent.x};
    };
    out->jet = [base, all](const Jet<Number>& t) {
        auto p = jet_beside(base->jet(Jet<Number>::parameter(t.value)), all);
        for (auto& x : p) x.first *= t.first;
        return p;
    };
    const double distance_value = all.value;
    out->ranges = [base, distance_value](const Jet<Range>& t) { return ranges_beside(*base, distance_value, t); };
    out->bend = [base, distance_value](const Jet<double>& t) {
        const auto jet = [&](double at) { return jet_beside(base->bend(Jet<double>::parameter(at)), distance_value); };
        auto p = jet(t.value);
        const double h = 1e-5 * std::max(1.0, std::abs(t.value));
        const auto before = jet(t.value - h), after = jet(t.value + h);
        for (std::size_t k = 0; k < 2; ++k) {
            p[k].second = (after[k].first - before[k].first) / (2 * h) * t.first * t.first + p[k].first * t.second;
            p[k].first *= t.first;
        }
        return p;
    };
    return out;
}

std::shared_ptr<const Law> placed_law(const std::shared_ptr<const Law>& law, const Placement2& placement) {
    const auto map = [placement](const auto& p) {
        using P = std::decay_t<decltype(p[0])>;
        const P xx(placement.column_x.x), xy(placement.column_x.y), yx(placement.column_y.x), yy(placement.column_y.y);
        return std::array<P, 2>{P(xx * p[0] + yx * p[1] + P(placement.shift.x)), P(xy * p[0] + yy * p[1] + P(placement.shift.y))};
    };
    auto out = std::make_shared<Law>();
    out->point = [law, map](const Number& t) { return map(law->point(t)); };
    out->jet = [law, map](const Jet<Number>& t) { return map(law->jet(t)); };
    out->bend = [law, map](const Jet<double>& t) { return map(law->bend(t)); };
    out->ranges = [law, map](const Jet<Range>& t) { return map(law->ranges(t)); };
    if (law->higher_ranges) out->higher_ranges = [law, map](const Jet<Jet<Range>>& t) { return map(law->higher_ranges(t)); };
    out->largest_bend = law->largest_bend;
    out->turns_one_way = law->turns_one_way;
    if (law->offset_of) {
        out->offset_of = placed_law(law->offset_of, placement);
        out->offset_distance = placement.mirrors ? -law->offset_distance : law->offset_distance;
    }
    return out;
}

Point2 as_point(const std::array<Number, 2>& p) { return {p[0], p[1]}; }

Point2 lerp(const Point2& a, const Point2& b, const Number& u) { return a + u * (b - a); }

// de Casteljau: the part of the cubic up to u, and from u on.
std::array<Bezier, 2> split(const Bezier& b, const Number& u) {
    const auto& p = b.points;
    const Point2 a0 = lerp(p[0], p[1], u), a1 = lerp(p[1], p[2], u), a2 = lerp(p[2], p[3], u);
    const Point2 b0 = lerp(a0, a1, u), b1 = lerp(a1, a2, u), c = lerp(b0, b1, u);
    return {Bezier{{p[0], a0, b0, c}}, Bezier{{c, b1, a2, p[3]}}};
}

double angle_between(const Vector2& a, const Vector2& b) { return std::abs(std::atan2(cross_of(a, b), a.dot(b))); }

// The bend of a general curve: bound, or the largest sample, of |d2/du2| over a range of u.
double bend_over(const Curve& curve, double from, double to, bool& proven) {
    if (const auto* bezier = std::get_if<Bezier>(&curve)) return largest_bend(*bezier);
    const auto& law_curve = std::get<LawCurve>(curve);
    const double span = span_of(law_curve);
    if (law_curve.law->largest_bend) {
        const double a = law_curve.from.value + from * span, b = law_curve.from.value + to * span;
        return law_curve.law->largest_bend(std::min(a, b), std::max(a, b)) * span * span;
    }
    proven = false;
    double largest = 0;
    constexpr int samples = 8;
    for (int k = 0; k <= samples; ++k) largest = std::max(largest, bending(curve, from + (to - from) * k / samples).norm());
    return 1.1 * largest;
}

// The chord deviation of a law's curve without a closed form: bound of its distance from its facets, `side` as it runs; nothing where it
// has none.
std::optional<ChordDeviation> law_deviation(const Curve& curve, int count) {
    const auto* law_curve = std::get_if<LawCurve>(&curve);
    if (law_curve == nullptr || law_curve->law->largest_bend) return std::nullopt;
    const double from = law_curve->from.value, to = law_curve->to.value;
    if (!(from < to || to < from)) return std::nullopt;
    ChordDeviation out = chord_deviation(*law_curve->law, std::min(from, to), std::max(from, to), count);
    if (!std::isfinite(out.distance)) return std::nullopt;
    if (to < from) out.side = -out.side;
    return out;
}

// Which way it bends over a range: 1 left, -1 right, 0 unknown. Proven of Beziers and of laws that promise it.
int bend_side(const Curve& curve, double from, double to) {
    if (const auto* bezier = std::get_if<Bezier>(&curve)) {
        // The control points of the part: all on one side of its chord, the curve is too.
        std::array<Vector2, 4> p;
        for (std::size_t k = 0; k < 4; ++k) p[k] = value(bezier->points[k]);
        const auto cut = [](std::array<Vector2, 4> q, double u, bool first) {
            const Vector2 a0 = q[0] + u * (q[1] - q[0]), a1 = q[1] + u * (q[2] - q[1]), a2 = q[2] + u * (q[3] - q[2]);
            const Vector2 b0 = a0 + u * (a1 - a0), b1 = a1 + u * (a2 - a1), c = b0 + u * (b1 - b0);
            return first ? std::array<Vector2, 4>{q[0], a0, b0, c} : std::array<Vector2, 4>{c, b1, a2, q[3]};
        };
        p = cut(p, to, true);
        if (from > 0) p = cut(p, from / to, false);
        const Vector2 chord = p[3] - p[0];
        // One that turns back along its chord may be on the other side of its neighbours'.
        if (!((p[1] - p[0]).dot(chord) >= 0 && (p[2] - p[1]).dot(chord) >= 0 && (p[3] - p[2]).dot(chord) >= 0)) return 0;
        const double a = cross_of(chord, p[1] - p[0]), b = cross_of(chord, p[2] - p[0]);
        if (a <= 0 && b <= 0) return 1;  // to the right of the chord: it turns left
        return a >= 0 && b >= 0 ? -1 : 0;
    }
    const auto& law_curve = std::get<LawCurve>(curve);
    const double middle = (from + to) / 2;
    const double turn = cross_of(at(curve, middle).velocity, bending(curve, middle));
    if (!law_curve.law->turns_one_way) return 0;
    return turn > 0 ? 1 : turn < 0 ? -1 : 0;
}

}  // namespace

const Point2& start_of(const Curve& curve) {
    return std::visit(Overloaded{[](const Bezier& b) -> const Point2& { return b.points.front(); },
                                 [](const auto& c) -> const Point2& { return c.start; }},
                      curve);
}

const Point2& end_of(const Curve& curve) {
    return std::visit(
        Overloaded{[](const Bezier& b) -> const Point2& { return b.points.back(); }, [](const auto& c) -> const Point2& { return c.end; }},
        curve);
}

Curve frozen(const Curve& curve) {
    const auto plain = [](const Point2& p) { return constant(value(p)); };
    if (const auto* line = std::get_if<Line>(&curve)) return Line{plain(line->start), plain(line->end)};
    if (const auto* arc = std::get_if<Arc>(&curve))
        return Arc{plain(arc->start), plain(arc->end), plain(arc->centre), arc->radius.value, arc->counter_clockwise};
    if (const auto* b = std::get_if<Bezier>(&curve))
        return Bezier{{plain(b->points[0]), plain(b->points[1]), plain(b->points[2]), plain(b->points[3])}};
    const auto& law = std::get<LawCurve>(curve);
    return LawCurve{law.law, law.from.value, law.to.value, plain(law.start), plain(law.end)};
}

bool is_whole_circle(const Arc& arc) { return value(arc.start) == value(arc.end); }

Number sweep_of(const Arc& arc) {
    const double known = sweep_value(arc);
    if (is_whole_circle(arc)) return known;
    const Point2 a = arc.start - arc.centre, b = arc.end - arc.centre;
    // Half turns are the rule: what is recorded is an angle that does not jump there, when the part is made of other dimensions.
    const bool is_wide = dot(a, b).value < 0;
    const Number angle = is_wide ? atan2(-cross(a, b), -dot(a, b)) : atan2(cross(a, b), dot(a, b));
    return angle + half_turn * std::round((known - angle.value) / half_turn);
}

bool is_general(const Curve& curve) { return std::holds_alternative<Bezier>(curve) || std::holds_alternative<LawCurve>(curve); }

CurvePoint at(const Curve& curve, double u) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Vector2 a = value(line->start), d = value(line->end) - a;
        return {a + u * d, d};
    }
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const double sweep = sweep_value(*arc);
        const Vector2 c = value(arc->centre), r = turned_by(value(arc->start) - c, sweep * u);
        return {c + r, sweep * Vector2(-r.y(), r.x())};
    }
    if (const auto* bezier = std::get_if<Bezier>(&curve)) {
        const auto p = bezier_point<Jet<double>>(*bezier, Jet<double>::parameter(u));
        return {{p[0].value, p[1].value}, {p[0].first, p[1].first}};
    }
    const auto& law_curve = std::get<LawCurve>(curve);
    const auto p = law_curve.law->bend(law_parameter(law_curve, u));
    return {{p[0].value, p[1].value}, span_of(law_curve) * Vector2(p[0].first, p[1].first)};
}

Vector2 bending(const Curve& curve, double u) {
    if (std::holds_alternative<Line>(curve)) return Vector2::Zero();
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const double sweep = sweep_value(*arc);
        return -sweep * sweep * (at(curve, u).position - value(arc->centre));
    }
    if (const auto* bezier = std::get_if<Bezier>(&curve)) {
        const auto p = bezier_point<Jet<double>>(*bezier, Jet<double>::parameter(u));
        return {p[0].second, p[1].second};
    }
    const auto& law_curve = std::get<LawCurve>(curve);
    const auto p = law_curve.law->bend(law_parameter(law_curve, u));
    return span_of(law_curve) * span_of(law_curve) * Vector2(p[0].second, p[1].second);
}

Point2 point_at(const Curve& curve, const Number& u) {
    if (const auto* line = std::get_if<Line>(&curve)) return lerp(line->start, line->end, u);
    if (const auto* arc = std::get_if<Arc>(&curve)) return arc->centre + turned(arc->start - arc->centre, direction(u * sweep_of(*arc)));
    if (const auto* bezier = std::get_if<Bezier>(&curve)) return as_point(bezier_point<Number>(*bezier, u));
    const auto& law_curve = std::get<LawCurve>(curve);
    return as_point(law_curve.law->point(law_curve.from + u * (law_curve.to - law_curve.from)));
}

Point2 tangent_at(const Curve& curve, const Number& u) {
    if (const auto* line = std::get_if<Line>(&curve)) return line->end - line->start;
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const Number sweep = sweep_of(*arc);
        return sweep * left_of(turned(arc->start - arc->centre, direction(u * sweep)));
    }
    if (const auto* bezier = std::get_if<Bezier>(&curve)) {
        const auto p = bezier_point<Jet<Number>>(*bezier, Jet<Number>::parameter(u));
        return {p[0].first, p[1].first};
    }
    const auto& law_curve = std::get<LawCurve>(curve);
    const Number span = law_curve.to - law_curve.from;
    const auto p = law_curve.law->jet(Jet<Number>::parameter(law_curve.from + u * span));
    return {span * p[0].first, span * p[1].first};
}

double turning(const Curve& curve) {
    if (std::holds_alternative<Line>(curve)) return 0;
    if (const auto* arc = std::get_if<Arc>(&curve)) return std::abs(sweep_value(*arc));
    constexpr int samples = 96;
    double sum = 0;
    Vector2 before = at(curve, 0).velocity;
    if (before.norm() == 0) before = at(curve, 1e-6).velocity;
    for (int k = 1; k <= samples; ++k) {
        const Vector2 now = at(curve, k == samples ? 1.0 - 1e-9 : static_cast<double>(k) / samples).velocity;
        sum += angle_between(before, now);
        before = now;
    }
    return sum;
}

int sample_count(const Curve& curve) {
    if (std::holds_alternative<Line>(curve)) return 1;
    return whole_number(turning(curve) * 36 / full_turn, is_general(curve) ? 12 : 3);
}

double sampled_length(const Curve& curve) {
    const int n = sample_count(curve);
    double sum = 0;
    Vector2 before = value(start_of(curve));
    for (int k = 1; k <= n; ++k) {
        const Vector2 now = at(curve, static_cast<double>(k) / n).position;
        sum += (now - before).norm();
        before = now;
    }
    return sum;
}

Box2 box_of(const Curve& curve) {
    const int n = sample_count(curve);
    Vector2 before = value(start_of(curve));
    Box2 box{before, before};
    double longest = 0;
    for (int k = 1; k <= n; ++k) {
        const Vector2 now = k == n ? value(end_of(curve)) : at(curve, static_cast<double>(k) / n).position;
        box.low = box.low.cwiseMin(now);
        box.high = box.high.cwiseMax(now);
        longest = std::max(longest, (now - before).norm());
        before = now;
    }
    if (n > 1) {
        box.low.array() -= 0.3 * longest;
        box.high.array() += 0.3 * longest;
    }
    return box;
}

double nearest_parameter(const Curve& curve, const Vector2& p) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Vector2 a = value(line->start), d = value(line->end) - a;
        const double square = d.squaredNorm();
        return square > 0 ? std::clamp((p - a).dot(d) / square, 0.0, 1.0) : 0;
    }
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const double sweep = sweep_value(*arc);
        const Vector2 a = value(arc->start) - value(arc->centre), b = p - value(arc->centre);
        double angle = std::atan2(cross_of(a, b), a.dot(b));
        if (sweep > 0 && angle < 0) angle += full_turn;
        if (sweep < 0 && angle > 0) angle -= full_turn;
        const double u = angle / sweep;
        if (u <= 1) return u;
        return u - 1 < full_turn / std::abs(sweep) - u ? 1 : 0;  // beyond an end: the nearer one round the circle
    }
    const int n = 2 * sample_count(curve);
    double best = 0, least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= n; ++k) {
        const double u = static_cast<double>(k) / n, distance = (at(curve, u).position - p).squaredNorm();
        if (distance < least) {
            least = distance;
            best = u;
        }
    }
    double u = best;
    const double low = std::max(0.0, best - 1.0 / n), high = std::min(1.0, best + 1.0 / n);
    for (int iteration = 0; iteration < 40; ++iteration) {
        const CurvePoint c = at(curve, u);
        const double square = c.velocity.squaredNorm();
        if (!(square > 0)) break;
        // Newton's step for the least distance where it is convex, Gauss and Newton's otherwise.
        const double slope = (p - c.position).dot(c.velocity), curvature = square - (p - c.position).dot(bending(curve, u));
        const double next = std::clamp(u + slope / (curvature > 0.1 * square ? curvature : square), low, high);
        if (std::abs(next - u) < 1e-15) break;
        u = next;
    }
    return (at(curve, u).position - p).squaredNorm() <= least ? u : best;
}

double distance_to(const Curve& curve, const Vector2& p) { return (at(curve, nearest_parameter(curve, p)).position - p).norm(); }

Number parameter_of(const Curve& curve, const Point2& on_curve, double u0) {
    const Vector2 velocity = at(curve, u0).velocity;
    const double square = velocity.squaredNorm();
    if (!(square > 0)) return u0;
    return u0 + dot(on_curve - point_at(curve, u0), constant(Vector2(velocity / square)));
}

Curve reversed(const Curve& curve) {
    if (const auto* line = std::get_if<Line>(&curve)) return Line{line->end, line->start};
    if (const auto* arc = std::get_if<Arc>(&curve)) return Arc{arc->end, arc->start, arc->centre, arc->radius, !arc->counter_clockwise};
    if (const auto* b = std::get_if<Bezier>(&curve)) return Bezier{{b->points[3], b->points[2], b->points[1], b->points[0]}};
    const auto& law_curve = std::get<LawCurve>(curve);
    return LawCurve{law_curve.law, law_curve.to, law_curve.from, law_curve.end, law_curve.start};
}

Curve between(const Curve& curve, const Cut& from, const Cut& to) {
    if (std::holds_alternative<Line>(curve)) return Line{from.point, to.point};
    if (const auto* arc = std::get_if<Arc>(&curve)) return Arc{from.point, to.point, arc->centre, arc->radius, arc->counter_clockwise};
    if (const auto* bezier = std::get_if<Bezier>(&curve)) {
        Bezier part = to.u < 1 ? split(*bezier, to.parameter)[0] : *bezier;
        if (from.u > 0) part = split(part, to.u < 1 ? from.parameter / to.parameter : from.parameter)[1];
        part.points.front() = from.point;
        part.points.back() = to.point;
        return part;
    }
    const auto& law_curve = std::get<LawCurve>(curve);
    const Number span = law_curve.to - law_curve.from;
    return LawCurve{law_curve.law, from.u > 0 ? law_curve.from + from.parameter * span : law_curve.from,
                    to.u < 1 ? law_curve.from + to.parameter * span : law_curve.to, from.point, to.point};
}

std::optional<Curve> beside(const Curve& curve, const Number& distance) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Point2 d = line->end - line->start;
        const Point2 shift = (distance / length(d)) * left_of(d);
        return Line{line->start + shift, line->end + shift};
    }
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const Number radius = arc->counter_clockwise ? arc->radius - distance : arc->radius + distance;
        if (!(radius.value > 1e-9 * arc->radius.value)) return std::nullopt;
        const Number scale = radius / arc->radius;
        return Arc{arc->centre + scale * (arc->start - arc->centre), arc->centre + scale * (arc->end - arc->centre), arc->centre, radius,
                   arc->counter_clockwise};
    }
    if (const auto* bezier = std::get_if<Bezier>(&curve)) return law_curve(*law_beside(as_law(*bezier), distance), 0, 1);
    const auto& law = std::get<LawCurve>(curve);
    return law_curve(*law_beside(law.law, law.to.value < law.from.value ? -distance : distance), law.from, law.to);
}

Point2 placed(const Point2& p, const Placement2& placement) {
    return p.x * placement.column_x + p.y * placement.column_y + placement.shift;
}

Curve placed(const Curve& curve, const Placement2& placement) {
    const auto at_place = [&](const Point2& p) { return placed(p, placement); };
    if (const auto* line = std::get_if<Line>(&curve)) return Line{at_place(line->start), at_place(line->end)};
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const Point2 start = at_place(arc->start), end = is_whole_circle(*arc) ? start : at_place(arc->end);
        return Arc{start, end, at_place(arc->centre), arc->radius, arc->counter_clockwise != placement.mirrors};
    }
    if (const auto* b = std::get_if<Bezier>(&curve))
        return Bezier{{at_place(b->points[0]), at_place(b->points[1]), at_place(b->points[2]), at_place(b->points[3])}};
    const auto& law_curve = std::get<LawCurve>(curve);
    return LawCurve{placed_law(law_curve.law, placement), law_curve.from, law_curve.to, at_place(law_curve.start), at_place(law_curve.end)};
}

double sweep_value(const Arc& arc) {
    if (is_whole_circle(arc)) return arc.counter_clockwise ? full_turn : -full_turn;
    const Vector2 a = value(arc.start) - value(arc.centre), b = value(arc.end) - value(arc.centre);
    const double angle = std::atan2(cross_of(a, b), a.dot(b));
    if (arc.counter_clockwise) return angle > 0 ? angle : angle + full_turn;
    return angle < 0 ? angle : angle - full_turn;
}

int facet_count(const Curve& curve, const Facets& facets) {
    if (std::holds_alternative<Line>(curve)) return 1;
    if (const auto* arc = std::get_if<Arc>(&curve)) return segments_of(facets, arc->radius.value, sweep_value(*arc));
    if (!(facets.chord > 0)) return whole_number(facets.segments * turning(curve) / full_turn - 1e-6, 1);
    bool proven = true;
    const double least = std::sqrt(bend_over(curve, 0, 1, proven) / (8 * facets.chord));
    int count = whole_number(least - 1e-9, 1);
    // More where the proven bound is not yet within the chord; the bound falls with the square of the count.
    for (int k = 0; k < 3; ++k) {
        const auto deviation = law_deviation(curve, count);
        if (!deviation || deviation->distance <= facets.chord) break;
        count = whole_number(count * 1.02 * std::sqrt(deviation->distance / facets.chord), count);
    }
    return count;
}

Chain chain_of(const Curve& curve, int count, Lean lean) {
    Chain chain;
    if (std::holds_alternative<Line>(curve)) return chain;
    if (const auto* arc = std::get_if<Arc>(&curve)) {
        const bool convex = arc->counter_clockwise, whole = is_whole_circle(*arc);
        const bool around = lean != Lean::through && convex == (lean == Lean::cover);  // flats touch the circle
        const Number sweep = sweep_of(*arc);
        const Point2 spoke = arc->start - arc->centre;
        const Number half = sweep / (2.0 * count);
        const Number shrink = cos(half);
        const Point2 long_spoke = around ? (1.0 / shrink) * spoke : spoke;
        const auto turn = [&](int numerator, int denominator) {  // of the sweep
            if (whole) return direction(convex ? numerator : -numerator, denominator);
            return direction(sweep * (static_cast<double>(numerator) / denominator));
        };
        const double radius = arc->radius.value;
        if (around && !whole)
            for (int k = 0; k < count; ++k) chain.inner.push_back(arc->centre + turned(long_spoke, turn(2 * k + 1, 2 * count)));
        else
            for (int k = whole && around ? 0 : 1; k < count; ++k) chain.inner.push_back(arc->centre + turned(long_spoke, turn(k, count)));
        chain.through_start = !(whole && around);
        const double deviation = around ? radius * (1 / shrink.value - 1) : radius * (1 - shrink.value);
        // Around a pin the mesh is larger; within it the part is; of a hole the other way round.
        (around == convex ? chain.in : chain.out) = deviation;
        return chain;
    }
    for (int k = 1; k < count; ++k) chain.inner.push_back(point_at(curve, static_cast<double>(k) / count));
    if (const auto deviation = law_deviation(curve, count)) {
        chain.out = deviation->side >= 0 ? deviation->distance : 0;
        chain.in = deviation->side <= 0 ? deviation->distance : 0;
        return chain;
    }
    for (int k = 0; k < count; ++k) {
        const double from = static_cast<double>(k) / count, to = static_cast<double>(k + 1) / count;
        const double bound = bend_over(curve, from, to, chain.proven) * (to - from) * (to - from) / 8;
        const int side = bend_side(curve, from, to);
        if (side >= 0) chain.out = std::max(chain.out, bound);
        if (side <= 0) chain.in = std::max(chain.in, bound);
    }
    return chain;
}

// The constructors of curve.hpp.

LawCurve law_curve(Law law, const Number& from, const Number& to) {
    LawCurve curve{std::make_shared<const Law>(std::move(law)), from, to, {}, {}};
    curve.start = as_point(curve.law->point(from));
    curve.end = as_point(curve.law->point(to));
    return curve;
}

LawCurve involute(const Number& base, const Number& turn, const Number& from, const Number& to, bool mirrored) {
    const double hand = mirrored ? -1 : 1;
    Law law([base, turn, hand](const auto& u) {
        using T = std::decay_t<decltype(u)>;
        using std::cos, std::sin;
        const T angle = hand * u + T(turn), c = cos(angle), s = sin(angle);
        const T r = T(base);
        return std::array<T, 2>{T(r * (c + hand * u * s)), T(r * (s - hand * u * c))};
    });
    const double radius = base.value;
    // d2/du2 = base (t + u n) with the tangent t, which turns by b - a over the range, and the normal n: square to a chord, which is a
    // tangent somewhere in the range, it is at most base (|u| + b - a). At u = 0 there is a cusp, beyond which tangents turn back.
    law.largest_bend = [radius](double a, double b) {
        const double most = std::max(std::abs(a), std::abs(b)), length = std::hypot(1.0, most);
        return radius * (a * b < 0 ? length : std::min(length, most + (b - a)));
    };
    law.turns_one_way = from.value * to.value >= 0;
    return law_curve(std::move(law), from, to);
}

namespace {

// Solves before[k] x[k-1] + at[k] x[k] + after[k] x[k+1] = right[k]; no pivots needed where rows are dominated by `at`.
std::vector<Point2> tridiagonal(const std::vector<Number>& before, std::vector<Number> middle, const std::vector<Number>& after,
                                std::vector<Point2> right) {
    const std::size_t n = middle.size();
    for (std::size_t k = 1; k < n; ++k) {
        const Number factor = before[k] / middle[k - 1];
        middle[k] = middle[k] - factor * after[k - 1];
        right[k] = right[k] - factor * right[k - 1];
    }
    for (std::size_t k = n; k-- > 0;) {
        if (k + 1 < n) right[k] = right[k] - after[k] * right[k + 1];
        right[k] = (1.0 / middle[k]) * right[k];
    }
    return right;
}

}  // namespace

std::vector<Bezier> spline_through(const std::vector<Point2>& points, bool closed) {
    FETTLE_ASSERT(points.size() >= (closed ? 3u : 2u), "a spline goes through at least two points, a closed one through three");
    const std::size_t n = points.size(), intervals = closed ? n : n - 1;
    const auto point = [&](std::size_t k) -> const Point2& { return points[k % n]; };
    std::vector<Number> h;
    for (std::size_t k = 0; k < intervals; ++k) {
        h.push_back(sqrt(length(point(k + 1) - point(k))));
        FETTLE_ASSERT(h[k].value > 0, "neighbours of a spline differ");
    }
    // First derivatives m at the points, so that the second is continuous: of the interval from k on it is
    //     6 (p1 - p0) / h^2 - (4 m0 + 2 m1) / h   at its start,   -6 (p1 - p0) / h^2 + (2 m0 + 4 m1) / h   at its end.
    std::vector<Number> before(n), middle(n), after(n);
    std::vector<Point2> right(n);
    for (std::size_t k = 0; k < n; ++k) {
        if (closed || k + 1 < n) {
            const Number inverse = 1.0 / h[k];
            middle[k] += 4.0 * inverse;
            after[k] = 2.0 * inverse;
            right[k] = right[k] + (6.0 * inverse * inverse) * (point(k + 1) - point(k));
        }
        if (closed || k > 0) {
            const std::size_t previous = (k + n - 1) % n;
            const Number inverse = 1.0 / h[previous];
            middle[k] += 4.0 * inverse;
            before[k] = 2.0 * inverse;
            right[k] = right[k] + (6.0 * inverse * inverse) * (point(k) - point(previous));
        }
    }
    std::vector<Point2> slopes;
    if (!closed) {
        slopes = tridiagonal(before, middle, after, right);
    } else {
        // Sherman and Morrison: the corners of the matrix are a product of two vectors.
        const Number gamma = -middle[0], top = before[0], bottom = after[n - 1];
        std::vector<Point2> aside(n);
        aside[0] = {gamma, 0};
        aside[n - 1] = {bottom, 0};
        middle[0] = middle[0] - gamma;
        middle[n - 1] = middle[n - 1] - bottom * top / gamma;
        slopes = tridiagonal(before, middle, after, right);
        const std::vector<Point2> z = tridiagonal(before, middle, after, aside);
        const Number ratio = top / gamma, below = 1.0 + z[0].x + ratio * z[n - 1].x;
        const Point2 factor = (1.0 / below) * (slopes[0] + ratio * slopes[n - 1]);
        for (std::size_t k = 0; k < n; ++k) slopes[k] = slopes[k] - z[k].x * factor;
    }
    std::vector<Bezier> out;
    for (std::size_t k = 0; k < intervals; ++k) {
        const Number third = h[k] / 3.0;
        out.push_back({{point(k), point(k) + third * slopes[k], point(k + 1) - third * slopes[(k + 1) % n], point(k + 1)}});
    }
    return out;
}

std::vector<Bezier> b_spline(const std::vector<Point2>& control_points, bool closed) {
    FETTLE_ASSERT(control_points.size() >= (closed ? 3u : 2u), "a B-spline has at least two control points, a closed one three");
    std::vector<Point2> p;
    if (closed) {
        for (std::size_t k = 0; k < control_points.size() + 3; ++k) p.push_back(control_points[k % control_points.size()]);
    } else {
        p.assign(2, control_points.front());
        p.insert(p.end(), control_points.begin(), control_points.end());
        p.insert(p.end(), 2, control_points.back());
    }
    const Number third = 1.0 / 3, two_thirds = 2.0 / 3, sixth = 1.0 / 6;
    const auto on_curve = [&](std::size_t k) { return sixth * p[k] + two_thirds * p[k + 1] + sixth * p[k + 2]; };
    std::vector<Bezier> out;
    Point2 start = on_curve(0);
    if (!closed) start = control_points.front();
    const Point2 first = start;
    for (std::size_t k = 0; k + 3 < p.size(); ++k) {
        const bool last = k + 4 == p.size();
        const Point2 end = last ? (closed ? first : control_points.back()) : on_curve(k + 1);
        out.push_back({{start, two_thirds * p[k + 1] + third * p[k + 2], third * p[k + 1] + two_thirds * p[k + 2], end}});
        start = end;
    }
    return out;
}

}  // namespace fettle::core::parts
