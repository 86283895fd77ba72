// SPDX-License-Identifier: MIT
#include "core/geometry/round_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::geometry {
namespace {

bool is_round(CornerKind kind) { return kind == CornerKind::convex_round || kind == CornerKind::concave_round; }

// A regular polygon: all arcs about one line, and none left of its planes.
bool is_circle(const RoundSurfaces& all, const RoundedSide& side, const RoundSurfaces::Side& surface) {
    constexpr double alike = 1e-6;
    if (!side.closed || !is_round(side.corners[0].kind)) return false;
    const double radius = all.radii[surface.first_centre];
    for (int k = 1; k < count_of(side.corners); ++k) {
        if (side.corners[k].kind != side.corners[0].kind) return false;
        const int c = surface.first_centre + 2 * k;
        if ((all.centres.col(c) - all.centres.col(surface.first_centre)).norm() > alike * radius) return false;
        if (std::abs(all.radii[c] - radius) > alike * radius) return false;
    }
    return true;
}

RoundSurfaces::Side surface_of(const Mesh& mesh, const RoundedSide& side) {
    RoundSurfaces::Side out;
    out.across_1 = side.axis.unitOrthogonal();
    out.across_2 = side.axis.cross(out.across_1);
    const int count = count_of(side.corners);
    for (int k = 0; k < side.rectangles(); ++k) {
        const Vector3 along = mesh.vertices.col(side.corners[(k + 1) % count].rim[0]) - mesh.vertices.col(side.corners[k].rim[0]);
        const Vector3 outward = along.cross(side.axis).normalized();
        out.normals.emplace_back(outward.dot(out.across_1), outward.dot(out.across_2));
        out.lengths.push_back(along.norm());
    }
    for (int k = 0; k < count; ++k) {
        const bool has_both = side.closed || (k > 0 && k + 1 < count);
        const double before = has_both ? out.lengths[(k + count - 1) % count] : 0;
        out.tangents.push_back(has_both && is_round(side.corners[k].kind) ? 0.5 * std::min(before, out.lengths[k]) : 0);
    }
    return out;
}

}  // namespace

bool RoundSurfaces::any() const {
    return std::any_of(mesh_sides.sides.begin(), mesh_sides.sides.end(), [](const RoundedSide& side) { return side.is_round(); });
}

std::array<int, 3> RoundSurfaces::vertices_of(const Place& place) const {
    const RoundedSide& side = mesh_sides.sides[place.side];
    const int count = count_of(side.corners);
    const auto vertex = [&](int corner) { return side.corners[(corner + count) % count].rim[place.end]; };
    return {vertex(place.corner - 1), vertex(place.corner), vertex(place.corner + 1)};
}

RoundSurfaces round_surfaces(const Mesh& mesh) {
    RoundSurfaces out;
    out.mesh_sides = rounded_sides(mesh);
    int centres = 0;
    for (const RoundedSide& side : out.mesh_sides.sides) centres += 2 * count_of(side.corners);
    out.centres.resize(3, centres);
    out.radii.assign(centres, 0);
    for (int s = 0; s < count_of(out.mesh_sides.sides); ++s) {
        const RoundedSide& side = out.mesh_sides.sides[s];
        RoundSurfaces::Side& surface = out.sides.emplace_back(surface_of(mesh, side));
        surface.first_centre = count_of(out.places);
        for (int k = 0; k < count_of(side.corners); ++k)
            for (int end = 0; end < 2; ++end) {
                const int c = count_of(out.places);
                out.places.push_back({s, k, end});
                out.centres.col(c) = mesh.vertices.col(side.corners[k].rim[end]);
                if (!is_round(side.corners[k].kind)) continue;
                const auto [before, here, after] = out.vertices_of(out.places.back());
                const RoundedCorner corner = rounded_corner(mesh.vertices.col(before), mesh.vertices.col(here), mesh.vertices.col(after));
                out.centres.col(c) = corner.centre;
                out.radii[c] = corner.radius;
                out.largest_height = std::max(out.largest_height, corner.height);
                if (end == 0 && side.corners[k].kind == CornerKind::convex_round && corner.height > surface.cover) {
                    surface.cover = corner.height;
                    surface.cover_corner = k;
                }
            }
        surface.is_circle = is_circle(out, side, surface);
    }
    return out;
}

}  // namespace fettle::core::geometry
