// SPDX-License-Identifier: MIT
#include "core/parts/extrude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.hpp"
#include "core/parts/arrangement.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/levels.hpp"
#include "core/parts/solid_builder.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Triangle;

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

/// Per loop and polygon edge: the vertices along it, both ends included; more than two where another layer meets it.
using Rim = std::vector<std::vector<std::vector<int>>>;

Rim plain_rim(const Level& level, SolidBuilder& builder) {
    Rim rim;
    for (const FacetedLoop& loop : level.polygons.loops) {
        std::vector<int> ring;
        for (const Point2& p : loop.points) ring.push_back(builder.add_vertex({p.x, p.y, level.z}));
        std::vector<std::vector<int>> edges;
        for (std::size_t k = 0; k < ring.size(); ++k) edges.push_back({ring[k], ring[(k + 1) % ring.size()]});
        rim.push_back(std::move(edges));
    }
    return rim;
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

void add_walls(const Level& low, const Level& high, const Rim& low_rim, const Rim& high_rim, SolidBuilder& builder) {
    std::vector<int> surfaces;
    for (std::size_t k = 0; k < low.polygons.curves.size(); ++k)
        surfaces.push_back(
            builder.add_surface(wall_surface(low.polygons.curves[k], high.polygons.curves[k], low.z, high.z, low.straight_above)));
    for (std::size_t l = 0; l < low_rim.size(); ++l) {
        for (std::size_t k = 0; k < low_rim[l].size(); ++k) {
            const auto curve = static_cast<std::size_t>(low.polygons.loops[l].curve[k]);
            const FacetedCurve &from = low.polygons.curves[curve], &to = high.polygons.curves[curve];
            const Facet facet{surfaces[curve], side_of(std::max(from.out, to.out), std::max(from.in, to.in))};
            builder.add_strip(low_rim[l][k], high_rim[l][k], facet);
        }
    }
    if (!low.straight_above) add_turned_arcs(low.polygons, high.polygons, builder);
}

Facet plane_facet(const Number& z, bool upwards, const std::string& feature, SolidBuilder& builder) {
    Surface plane;
    plane.feature = end_of_feature(feature);
    plane.point = {0, 0, z};
    plane.axis = {0, 0, upwards ? 1 : -1};
    return {builder.add_surface(plane), Side::on};
}

std::optional<Errors> add_end(Drawing& drawing, const Level& level, const Rim& rim, bool upwards, const std::string& feature,
                              SolidBuilder& builder) {
    const auto triangles = face_triangles(drawing, level.polygons, feature);
    if (!triangles) return triangles.errors();
    std::vector<int> vertices;
    for (const auto& ring : rim)
        for (const auto& edge : ring) vertices.push_back(edge.front());
    const Facet facet = plane_facet(level.z, upwards, feature, builder);
    for (const Triangle& t : *triangles) {
        const auto v = [&](std::size_t k) { return vertices[t[k]]; };
        builder.add_triangle_facing(upwards, v(0), v(1), v(2), facet);
    }
    return std::nullopt;
}

std::vector<Loop> polygon_loops(const FacetedProfile& polygons) {
    std::vector<Loop> loops;
    for (const FacetedLoop& polygon : polygons.loops) {
        Loop loop;
        for (std::size_t k = 0; k < polygon.points.size(); ++k)
            loop.segments.push_back(
                {Line{polygon.points[k], polygon.points[(k + 1) % polygon.points.size()]}, polygons.curves[polygon.curve[k]].feature, {}});
        loops.push_back(std::move(loop));
    }
    return loops;
}

/// Where two layers meet: their rims, cut by each other, and the faces between them.
struct Step {
    Rim below, above;
};

// The rim of one of the two, from the arrangement's nodes.
Rim cut_rim(const Arrangement& arrangement, const std::vector<Loop>& loops, std::size_t first_source, const std::vector<int>& vertex) {
    std::vector<std::vector<int>> chains;  // of an edge shorter than the tolerance: a point
    for (const int start : arrangement.starts) chains.push_back({vertex[start]});
    for (const Piece& piece : arrangement.pieces) chains[piece.source].push_back(vertex[piece.to]);
    Rim rim;
    std::size_t source = first_source;
    for (const Loop& loop : loops) {
        std::vector<std::vector<int>> edges;
        for (std::size_t k = 0; k < loop.segments.size(); ++k) edges.push_back(chains[source++]);
        rim.push_back(std::move(edges));
    }
    return rim;
}

std::optional<Errors> add_step_face(Drawing& drawing, const Arrangement& arrangement, const std::vector<Piece>& pieces,
                                    const std::vector<int>& vertex, const Number& z, bool upwards, const std::string& feature,
                                    SolidBuilder& builder) {
    if (pieces.empty()) return std::nullopt;
    const auto chains = chains_from(arrangement, pieces);
    if (!chains) return chains.errors();
    FacetedProfile region;
    std::vector<int> vertices;
    for (const auto& chain : *chains) {
        FacetedLoop loop;
        for (const std::size_t k : chain) {
            loop.points.push_back(arrangement.nodes[pieces[k].from]);
            loop.curve.push_back(count_of(region.curves));
            region.curves.push_back({{}, arrangement.curves[pieces[k].source].segment.feature, 0, 0, true});
            vertices.push_back(vertex[pieces[k].from]);
        }
        region.loops.push_back(std::move(loop));
    }
    const auto triangles = face_triangles(drawing, region, feature);
    if (!triangles) return triangles.errors();
    const Facet facet = plane_facet(z, upwards, feature, builder);
    for (const Triangle& t : *triangles) {
        const auto v = [&](std::size_t k) { return vertices[t[k]]; };
        builder.add_triangle_facing(upwards, v(0), v(1), v(2), facet);
    }
    return std::nullopt;
}

Result<Step> add_step(Drawing& drawing, const Level& below, const Level& above, const std::string& name_below,
                      const std::string& name_above, SolidBuilder& builder) {
    const std::vector<Loop> a = polygon_loops(below.polygons), b = polygon_loops(above.polygons);
    std::vector<ArrangedCurve> curves;
    std::size_t first_above = 0;
    double size = 0;
    for (const int group : {0, 1}) {
        if (group == 1) first_above = curves.size();
        for (const Loop& loop : group == 0 ? a : b) {
            for (const Segment& segment : loop.segments) {
                curves.push_back({segment, group});
                size = std::max(size, value(start_of(segment.curve)).cwiseAbs().maxCoeff());
            }
        }
    }
    const Arrangement arrangement = arranged(std::move(curves), 1e-9 * size, false);
    std::vector<int> combinatorics;
    for (const Piece& piece : arrangement.pieces) {
        combinatorics.push_back(static_cast<int>(piece.source));
        combinatorics.push_back(piece.from);
        combinatorics.push_back(piece.to);
    }
    drawing.note("step from " + quoted_profile(name_below) + " to " + quoted_profile(name_above), combinatorics);
    if (bounding(arrangement, a, b, Combination::intersect).empty())
        return Error{ErrorCode::inconsistent, name_above,
                     quoted_profile(name_above) + " does not stand on " + quoted_profile(name_below) + ", the layer below it"};
    double moved = 0;  // corners that became one
    for (std::size_t k = 0; k < arrangement.curves.size(); ++k)
        moved = std::max(moved,
                         (value(start_of(arrangement.curves[k].segment.curve)) - value(arrangement.nodes[arrangement.starts[k]])).norm());
    builder.add_rounding(moved);
    std::vector<int> vertex;
    for (const Point2& p : arrangement.nodes) vertex.push_back(builder.add_vertex({p.x, p.y, below.z}));
    if (auto errors = add_step_face(drawing, arrangement, bounding(arrangement, a, b, Combination::subtract), vertex, below.z, true,
                                    name_below, builder))
        return *errors;
    // What overhangs: the layer above without the one below, seen from it.
    Arrangement swapped = arrangement;
    for (ArrangedCurve& curve : swapped.curves) curve.group = 1 - curve.group;
    if (auto errors =
            add_step_face(drawing, swapped, bounding(swapped, b, a, Combination::subtract), vertex, below.z, false, name_above, builder))
        return *errors;
    return Step{cut_rim(arrangement, a, 0, vertex), cut_rim(arrangement, b, first_above, vertex)};
}

}  // namespace

Result<Solid> stacked(Drawing& drawing, const std::vector<Layer>& layers) {
    if (layers.empty()) return Error{ErrorCode::inconsistent, {}, "a stack has no layers"};
    for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
        const double gap = layers[k + 1].from.value - layers[k].to.value;
        if (std::abs(gap) > 1e-12 * std::abs(layers[k].to.value - layers[k].from.value))
            return Error{ErrorCode::inconsistent, name_of(layers[k + 1]),
                         quoted_profile(name_of(layers[k + 1])) +
                             (gap > 0 ? " begins " : " begins below the end of the layer before it, by ") + millimetres(std::abs(gap)) +
                             (gap > 0 ? " above the end of the layer before it" : "") + ": layers follow each other"};
    }
    std::vector<std::vector<Level>> stack;
    for (const Layer& layer : layers) {
        auto levels = levels_of(drawing, layer);
        if (!levels) return levels.errors();
        stack.push_back(std::move(*levels));
    }
    SolidBuilder builder;
    for (const auto& levels : stack)
        for (const Level& level : levels)
            for (const FacetedCurve& curve : level.polygons.curves) builder.add_deviation(curve.out, curve.in, curve.proven);
    Rim lower = plain_rim(stack.front().front(), builder);
    if (auto errors = add_end(drawing, stack.front().front(), lower, false, name_of(layers.front()), builder)) return *errors;
    for (std::size_t k = 0; k < stack.size(); ++k) {
        const auto& levels = stack[k];
        for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
            const bool is_last = i + 2 == levels.size(), meets_next = is_last && k + 1 < stack.size();
            Step step;
            if (meets_next) {
                auto made = add_step(drawing, levels[i + 1], stack[k + 1].front(), name_of(layers[k]), name_of(layers[k + 1]), builder);
                if (!made) return made.errors();
                step = std::move(*made);
            } else {
                step.below = plain_rim(levels[i + 1], builder);
                step.above = step.below;
            }
            add_walls(levels[i], levels[i + 1], lower, step.below, builder);
            lower = std::move(step.above);
        }
    }
    if (auto errors = add_end(drawing, stack.back().back(), lower, true, name_of(layers.back()), builder)) return *errors;
    return builder.take();
}

Result<Solid> extruded(Drawing& drawing, const Profile& profile, const Number& from, const Number& to, const End& lower, const End& upper) {
    return stacked(drawing, {{profile, from, to, lower, upper, {}}});
}

}  // namespace fettle::core::parts
