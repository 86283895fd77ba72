// SPDX-License-Identifier: MIT
#include "core/parts/revolve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/units.hpp"
#include "core/parts/faceted_profile.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/solid_builder.hpp"

namespace fettle::core::parts {
namespace {

// What a curve sweeps out about z.
Surface revolved_surface(const FacetedCurve& faceted, double size) {
    Surface out;
    out.feature = faceted.feature;
    out.kind = SurfaceKind::revolved;
    if (const auto* line = std::get_if<Line>(&faceted.curve)) {
        const Point2 d = line->end - line->start;
        const Vector2 v = value(d);
        out.point = {0, 0, line->start.y};
        out.hollow = v.y() < 0;
        if (std::abs(v.y()) <= 1e-12 * v.norm()) {
            out.kind = SurfaceKind::plane;
            out.axis = {0, 0, v.x() > 0 ? -1 : 1};
            out.hollow = false;
        } else if (std::abs(v.x()) <= 1e-12 * v.norm()) {
            out.kind = SurfaceKind::cylinder;
            out.radius = line->start.x;
        } else {
            out.kind = SurfaceKind::cone;
            out.radius = line->start.x;
            out.slope = d.x / d.y;
        }
    } else if (const auto* arc = std::get_if<Arc>(&faceted.curve)) {
        const bool on_axis = std::abs(arc->centre.x.value) <= 1e-12 * size;
        out.kind = on_axis ? SurfaceKind::sphere : SurfaceKind::torus;
        out.point = {0, 0, arc->centre.y};
        out.radius = on_axis ? arc->radius : arc->centre.x;
        if (!on_axis) out.slope = arc->radius;
        out.hollow = !arc->counter_clockwise;
    }
    return out;
}

// The half planes that points stand in. Between two of them a flat that touches the circle has its ends `reach` times as far out.
struct Station {
    Point2 direction;
    Number reach = 1;  ///< of vertices whose flats are to touch the circle
};

struct Turn {
    std::vector<Station> stations;
    bool whole = true;
    double half_step = 0;  ///< half the angle between stations, at most [rad]
};

Turn whole_turn(int count) {
    Turn turn;
    turn.half_step = std::numbers::pi / count;
    for (int k = 0; k < count; ++k) turn.stations.push_back({direction(k, count), 1.0 / std::cos(turn.half_step)});
    return turn;
}

Turn part_turn(const Number& from, const Number& angle, int count, Lean lean) {
    Turn turn;
    turn.whole = false;
    const Number half = angle / (2.0 * count);
    turn.half_step = half.value;
    const Number reach = 1.0 / cos(half);
    turn.stations.push_back({direction(from), 1});
    if (lean == Lean::through)
        for (int k = 1; k < count; ++k) turn.stations.push_back({direction(from + angle * (static_cast<double>(k) / count)), 1});
    else
        for (int k = 0; k < count; ++k) turn.stations.push_back({direction(from + angle * ((k + 0.5) / count)), reach});
    turn.stations.push_back({direction(from + angle), 1});
    return turn;
}

enum class Facing { outwards, inwards, neither };

Facing facing(const FacetedLoop& loop, std::size_t edge) {
    const Vector2 d = value(loop.points[(edge + 1) % loop.points.size()]) - value(loop.points[edge]);
    if (std::abs(d.y()) <= 1e-9 * d.norm()) return Facing::neither;
    return d.y() > 0 ? Facing::outwards : Facing::inwards;
}

// Whether the vertices of a point of the profile stand farther out, so that flats touch the circle.
bool stands_out(const FacetedLoop& loop, std::size_t point, Lean lean) {
    if (lean == Lean::through) return false;
    const Facing wanted = lean == Lean::cover ? Facing::outwards : Facing::inwards;
    const Facing before = facing(loop, (point + loop.points.size() - 1) % loop.points.size()), after = facing(loop, point);
    const auto allows = [&](Facing f) { return f == wanted || f == Facing::neither; };
    return allows(before) && allows(after) && (before == wanted || after == wanted);
}

Result<Solid> turned_solid(Drawing& drawing, const Profile& profile, const Number* from, const Number* angle) {
    const auto polygons = faceted(drawing, profile);
    if (!polygons) return polygons.errors();
    double farthest = 0, size = 0;
    for (const FacetedLoop& loop : polygons->loops) {
        for (const Point2& p : loop.points) {
            farthest = std::max(farthest, p.x.value);
            size = std::max(size, value(p).norm());
        }
    }
    const double on_axis = 1e-9 * size;
    for (const FacetedLoop& loop : polygons->loops) {
        for (std::size_t k = 0; k < loop.points.size(); ++k) {
            if (loop.points[k].x.value >= -on_axis) continue;
            double deepest = 0;
            for (const Point2& p : loop.points) deepest = std::max(deepest, -p.x.value);
            const std::string& feature = polygons->curves[loop.curve[k]].feature;
            return Error{ErrorCode::out_of_range, feature, quoted_profile(feature) + " crosses the axis by " + millimetres(deepest)};
        }
    }
    const std::string name = profile.loops.front().segments.front().feature;
    const Lean lean = drawing.facets.lean;
    const double sweep = angle != nullptr ? angle->value : full_turn;
    if (!(sweep > 0) || (angle != nullptr && !(sweep < full_turn)))
        return Error{
            ErrorCode::out_of_range, name,
            quoted_profile(name) + " is turned by " + format_quantity(sweep, "deg", 4) + ": it must be more than 0 and less than 360 deg"};
    const int count =
        drawing.count("segments of the turn of " + quoted_profile(name), [&] { return segments_of(drawing.facets, farthest, sweep); });
    if (count >= most_segments) return too_many_segments(name, "the turn of " + quoted_profile(name), drawing.facets);
    const Turn turn = angle != nullptr ? part_turn(*from, *angle, count, lean) : whole_turn(count);
    const std::size_t stations = turn.stations.size();

    SolidBuilder builder;
    std::vector<int> surfaces;
    double curve_out = 0, curve_in = 0, turn_out = 0, turn_in = 0;
    bool proven = true;
    for (const FacetedCurve& curve : polygons->curves) {
        surfaces.push_back(builder.add_surface(revolved_surface(curve, size)));
        curve_out = std::max(curve_out, curve.out);
        curve_in = std::max(curve_in, curve.in);
        proven = proven && curve.proven;
    }
    // Per loop and point: its vertices, one per station, or a single one on the axis.
    std::vector<std::vector<std::vector<int>>> rings;
    const double flat = std::cos(turn.half_step);
    for (const FacetedLoop& loop : polygons->loops) {
        const std::size_t n = loop.points.size();
        std::vector<std::vector<int>> of_loop(n);
        std::vector<char> out(n);
        for (std::size_t k = 0; k < n; ++k) {
            const Point2& p = loop.points[k];
            if (p.x.value <= on_axis) {
                of_loop[k].assign(stations, builder.add_vertex({0, 0, p.y}));
                continue;
            }
            out[k] = stands_out(loop, k, lean);
            for (const Station& station : turn.stations) {
                const Number radius = out[k] ? station.reach * p.x : p.x;
                of_loop[k].push_back(builder.add_vertex({radius * station.direction.x, radius * station.direction.y, p.y}));
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t next = (k + 1) % n, curve = static_cast<std::size_t>(loop.curve[k]);
            const auto &a = of_loop[k], &b = of_loop[next];
            if (loop.points[k].x.value <= on_axis && loop.points[next].x.value <= on_axis) continue;  // along the axis
            // At the ends of the edge: how far the true circle is beyond the flats, the vertices beyond it.
            double beyond_flats = 0, beyond_circle = 0;
            for (const std::size_t end : {k, next}) {
                const double radius = loop.points[end].x.value, vertices = out[end] ? radius / flat : radius;
                beyond_flats = std::max(beyond_flats, out[end] ? 0.0 : radius - vertices * flat);
                beyond_circle = std::max(beyond_circle, vertices - radius);
            }
            const Facing way = facing(loop, k);
            const double edge_out = way == Facing::inwards ? beyond_circle : beyond_flats,
                         edge_in = way == Facing::inwards ? beyond_flats : beyond_circle;
            if (way != Facing::neither) {
                turn_out = std::max(turn_out, edge_out);
                turn_in = std::max(turn_in, edge_in);
            }
            const FacetedCurve& stands_for = polygons->curves[curve];
            const bool is_plane = way == Facing::neither && std::holds_alternative<Line>(stands_for.curve);
            const Facet facet{surfaces[curve], is_plane ? Side::on : side_of(stands_for.out + edge_out, stands_for.in + edge_in)};
            for (std::size_t s = 0; s + (turn.whole ? 0 : 1) < stations; ++s) {
                const std::size_t t = (s + 1) % stations;
                builder.add_triangle(a[s], a[t], b[t], facet);
                builder.add_triangle(a[s], b[t], b[s], facet);
            }
        }
        rings.push_back(std::move(of_loop));
    }
    if (!turn.whole) {
        const auto triangles = face_triangles(drawing, *polygons, name);
        if (!triangles) return triangles.errors();
        std::vector<const std::vector<int>*> points;
        for (const auto& of_loop : rings)
            for (const auto& ring : of_loop) points.push_back(&ring);
        for (const bool last : {false, true}) {
            const Point2& d = (last ? turn.stations.back() : turn.stations.front()).direction;
            Surface plane;
            plane.feature = end_of_feature(name);
            plane.axis = last ? std::array<Number, 3>{-d.y, d.x, 0} : std::array<Number, 3>{d.y, -d.x, 0};
            const Facet facet{builder.add_surface(plane), Side::on};
            for (const auto& t : *triangles) {
                const auto v = [&](std::size_t k) {
                    const auto& ring = *points[t[k]];
                    return last ? ring.back() : ring.front();
                };
                builder.add_triangle_facing(!last, v(0), v(1), v(2), facet);
            }
        }
    } else if (const auto fault = face_fault(*polygons)) {
        return *fault;
    }
    builder.add_deviation(curve_out + turn_out, curve_in + turn_in, proven);
    return builder.take();
}

}  // namespace

Result<Solid> revolved(Drawing& drawing, const Profile& profile) { return turned_solid(drawing, profile, nullptr, nullptr); }

Result<Solid> revolved(Drawing& drawing, const Profile& profile, const Number& from, const Number& angle) {
    return turned_solid(drawing, profile, &from, &angle);
}

Result<Solid> sphere(Drawing& drawing, const Number& radius, std::string feature) {
    const auto profile = Path({0, -radius}, std::move(feature)).arc_by({}, std::numbers::pi).closed();
    if (!profile) return profile.errors();
    const auto half_disc = filled(*profile);
    return half_disc ? revolved(drawing, *half_disc) : Result<Solid>(half_disc.errors());
}

Result<Solid> cone(Drawing& drawing, const Number& radius, const Number& top_radius, const Number& height, std::string feature) {
    Path path({0, 0}, std::move(feature));
    path.line_to({radius, 0});
    if (top_radius.value > 0) path.line_to({top_radius, height});
    const auto loop = path.line_to({0, height}).closed();
    if (!loop) return loop.errors();
    const auto profile = filled(*loop);
    return profile ? revolved(drawing, *profile) : Result<Solid>(profile.errors());
}

Result<Solid> torus(Drawing& drawing, const Number& ring_radius, const Number& tube_radius, std::string feature) {
    const auto profile = filled(circle({ring_radius, 0}, tube_radius, std::move(feature)));
    return profile ? revolved(drawing, *profile) : Result<Solid>(profile.errors());
}

}  // namespace fettle::core::parts
