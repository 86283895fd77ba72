// SPDX-License-Identifier: MIT
#include "core/step_importer/surface_bound.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::step_importer {
namespace {

/// The largest |cos| (|sin| with quarter = 1) over [from, to].
double largest_cosine(double from, double to, double quarter = 0) {
    const double shift = quarter * M_PI / 2, a = from - shift, b = to - shift;
    if (std::floor(b / M_PI) > std::floor(a / M_PI) || to - from >= M_PI) return 1;
    return std::max(std::abs(std::cos(a)), std::abs(std::cos(b)));
}

/// The largest R + r cos v over [from, to], in absolute value.
double largest_ring(double major, double minor, double from, double to) {
    const bool holds_top = std::floor(to / (2 * M_PI)) > std::floor(from / (2 * M_PI)) || to - from >= 2 * M_PI;
    const double most = holds_top ? 1 : std::max(std::cos(from), std::cos(to));
    const double least = std::min(std::cos(from), std::cos(to));
    return std::max(std::abs(major + minor * most), std::abs(major - minor * (minor > major ? 1 : -std::min(least, most))));
}

double from_axis(const SurfaceShape& surface, const Vector3d& place) {
    const Vector3d arm = place - surface.point;
    return (arm - arm.dot(surface.axis) * surface.axis).norm();
}

/// The angle about the axis that the corners span; more than a half turn: 2 pi.
double turned(const SurfaceShape& surface, const std::array<Corner, 3>& corners) {
    if (surface.is_recognised) {
        double most = 0, sum = 0;
        for (int k = 0; k < 3; ++k) {
            const Vector3d a = ray_at(surface, corners[k].place), b = ray_at(surface, corners[(k + 1) % 3].place);
            const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
            most = std::max(most, angle);
            sum += angle;
        }
        constexpr double rounding = 1e-9;
        return most + rounding < sum - most ? 2 * M_PI : most;
    }
    // u is that angle; at a cone's apex it says nothing.
    double low = INFINITY, high = -INFINITY, farthest = 0;
    for (const Corner& corner : corners) farthest = std::max(farthest, from_axis(surface, corner.place));
    for (const Corner& corner : corners) {
        if (from_axis(surface, corner.place) <= 1e-12 * farthest) continue;
        low = std::min(low, corner.uv[0]);
        high = std::max(high, corner.uv[0]);
    }
    return high - low;
}

/// In a sphere: rays meet it no farther inside than its circle's centre is.
double spherical(const SurfaceShape& surface, const std::array<Corner, 3>& corners) {
    const Vector3d e = corners[1].place - corners[0].place, f = corners[2].place - corners[0].place, g = f - e;
    const double twice_area = e.cross(f).norm(), sides = e.norm() * f.norm() * g.norm();
    if (!(twice_area > 0)) {  // on an edge: half of its length
        const double half = std::max({e.norm(), f.norm(), g.norm()}) / 2;
        return half < surface.radius ? surface.radius - std::sqrt(surface.radius * surface.radius - half * half) : surface.radius;
    }
    const double longest = std::max({e.norm(), f.norm(), g.norm()});
    const bool is_obtuse = 2 * longest * longest > e.squaredNorm() + f.squaredNorm() + g.squaredNorm();
    // The point nearest to the centre: the circle's centre where the triangle holds it, else in the middle of the longest side.
    const double circle = is_obtuse ? longest / 2 : sides / (2 * twice_area);
    return circle < surface.radius ? surface.radius - std::sqrt(surface.radius * surface.radius - circle * circle) : surface.radius;
}

double radial(const SurfaceShape& surface, const std::array<Corner, 3>& corners) {
    if (surface.kind == SurfaceShape::Kind::sphere) return spherical(surface, corners);
    double radius = surface.radius;
    if (surface.kind == SurfaceShape::Kind::cone) {
        radius = 0;
        for (const Corner& corner : corners) radius = std::max(radius, from_axis(surface, corner.place));
    }
    const double angle = turned(surface, corners);
    if (angle >= M_PI) return 2 * radius;
    const double half = std::sin(angle / 4);
    return 2 * radius * half * half;  // r (1 - cos(angle / 2))
}

}  // namespace

const char* name_of(SurfaceShape::Kind kind) {
    const char* names[] = {"plane", "cylinder", "cone", "sphere", "torus", "extrusion", "revolution", "spline", "surface"};
    return names[static_cast<int>(kind)];
}

Vector3d ray_at(const SurfaceShape& surface, const Vector3d& place) {
    const Vector3d arm = place - surface.point;
    const Vector3d ray = surface.kind == SurfaceShape::Kind::sphere ? arm : Vector3d(arm - arm.dot(surface.axis) * surface.axis);
    const double length = ray.norm();
    return length > 1e-12 * arm.norm() ? Vector3d(ray / length) : Vector3d(Vector3d::Zero());
}

std::optional<CurveSuprema> suprema(const CurveShape& curve, double from, double to) {
    using Kind = CurveShape::Kind;
    if (from > to) std::swap(from, to);
    const double far = std::max(std::abs(from), std::abs(to));
    switch (curve.kind) {
        case Kind::line:
            return CurveSuprema{curve.a, 0, 0};
        case Kind::circle:
            return CurveSuprema{curve.a, curve.a, 0};
        case Kind::ellipse:
            return CurveSuprema{std::max(curve.a, curve.b), std::max(curve.a, curve.b), 0};
        case Kind::parabola:  // (t^2 / 4f, t)
            return CurveSuprema{std::hypot(far / (2 * curve.a), 1), 1 / (2 * curve.a), 0};
        case Kind::hyperbola:  // (a cosh t, b sinh t)
            return CurveSuprema{std::hypot(curve.a * std::sinh(far), curve.b * std::cosh(far)),
                                std::hypot(curve.a * std::cosh(far), curve.b * std::sinh(far)), 0};
        case Kind::spline: {
            const double low = curve.pieces.front().from, high = curve.pieces.back().to;
            if (curve.period > 0) {
                const double shift = curve.period * std::floor((from - low) / curve.period);
                from -= shift, to -= shift;
                if (to > high * (1 + 1e-15)) {
                    CurveSuprema all = suprema(curve.pieces, low, high);
                    all.jump += 2 * all.first;
                    return all;
                }
            }
            return suprema(curve.pieces, from, to);
        }
        case Kind::unknown:
            return std::nullopt;
    }
    return std::nullopt;
}

std::optional<double> chord_bound(const CurveShape& curve, double from, double to) {
    const double length = std::abs(to - from);
    const auto most = suprema(curve, from, to);
    if (!most) return std::nullopt;
    return most->second * length * length / 8 + most->jump * length / 4;
}

std::optional<SurfaceSuprema> suprema(const SurfaceShape& surface, const Vector2d& low, const Vector2d& high) {
    using Kind = SurfaceShape::Kind;
    SurfaceSuprema out;
    switch (surface.kind) {
        case Kind::torus:
            out.u = out.uu = largest_ring(surface.radius, surface.minor, low[1], high[1]);
            out.v = out.vv = surface.minor;
            out.uv = surface.minor * largest_cosine(low[1], high[1], 1);
            return out;
        case Kind::extrusion: {
            const auto most = suprema(surface.profile, low[0], high[0]);
            if (!most) return std::nullopt;
            out.u = most->first, out.v = 1, out.uu = most->second, out.jump_u = most->jump;
            return out;
        }
        case Kind::revolution: {
            const auto most = suprema(surface.profile, low[1], high[1]);
            if (!most || surface.profile_hull.empty()) return std::nullopt;
            for (const Vector3d& place : surface.profile_hull) out.u = std::max(out.u, from_axis(surface, place));
            out.uu = out.u, out.v = out.uv = most->first, out.vv = most->second, out.jump_v = most->jump;
            return out;
        }
        case Kind::spline:
            return suprema(surface.grid, low[0], high[0], low[1], high[1]);
        default:
            return std::nullopt;
    }
}

std::optional<double> triangle_bound(const SurfaceShape& surface, const std::array<Corner, 3>& corners) {
    if (surface.kind == SurfaceShape::Kind::plane) return surface.recognised_within;
    if (surface.is_radial()) return radial(surface, corners) + surface.recognised_within;
    const Vector2d low = corners[0].uv.cwiseMin(corners[1].uv).cwiseMin(corners[2].uv),
                   high = corners[0].uv.cwiseMax(corners[1].uv).cwiseMax(corners[2].uv), size = high - low;
    const auto most = suprema(surface, low, high);
    if (!most) return std::nullopt;
    return (most->uu * size[0] * size[0] + 2 * most->uv * size[0] * size[1] + most->vv * size[1] * size[1]) / 8 +
           (most->jump_u * size[0] + most->jump_v * size[1]) / 4;
}

}  // namespace fettle::core::step_importer
