// SPDX-License-Identifier: MIT
#include "core/parts/curve_meetings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::core::parts {
namespace {

// u of a point of the whole line or circle; of arcs from 0 up to less than a full turn.
double extended_parameter(const Curve& curve, const Vector2& p) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Vector2 a = value(line->start), d = value(line->end) - a;
        return (p - a).dot(d) / d.squaredNorm();
    }
    const auto& arc = std::get<Arc>(curve);
    const double sweep = sweep_of({constant(value(arc.start)), constant(value(arc.end)), constant(value(arc.centre)), arc.radius.value,
                                   arc.counter_clockwise})
                             .value;
    const Vector2 a = value(arc.start) - value(arc.centre), b = p - value(arc.centre);
    double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    if (sweep > 0 && angle < 0) angle += full_turn;
    if (sweep < 0 && angle > 0) angle -= full_turn;
    return angle / sweep;
}

void line_line(const Line& a, const Line& b, std::vector<Point2>& out) {
    const Point2 d = a.end - a.start, e = b.end - b.start;
    const Number sine = cross(d, e);
    if (!(std::abs(sine.value) > 1e-12 * value(d).norm() * value(e).norm())) return;
    out.push_back(a.start + (cross(b.start - a.start, e) / sine) * d);
}

// Points at `along` +- `aside` from a foot: one where they touch, which has a derivative where the root has none.
void line_arc(const Line& a, const Arc& b, double tolerance, std::vector<Point2>& out) {
    const Point2 d = a.end - a.start, to_centre = b.centre - a.start;
    const Number square = dot(d, d);
    const Point2 foot = a.start + (dot(to_centre, d) / square) * d;
    const Point2 away = foot - b.centre;
    const double distance = value(away).norm(), radius = b.radius.value;
    if (std::abs(distance - radius) <= tolerance) {
        out.push_back(foot);
        return;
    }
    if (distance > radius) return;
    const Number half = sqrt((b.radius * b.radius - dot(away, away)) / square);
    out.push_back(foot - half * d);
    out.push_back(foot + half * d);
}

void arc_arc(const Arc& a, const Arc& b, double tolerance, std::vector<Point2>& out) {
    const Point2 d = b.centre - a.centre;
    const double distance = value(d).norm(), ra = a.radius.value, rb = b.radius.value;
    if (distance <= tolerance) return;  // concentric: apart or the same circle
    const Number square = dot(d, d);
    const bool touch_outside = std::abs(distance - ra - rb) <= tolerance,
               touch_inside = std::abs(distance - std::abs(ra - rb)) <= tolerance;
    if (touch_outside || touch_inside) {
        const bool behind = touch_inside && !touch_outside && ra < rb;
        out.push_back(a.centre + ((behind ? -a.radius : a.radius) / sqrt(square)) * d);
        return;
    }
    if (distance > ra + rb || distance < std::abs(ra - rb)) return;
    const Number along = 0.5 * (1.0 + (a.radius * a.radius - b.radius * b.radius) / square);
    const Number aside = sqrt(a.radius * a.radius / square - along * along);
    const Point2 foot = a.centre + along * d, left = left_of(d);
    out.push_back(foot + aside * left);
    out.push_back(foot - aside * left);
}

struct Sample {
    double from, to;
    Box2 box;
};

// Boxes of even stretches, larger by what the curve leaves them by: a stretch turns by 10 degrees or so.
std::vector<Sample> samples_of(const Curve& curve, double tolerance) {
    const int n = is_general(curve) ? 2 * sample_count(curve) : sample_count(curve);
    std::vector<Sample> out;
    Vector2 before = at(curve, 0).position;
    for (int k = 1; k <= n; ++k) {
        const double u = static_cast<double>(k) / n;
        const Vector2 now = at(curve, u).position;
        const Vector2 margin = Vector2::Constant(tolerance + (n > 1 ? 0.3 * (now - before).norm() : 0));
        out.push_back({static_cast<double>(k - 1) / n, u, {before.cwiseMin(now) - margin, before.cwiseMax(now) + margin}});
        before = now;
    }
    return out;
}

// Newton's method for a(u) = b(v); true if it ends on both within the tolerance.
bool find_crossing(const Curve& a, const Curve& b, double& u, double& v, double tolerance) {
    for (int iteration = 0; iteration < 50; ++iteration) {
        const CurvePoint p = at(a, u), q = at(b, v);
        Matrix2 j;
        j << p.velocity, -q.velocity;
        const double determinant = j.determinant();
        const Vector2 residual = p.position - q.position;
        if (!(std::abs(determinant) > 1e-10 * p.velocity.norm() * q.velocity.norm())) return false;  // parallel
        Vector2 step = -(j.inverse() * residual);
        const double largest = step.cwiseAbs().maxCoeff();
        if (largest > 0.25) step *= 0.25 / largest;
        u += step.x();
        v += step.y();
        if (u < -0.3 || u > 1.3 || v < -0.3 || v > 1.3) return false;
        if (largest < 1e-14) break;
        if (iteration > 12 && residual.norm() < 1e-3 * tolerance) break;
    }
    const CurvePoint p = at(a, u), q = at(b, v);
    const double slack_u = tolerance / std::max(p.velocity.norm(), tolerance), slack_v = tolerance / std::max(q.velocity.norm(), tolerance);
    return (p.position - q.position).norm() <= tolerance && u >= -slack_u && u <= 1 + slack_u && v >= -slack_v && v <= 1 + slack_v;
}

// A root with the derivative of one step of Newton's method: what depends on a dimension moves it as the implicit function theorem says.
// Its value stays as it was found: where the curves nearly touch, a step from what rounding has left would lead far away.
Meeting recorded(const Curve& a, const Curve& b, double u, double v) {
    const CurvePoint p = at(a, u), q = at(b, v);
    Matrix2 j;
    j << p.velocity, -q.velocity;
    const Matrix2 inverse = j.inverse();
    const Point2 apart = point_at(a, u) - point_at(b, v), residual = apart - constant(value(apart));
    const Number du = inverse(0, 0) * residual.x + inverse(0, 1) * residual.y, dv = inverse(1, 0) * residual.x + inverse(1, 1) * residual.y;
    Meeting out;
    out.on_a = {u, u - du, {}};
    out.on_b = {v, v - dv, {}};
    // The simpler curve's point is the more exact one.
    out.on_a.point = out.on_b.point = is_general(a) && !is_general(b) ? point_at(b, out.on_b.parameter) : point_at(a, out.on_a.parameter);
    return out;
}

void add_general(const Curve& a, const std::vector<Sample>& of_a, const Curve& b, const std::vector<Sample>& of_b, double tolerance,
                 std::vector<Meeting>& out) {
    for (const Sample& x : of_a) {
        for (const Sample& y : of_b) {
            if (!x.box.meets(y.box)) continue;
            double u = (x.from + x.to) / 2, v = (y.from + y.to) / 2;
            if (!find_crossing(a, b, u, v, tolerance)) continue;
            const Vector2 p = at(a, u).position;
            if (std::any_of(out.begin(), out.end(), [&](const Meeting& m) { return (value(m.on_a.point) - p).norm() <= 2 * tolerance; }))
                continue;
            out.push_back(recorded(a, b, u, v));
        }
    }
}

std::vector<Point2> closed_form(const Curve& a, const Curve& b, double tolerance) {
    std::vector<Point2> points;
    const auto *line_a = std::get_if<Line>(&a), *line_b = std::get_if<Line>(&b);
    const auto *arc_a = std::get_if<Arc>(&a), *arc_b = std::get_if<Arc>(&b);
    if (line_a && line_b) line_line(*line_a, *line_b, points);
    if (line_a && arc_b) line_arc(*line_a, *arc_b, tolerance, points);
    if (arc_a && line_b) line_arc(*line_b, *arc_a, tolerance, points);
    if (arc_a && arc_b) arc_arc(*arc_a, *arc_b, tolerance, points);
    return points;
}

// u of a point on the curve, with its end snapped; nothing if it is beside the curve. `samples`: boxes that hold it; none: not looked at.
std::optional<double> parameter_on(const Curve& curve, const std::vector<Sample>& samples, const Vector2& p, double tolerance) {
    if ((p - value(start_of(curve))).norm() <= tolerance) return 0;
    if ((p - value(end_of(curve))).norm() <= tolerance) return 1;
    const auto is_near = [&](const Sample& sample) { return sample.box.meets({p, p}); };
    if (!samples.empty() && std::none_of(samples.begin(), samples.end(), is_near)) return std::nullopt;
    const double u = nearest_parameter(curve, p);
    if ((at(curve, u).position - p).norm() > tolerance) return std::nullopt;
    return u;
}

Cut cut_at(const Curve& curve, double u, const Point2& point) {
    return {u, is_general(curve) ? (u <= 0 || u >= 1 ? Number(u) : parameter_of(curve, point, u)) : Number(u), point};
}

}  // namespace

std::vector<Meeting> extended_meetings(const Curve& a, const Curve& b, double tolerance) {
    std::vector<Meeting> out;
    if (is_general(a) || is_general(b)) {
        add_general(a, samples_of(a, tolerance), b, samples_of(b, tolerance), tolerance, out);
        return out;
    }
    for (const Point2& p : closed_form(a, b, tolerance)) {
        const double u = extended_parameter(a, value(p)), v = extended_parameter(b, value(p));
        out.push_back({{u, u, p}, {v, v, p}});
    }
    return out;
}

std::vector<Meeting> meetings(const Curve& a, const Curve& b, double tolerance) {
    std::vector<Meeting> out;
    const bool general = is_general(a) || is_general(b);
    const std::vector<Sample> of_a = general ? samples_of(a, tolerance) : std::vector<Sample>(),
                              of_b = general ? samples_of(b, tolerance) : std::vector<Sample>();
    const auto is_new = [&](const Vector2& p) {
        return std::none_of(out.begin(), out.end(), [&](const Meeting& m) { return (value(m.on_a.point) - p).norm() <= 2 * tolerance; });
    };
    const auto add_ends = [&](const Curve& of, const Curve& on, bool of_is_a) {
        for (const double u : {0.0, 1.0}) {
            const Point2& p = u == 0 ? start_of(of) : end_of(of);
            const auto v = parameter_on(on, of_is_a ? of_b : of_a, value(p), tolerance);
            if (!v || !is_new(value(p))) continue;
            // An end on an end: the point of a.
            const Point2& point = !of_is_a && *v == 0 ? start_of(on) : !of_is_a && *v == 1 ? end_of(on) : p;
            const Cut here{u, u, point}, there = cut_at(on, *v, point);
            out.push_back(of_is_a ? Meeting{here, there} : Meeting{there, here});
        }
    };
    add_ends(a, b, true);
    add_ends(b, a, false);
    if (general) {
        std::vector<Meeting> found;
        add_general(a, of_a, b, of_b, tolerance, found);
        for (Meeting& m : found)
            if (is_new(value(m.on_a.point))) out.push_back(m);
        return out;
    }
    // Decided on plain numbers, recorded where they meet.
    const auto on_both = [&](const Vector2& p) {
        return is_new(p) && parameter_on(a, {}, p, tolerance) && parameter_on(b, {}, p, tolerance);
    };
    const auto plain = closed_form(frozen(a), frozen(b), tolerance);
    if (std::none_of(plain.begin(), plain.end(), [&](const Point2& p) { return on_both(value(p)); })) return out;
    for (const Point2& p : closed_form(a, b, tolerance)) {
        if (!on_both(value(p))) continue;
        const double u = *parameter_on(a, {}, value(p), tolerance), v = *parameter_on(b, {}, value(p), tolerance);
        out.push_back({{u, u, p}, {v, v, p}});
    }
    return out;
}

}  // namespace fettle::core::parts
