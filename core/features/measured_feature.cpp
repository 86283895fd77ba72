// SPDX-License-Identifier: MIT
#include "core/features/measured_feature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/features/merged_regions.hpp"
#include "core/geometry/distance.hpp"

namespace fettle::core::features {

namespace {

constexpr double turn = 2 * std::numbers::pi;

// Along the largest coordinate; of two as large the first.
Vector3 upright(const Vector3& axis) {
    int largest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(axis[k]) > std::abs(axis[largest]) + 1e-6) largest = k;
    return axis[largest] < 0 ? Vector3(-axis) : axis;
}

// Covered intervals of a line, put together.
std::vector<Stretch> united(std::vector<Stretch> parts, double slack) {
    std::sort(parts.begin(), parts.end(), [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    std::vector<Stretch> out;
    for (const Stretch& part : parts) {
        if (out.empty() || part.from > out.back().to + slack) {
            out.push_back(part);
        } else {
            out.back().to = std::max(out.back().to, part.to);
        }
    }
    return out;
}

double covered_turn(const Patches& patches, const Region& region) {
    const Across across = across_of(region.surface.axis);
    const auto angle_of = [&](const Vector3& x) {
        const Vector3 d = x - region.surface.point;
        return std::atan2(d.dot(across.v), d.dot(across.u));
    };
    std::vector<Stretch> parts;
    for (const int member : region.patches) {
        const double middle = angle_of(patches.patches[member].centre);
        Stretch part{middle, middle};
        for (const int vertex : patches.patch_vertices[member]) {
            const double by = std::remainder(angle_of(patches.vertices.col(vertex)) - middle, turn);
            part = {std::min(part.from, middle + by), std::max(part.to, middle + by)};
        }
        for (const double more : {-turn, 0.0, turn}) parts.push_back({part.from + more, part.to + more});
    }
    double covered = 0;
    for (const Stretch& part : united(std::move(parts), 1e-6))
        covered += std::max(0.0, std::min(part.to, std::numbers::pi) - std::max(part.from, -std::numbers::pi));
    return std::min(covered, turn);
}

// Distance of a triangle from a line, seen along the line.
double distance_from_line(const Patches& patches, int triangle, const Surface& surface) {
    std::array<Vector3, 3> seen;
    for (int k = 0; k < 3; ++k) {
        const Vector3 d = patches.vertices.col(patches.triangles[triangle][k]) - surface.point;
        seen[k] = d - surface.axis.dot(d) * surface.axis;
    }
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const Vector3 a = seen[k], along = seen[(k + 1) % 3] - a;
        const double square = along.squaredNorm();
        const double s = square > 0 ? std::clamp(-a.dot(along) / square, 0.0, 1.0) : 0.0;
        least = std::min(least, (a + s * along).norm());
    }
    return least;
}

double distance_from_point(const Patches& patches, int triangle, const Vector3& point) {
    const auto& t = patches.triangles[triangle];
    return std::sqrt(geometry::point_triangle_distance_squared(point, patches.vertices.col(t[0]), patches.vertices.col(t[1]),
                                                               patches.vertices.col(t[2])));
}

// How far corners are from the axis, the centre or the tube's middle.
double distance_from_middle(const Surface& surface, const Vector3& x) {
    return signed_distance(surface, x) + (surface.kind == SurfaceKind::torus ? surface.slope : surface.radius);
}

void measure_facets(const Patches& patches, const Region& region, Feature& out) {
    if (out.surface.kind == SurfaceKind::cone) return;
    out.facets_least = INFINITY;
    for (const int member : region.patches) {
        for (const int v : patches.patch_vertices[member]) {
            const double at = distance_from_middle(out.surface, patches.vertices.col(v));
            out.facets_least = std::min(out.facets_least, at);
            out.facets_largest = std::max(out.facets_largest, at);
        }
        for (const int t : patches.patch_triangles[member]) {
            if (out.surface.kind == SurfaceKind::cylinder)
                out.facets_least = std::min(out.facets_least, distance_from_line(patches, t, out.surface));
            if (out.surface.kind == SurfaceKind::sphere)
                out.facets_least = std::min(out.facets_least, distance_from_point(patches, t, out.surface.point));
        }
    }
}

// What lies beyond the border: at both ends by how faces there look along the axis, at the sides whether they lean smoothly.
struct Border {
    double lower_length = 0, lower_facing = 0, upper_length = 0, upper_facing = 0;
    double side_length = 0, smooth_length = 0;

    static End end(double length, double facing) {
        constexpr double clearly = 0.2;
        if (!(length > 0) || std::abs(facing) < clearly * length) return End::cut;
        return facing > 0 ? End::open : End::closed;
    }
};

Border border_of(const Patches& patches, const Region& region, const Feature& feature, double limit) {
    Border out;
    const Vector3& axis = feature.surface.axis;
    const double middle = 0.5 * (feature.along.from + feature.along.to);
    for (const int member : region.patches)
        for (const int c : patches.patch_creases[member]) {
            const Crease& crease = patches.creases[c];
            const int q = crease.p == member ? crease.q : crease.p;
            if (std::binary_search(region.patches.begin(), region.patches.end(), q)) continue;
            const Vector3 a = patches.vertices.col(crease.a), along = patches.vertices.col(crease.b) - a;
            const double length = along.norm(), height = axis.dot(a + 0.5 * along) - middle;
            if (std::abs(axis.dot(along)) > 0.9 * length) {
                out.side_length += length;
                if (std::abs(crease.angle) <= limit) out.smooth_length += length;
                continue;
            }
            const double facing = length * axis.dot(patches.patches[q].normal);
            (height < 0 ? out.lower_length : out.upper_length) += length;
            (height < 0 ? out.lower_facing : out.upper_facing) += height < 0 ? -facing : facing;
        }
    return out;
}

void take_facets(const Patches& patches, std::span<const int> members, Feature& out) {
    for (const int member : members) {
        out.area += patches.patches[member].area;
        out.centre += patches.patches[member].area * patches.patches[member].centre;
        for (const int t : patches.patch_triangles[member]) out.triangles.push_back(patches.in_mesh[t]);
    }
    if (out.area > 0) out.centre /= out.area;
    std::sort(out.triangles.begin(), out.triangles.end());
}

void measure_length(const Patches& patches, const Region& region, Feature& out) {
    std::vector<Stretch> parts;
    for (const int member : region.patches) {
        const Reach reach = reach_along(patches, member, out.surface.axis);
        parts.push_back({reach.low, reach.high});
    }
    const double slack = 1e-6 * patches.size;
    out.pieces = united(std::move(parts), slack);
    out.along = {out.pieces.front().from, out.pieces.back().to};
    const double to = 0.5 * (out.along.from + out.along.to), by = to - out.surface.axis.dot(out.surface.point);
    out.origin = out.surface.point - out.surface.axis.dot(out.surface.point) * out.surface.axis;
    if (out.surface.kind == SurfaceKind::torus) return;  // its point is its centre
    out.surface.point += by * out.surface.axis;
    if (out.surface.kind == SurfaceKind::cone) out.surface.radius += by * out.surface.slope;
}

}  // namespace

Feature measured_feature(const Patches& patches, const Region& region, const RegionOptions& options) {
    Feature out;
    out.surface = region.surface;
    out.is_hole = region.hollow;
    out.residual = region.residual;
    take_facets(patches, region.patches, out);
    if (region.surface.kind == SurfaceKind::sphere) {
        out.surface.axis = Vector3::UnitZ();
        out.origin = out.surface.point;
        out.covered = turn * std::min(1.0, out.area / (2 * turn * out.surface.radius * out.surface.radius));
        measure_facets(patches, region, out);
        return out;
    }
    const Vector3 axis = upright(region.surface.axis);
    if (axis.dot(region.surface.axis) < 0 && out.surface.kind == SurfaceKind::cone) out.surface.slope = -out.surface.slope;
    out.surface.axis = axis;
    measure_length(patches, region, out);
    out.covered = covered_turn(patches, region);
    measure_facets(patches, region, out);
    const Border border = border_of(patches, region, out, options.limit);
    out.lower = Border::end(border.lower_length, border.lower_facing);
    out.upper = Border::end(border.upper_length, border.upper_facing);
    constexpr double most_of_a_rounding = 160 * std::numbers::pi / 180;  // half circles, less a facet, are ends of slots
    out.is_rounding =
        region.surface.kind == SurfaceKind::cylinder && out.covered < most_of_a_rounding && border.smooth_length > 0.5 * border.side_length;
    return out;
}

Feature flat_feature(const Patches& patches, int patch) {
    Feature out;
    const int members[] = {patch};
    take_facets(patches, members, out);
    out.surface.axis = patches.patches[patch].normal;
    out.surface.point = out.centre;
    out.origin = out.surface.axis.dot(out.centre) * out.surface.axis;
    for (const int v : patches.patch_vertices[patch])
        out.residual = std::max(out.residual, std::abs(signed_distance(out.surface, patches.vertices.col(v))));
    return out;
}

}  // namespace fettle::core::features
