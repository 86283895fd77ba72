// SPDX-License-Identifier: MIT
#include "core/parts/turned_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::core::parts {

Result<Solid> turned_section(Drawing& drawing, const FacetedProfile& section, SectionPlane plane, const Number& from, const Number& angle,
                             const Number& rise, int steps, const std::string& feature) {
    const auto triangles = face_triangles(drawing, section, feature);
    if (!triangles) return triangles.errors();
    SolidBuilder builder;
    const bool across = plane == SectionPlane::across;
    // Per station: all points of the section, loop after loop.
    std::vector<std::vector<int>> stations;
    for (int k = 0; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        const Point2 d = direction(share * angle);
        const Number lift = from + share * rise;
        std::vector<int> vertices;
        for (const FacetedLoop& loop : section.loops) {
            for (const Point2& p : loop.points) {
                if (across) {
                    const Point2 q = turned(p, d);
                    vertices.push_back(builder.add_vertex({q.x, q.y, lift}));
                } else {
                    vertices.push_back(builder.add_vertex({p.x * d.x, p.x * d.y, p.y + lift}));
                }
            }
        }
        stations.push_back(std::move(vertices));
    }
    const double step = std::abs(angle.value) / steps;
    double bent = 0, out = 0, in = 0;
    bool proven = true;
    std::vector<int> surfaces;
    for (const FacetedCurve& curve : section.curves) {
        Surface surface;
        surface.kind = SurfaceKind::helical;
        surface.feature = curve.feature;
        surface.slope = angle.value == 0 ? Number(0) : rise * (2 * std::numbers::pi) / angle;
        surfaces.push_back(builder.add_surface(surface));
        out = std::max(out, curve.out);
        in = std::max(in, curve.in);
        proven = proven && curve.proven;
    }
    // Rising along z the section's left is inside: seen from outside its edges run to the right where it rises.
    const bool upwards = across ? rise.value > 0 : angle.value < 0;
    std::size_t first = 0;
    for (const FacetedLoop& loop : section.loops) {
        const std::size_t n = loop.points.size();
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t next = (k + 1) % n;
            const Vector2 p = value(loop.points[k]), q = value(loop.points[next]);
            const double reach = across ? std::max(p.norm(), q.norm()) : std::max(std::abs(p.x()), std::abs(q.x()));
            const double slide = across ? (q - p).norm() : std::abs(q.x() - p.x());
            bent = std::max(bent, (2 * slide * step + reach * step * step) / 8);
            const Facet facet{surfaces[loop.curve[k]], Side::both};
            for (std::size_t s = 0; s + 1 < stations.size(); ++s) {
                const int a = stations[s][first + k], b = stations[s][first + next], c = stations[s + 1][first + next],
                          d = stations[s + 1][first + k];
                // The four are not in a plane: diagonals in turn, so that the volume is not biased.
                if (s % 2 == 0) {
                    builder.add_triangle_facing(upwards, a, b, c, facet);
                    builder.add_triangle_facing(upwards, a, c, d, facet);
                } else {
                    builder.add_triangle_facing(upwards, a, b, d, facet);
                    builder.add_triangle_facing(upwards, b, c, d, facet);
                }
            }
        }
        first += n;
    }
    builder.add_deviation(out + bent, in + bent, proven);
    for (const bool last : {false, true}) {
        const Point2 d = direction(last ? angle : Number(0));
        Surface end;
        end.feature = end_of_feature(feature);
        const double sign = last == upwards ? 1 : -1;
        if (across) {
            end.point = {0, 0, last ? from + rise : from};
            end.axis = {0, 0, last == (rise.value > 0) ? 1 : -1};
        } else {
            end.axis = {sign * d.y, -sign * d.x, 0};
        }
        const Facet facet{builder.add_surface(end), Side::on};
        const auto& vertices = last ? stations.back() : stations.front();
        for (const auto& t : *triangles) {
            const auto v = [&](std::size_t k) { return vertices[t[k]]; };
            builder.add_triangle_facing(last == upwards, v(0), v(1), v(2), facet);
        }
    }
    return builder.take();
}

}  // namespace fettle::core::parts
