// SPDX-License-Identifier: MIT
#include "core/parts/solid.hpp"

#include <algorithm>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::core::parts {
namespace {

using Rotation = std::array<Point3, 3>;  ///< columns

Point3 applied(const Rotation& r, const Point3& p) { return p.x * r[0] + p.y * r[1] + p.z * r[2]; }

Point3 point_of(const std::array<Number, 3>& p) { return {p[0], p[1], p[2]}; }
std::array<Number, 3> array_of(const Point3& p) { return {p.x, p.y, p.z}; }

Solid placed(Solid solid, const Rotation& rotation, const Point3& shift, bool mirrors) {
    for (Point3& p : solid.vertices) p = applied(rotation, p) + shift;
    for (Surface& surface : solid.surfaces) {
        surface.point = array_of(applied(rotation, point_of(surface.point)) + shift);
        surface.axis = array_of(applied(rotation, point_of(surface.axis)));
        // Mirrored, a helix winds the other way.
        if (mirrors && surface.kind == SurfaceKind::helical) surface.slope = -surface.slope;
    }
    if (mirrors)
        for (auto& t : solid.triangles) std::swap(t[1], t[2]);
    return solid;
}

Rotation rotation_about(const Point3& axis, const Point2& d) {
    FETTLE_ASSERT(value(axis).norm() > 0, "an axis has a length");
    // The axes of the frame stay exact.
    if (axis.x.is_constant() && axis.y.is_constant() && axis.z.is_constant()) {
        const Vector3 a = value(axis);
        const auto along = [&](int k) { return a[k] != 0 && a[(k + 1) % 3] == 0 && a[(k + 2) % 3] == 0; };
        const auto signed_sine = [&](int k) { return a[k] > 0 ? d.y : -d.y; };
        if (along(2)) return {Point3{d.x, signed_sine(2), 0}, Point3{-signed_sine(2), d.x, 0}, Point3{0, 0, 1}};
        if (along(1)) return {Point3{d.x, 0, -signed_sine(1)}, Point3{0, 1, 0}, Point3{signed_sine(1), 0, d.x}};
        if (along(0)) return {Point3{1, 0, 0}, Point3{0, d.x, signed_sine(0)}, Point3{0, -signed_sine(0), d.x}};
    }
    // Rodrigues: c I + s [a] + (1 - c) a a^T.
    const Point3 a = (1.0 / length(axis)) * axis;
    const Number rest = 1.0 - d.x;
    return {Point3{d.x + rest * a.x * a.x, d.y * a.z + rest * a.x * a.y, rest * a.x * a.z - d.y * a.y},
            Point3{rest * a.x * a.y - d.y * a.z, d.x + rest * a.y * a.y, d.y * a.x + rest * a.y * a.z},
            Point3{d.y * a.y + rest * a.x * a.z, rest * a.y * a.z - d.y * a.x, d.x + rest * a.z * a.z}};
}

Solid turned_by(const Solid& solid, const Point3& axis, const Point2& d, const Point3& about) {
    const Rotation rotation = rotation_about(axis, d);
    return placed(solid, rotation, about - applied(rotation, about), false);
}

Solid numbered(Solid solid, int k) {
    for (Surface& surface : solid.surfaces)
        if (!surface.feature.empty()) surface.feature += " " + std::to_string(k + 1);
    return solid;
}

}  // namespace

Solid moved(const Solid& solid, const Point3& by) {
    Solid out = solid;
    for (Point3& p : out.vertices) p = p + by;
    for (Surface& surface : out.surfaces) surface.point = array_of(point_of(surface.point) + by);
    return out;
}

Solid turned(const Solid& solid, const Point3& axis, const Number& angle, const Point3& about) {
    return turned_by(solid, axis, direction(angle), about);
}

Solid mirrored(const Solid& solid, const Point3& normal, const Point3& point) {
    FETTLE_ASSERT(value(normal).norm() > 0, "a normal has a length");
    // x -> x - 2 (n . (x - point)) n / |n|^2
    const Number twice = 2.0 / dot(normal, normal);
    const auto column = [&](const Point3& unit, const Number& along) { return unit - (twice * along) * normal; };
    const Rotation rotation{column({1, 0, 0}, normal.x), column({0, 1, 0}, normal.y), column({0, 0, 1}, normal.z)};
    return placed(solid, rotation, (twice * dot(normal, point)) * normal, true);
}

std::vector<Solid> polar_copies(const Solid& solid, int count, const Point3& axis, const Point3& about) {
    std::vector<Solid> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(turned_by(solid, axis, direction(k, count), about), k));
    return out;
}

std::vector<Solid> polar_copies(const Solid& solid, int count, const Number& step, const Point3& axis, const Point3& about) {
    std::vector<Solid> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(turned(solid, axis, static_cast<double>(k) * step, about), k));
    return out;
}

std::vector<Solid> linear_copies(const Solid& solid, int count, const Point3& step) {
    std::vector<Solid> out;
    for (int k = 0; k < count; ++k) out.push_back(numbered(moved(solid, Number(k) * step), k));
    return out;
}

Solid together(const std::vector<Solid>& solids) {
    Solid out;
    for (const Solid& solid : solids) {
        const int first = count_of(out.vertices), first_surface = count_of(out.surfaces);
        out.vertices.insert(out.vertices.end(), solid.vertices.begin(), solid.vertices.end());
        for (const auto& t : solid.triangles) out.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        for (const Facet& facet : solid.facets) out.facets.push_back({facet.surface + first_surface, facet.side});
        out.surfaces.insert(out.surfaces.end(), solid.surfaces.begin(), solid.surfaces.end());
        out.deviation.add(solid.deviation);
        out.rounding = std::max(out.rounding, solid.rounding);
    }
    return out;
}

}  // namespace fettle::core::parts
