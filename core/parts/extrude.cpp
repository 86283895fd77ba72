// SPDX-License-Identifier: MIT
#include "fettle/core/parts/extrude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fettle/core/base/units.hpp"
#include "fettle/core/parts/faceted_profile.hpp"
#include "fettle/core/parts/inset.hpp"
#include "fettle/core/parts/solid_builder.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Triangle;

std::string millimetres(double metres) { return format_length(metres, "mm", 4); }
std::string quoted(const std::string& feature) { return feature.empty() ? "the profile" : "`" + feature + "`"; }

const std::string& name_of(const Profile& profile) {
    static const std::string none;
    return profile.loops.empty() || profile.loops.front().segments.empty() ? none : profile.loops.front().segments.front().feature;
}

// What a curve that is moved along z from one level to another sweeps out; it may draw in on the way.
Surface wall_surface(const FacetedCurve& from, const FacetedCurve& to, const Number& z0, const Number& z1, bool straight) {
    Surface out;
    out.feature = from.feature;
    if (const auto* line = std::get_if<Line>(&from.curve)) {
        const auto& above = std::get<Line>(to.curve);
        const Point2 d = line->end - line->start;
        const Point3 along{d.x, d.y, 0}, up{above.start.x - line->start.x, above.start.y - line->start.y, z1 - z0};
        const Point3 normal = straight ? Point3{d.y, -d.x, 0} : cross(along, up);
        const Number size = length(normal);
        out.kind = SurfaceKind::plane;
        out.point = {line->start.x, line->start.y, z0};
        out.axis = {normal.x / size, normal.y / size, normal.z / size};
    } else if (const auto* arc = std::get_if<Arc>(&from.curve)) {
        out.kind = straight ? SurfaceKind::cylinder : SurfaceKind::cone;
        out.point = {arc->centre.x, arc->centre.y, z0};
        out.radius = arc->radius;
        if (!straight) out.slope = (std::get<Arc>(to.curve).radius - arc->radius) / (z1 - z0);
        out.hollow = !arc->counter_clockwise;
    } else {
        out.kind = SurfaceKind::extruded;
        out.point = {0, 0, z0};
    }
    return out;
}

struct Level {
    FacetedProfile polygons;
    Number z;
};

using Rings = std::vector<std::vector<int>>;  ///< per loop: its vertices

Rings add_rings(const Level& level, SolidBuilder& builder) {
    Rings rings;
    for (const FacetedLoop& loop : level.polygons.loops) {
        std::vector<int> ring;
        for (const Point2& p : loop.points) ring.push_back(builder.add_vertex({p.x, p.y, level.z}));
        rings.push_back(std::move(ring));
    }
    return rings;
}

bool same_shape(const FacetedProfile& a, const FacetedProfile& b) {
    if (a.loops.size() != b.loops.size()) return false;
    for (std::size_t l = 0; l < a.loops.size(); ++l)
        if (a.loops[l].curve != b.loops[l].curve) return false;
    return true;
}

// Facets of an arc that draws in while it rises are flat where its ends stay in their directions; else it is charged for the turn.
void add_turned_arcs(const FacetedProfile& low, const FacetedProfile& high, SolidBuilder& builder) {
    for (std::size_t k = 0; k < low.curves.size(); ++k) {
        const auto *a = std::get_if<Arc>(&low.curves[k].curve), *b = std::get_if<Arc>(&high.curves[k].curve);
        if (a == nullptr || b == nullptr || is_whole_circle(*a)) continue;
        const auto angle = [](const Vector2& p, const Vector2& q) { return std::abs(std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q))); };
        const double turned = std::max(angle(value(a->start) - value(a->centre), value(b->start) - value(b->centre)),
                                       angle(value(a->end) - value(a->centre), value(b->end) - value(b->centre)));
        if (turned < 1e-9) continue;
        int edges = 0;
        for (const FacetedLoop& loop : low.loops)
            edges += static_cast<int>(std::count(loop.curve.begin(), loop.curve.end(), static_cast<int>(k)));
        const double sweep = std::max(std::abs(sweep_of(*a).value), std::abs(sweep_of(*b).value));
        const double half = std::min(sweep / std::max(1, edges - 1) + turned, std::numbers::pi) / 2;  // of what a facet spans, at most
        const double radius = std::max(a->radius.value, b->radius.value);
        builder.add_deviation(radius * (1 - std::cos(half)), radius * (1 - std::cos(half)));
    }
}

void add_walls(const Level& low, const Level& high, const Rings& low_rings, const Rings& high_rings, bool straight, SolidBuilder& builder) {
    std::vector<int> surfaces;
    for (std::size_t k = 0; k < low.polygons.curves.size(); ++k)
        surfaces.push_back(builder.add_surface(wall_surface(low.polygons.curves[k], high.polygons.curves[k], low.z, high.z, straight)));
    for (std::size_t l = 0; l < low_rings.size(); ++l) {
        const auto &a = low_rings[l], &b = high_rings[l];
        for (std::size_t k = 0; k < a.size(); ++k) {
            const std::size_t next = (k + 1) % a.size(), curve = static_cast<std::size_t>(low.polygons.loops[l].curve[k]);
            const FacetedCurve &from = low.polygons.curves[curve], &to = high.polygons.curves[curve];
            const Facet facet{surfaces[curve], side_of(std::max(from.out, to.out), std::max(from.in, to.in))};
            builder.add_strip({a[k], a[next]}, {b[k], b[next]}, facet);
        }
    }
    if (!straight) add_turned_arcs(low.polygons, high.polygons, builder);
}

void add_deviations(const FacetedProfile& polygons, SolidBuilder& builder) {
    for (const FacetedCurve& curve : polygons.curves) builder.add_deviation(curve.out, curve.in, curve.proven);
}

Result<bool> add_face(Drawing& drawing, const Level& level, const Rings& rings, bool upwards, const std::string& feature,
                      SolidBuilder& builder) {
    const auto triangles = face_triangles(drawing, level.polygons, feature);
    if (!triangles) return triangles.errors();
    std::vector<int> vertices;
    for (const auto& ring : rings) vertices.insert(vertices.end(), ring.begin(), ring.end());
    Surface plane;
    plane.feature = feature;
    plane.point = {0, 0, level.z};
    plane.axis = {0, 0, upwards ? 1 : -1};
    const Facet facet{builder.add_surface(plane), Side::on};
    for (const Triangle& t : *triangles) {
        const auto v = [&](std::size_t k) { return vertices[static_cast<std::size_t>(t[k])]; };
        builder.add_triangle_facing(upwards, v(0), v(1), v(2), facet);
    }
    return true;
}

bool is_none(const End& end) { return end.inset.is_constant() && end.inset.value == 0; }

// The levels of a layer from below; neighbours with the same outline are joined by straight walls.
Result<std::vector<Level>> levels_of(Drawing& drawing, const Layer& layer) {
    const double height = layer.to.value - layer.from.value;
    const std::string& name = layer.feature.empty() ? name_of(layer.profile) : layer.feature;
    if (!(height > 0)) return Error{ErrorCode::out_of_range, name, quoted(name) + " has no height: " + millimetres(height)};
    double ends = 0;
    for (const End* end : {&layer.lower, &layer.upper}) {
        if (is_none(*end)) continue;
        if (!(end->height.value > 0))
            return Error{ErrorCode::out_of_range, name,
                         "the end of " + quoted(name) + " draws in by " + millimetres(end->inset.value) + " over no height"};
        ends += end->height.value;
    }
    if (ends > height * (1 + 1e-12))
        return Error{ErrorCode::out_of_range, name,
                     "the ends of " + quoted(name) + " draw in over " + millimetres(ends) + ", which is more than its height, " +
                         millimetres(height)};
    auto base = faceted(drawing, layer.profile);
    if (!base) return base.errors();
    const auto drawn_in = [&](const End& end) -> Result<FacetedProfile> {
        auto profile = inset(layer.profile, end.inset);
        if (!profile) return profile.errors();
        // With as many segments as the outline has.
        for (std::size_t l = 0, curve = 0; l < profile->loops.size(); ++l) {
            for (std::size_t s = 0; s < profile->loops[l].segments.size(); ++s, ++curve) {
                Segment& segment = profile->loops[l].segments[s];
                Facets facets = segment.facets ? *segment.facets : drawing.facets;
                if (!std::holds_alternative<Line>(segment.curve)) facets.chord = 0;
                segment.facets = facets;
            }
        }
        FacetedProfile out;
        for (std::size_t l = 0, curve = 0; l < profile->loops.size(); ++l) {
            FacetedLoop polygon;
            const FacetedLoop& model = base->loops[l];
            for (const Segment& segment : profile->loops[l].segments) {
                const int index = static_cast<int>(curve++);
                const bool is_line = std::holds_alternative<Line>(segment.curve);
                const int edges = static_cast<int>(std::count(model.curve.begin(), model.curve.end(), index));
                Chain chain;
                if (!is_line) {
                    const auto* arc = std::get_if<Arc>(&segment.curve);
                    const bool around = arc != nullptr && !is_whole_circle(*arc) && segment.facets->lean != Lean::through &&
                                        arc->counter_clockwise == (segment.facets->lean == Lean::cover);
                    chain = chain_of(segment.curve, around ? edges - 1 : edges, segment.facets->lean);
                }
                out.curves.push_back({segment.curve, segment.feature, chain.out, chain.in, chain.proven});
                if (chain.through_start) {
                    polygon.points.push_back(start_of(segment.curve));
                    polygon.curve.push_back(index);
                }
                for (const Point2& p : chain.inner) {
                    polygon.points.push_back(p);
                    polygon.curve.push_back(index);
                }
            }
            out.loops.push_back(std::move(polygon));
        }
        if (!same_shape(*base, out))
            return Error{ErrorCode::out_of_range, name,
                         "the end of " + quoted(name) + " cannot be drawn in: an edge vanishes; take a smaller inset"};
        return out;
    };
    std::vector<Level> levels;
    if (is_none(layer.lower)) {
        levels.push_back({*base, layer.from});
    } else {
        auto end = drawn_in(layer.lower);
        if (!end) return end.errors();
        levels.push_back({std::move(*end), layer.from});
        if (!(layer.lower.height.value >= height * (1 - 1e-12))) levels.push_back({*base, layer.from + layer.lower.height});
    }
    if (is_none(layer.upper)) {
        levels.push_back({std::move(*base), layer.to});
    } else {
        auto end = drawn_in(layer.upper);
        if (!end) return end.errors();
        const bool has_base = layer.to.value - layer.upper.height.value > levels.back().z.value + 1e-12 * height;
        if (has_base) levels.push_back({std::move(*base), layer.to - layer.upper.height});
        levels.push_back({std::move(*end), layer.to});
    }
    return levels;
}

}  // namespace

Result<Solid> extruded(Drawing& drawing, const Profile& profile, const Number& from, const Number& to, const End& lower, const End& upper) {
    const auto levels = levels_of(drawing, {profile, from, to, lower, upper, {}});
    if (!levels) return levels.errors();
    SolidBuilder builder;
    std::vector<Rings> rings;
    for (const Level& level : *levels) {
        rings.push_back(add_rings(level, builder));
        add_deviations(level.polygons, builder);
    }
    const std::string& name = name_of(profile);
    const auto bottom = add_face(drawing, levels->front(), rings.front(), false, name, builder);
    if (!bottom) return bottom.errors();
    for (std::size_t k = 0; k + 1 < levels->size(); ++k) {
        const bool straight = !((k == 0 && !is_none(lower)) || (k + 2 == levels->size() && !is_none(upper)));
        add_walls((*levels)[k], (*levels)[k + 1], rings[k], rings[k + 1], straight, builder);
    }
    const auto top = add_face(drawing, levels->back(), rings.back(), true, name, builder);
    if (!top) return top.errors();
    return builder.take();
}

}  // namespace fettle::core::parts
