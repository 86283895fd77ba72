// SPDX-License-Identifier: MIT
#include "core/features/surface.hpp"

#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::core::features {

namespace {

// Where a point is about the surface's line.
struct Polar {
    Vector3 outward = Vector3::Zero();  // unit; zero on the line
    double rho = 0, z = 0;
};

Polar polar_of(const Surface& surface, const Vector3& x) {
    Polar out;
    const Vector3 d = x - surface.point;
    out.z = surface.axis.dot(d);
    const Vector3 across = d - out.z * surface.axis;
    out.rho = across.norm();
    if (out.rho > 0) out.outward = across / out.rho;
    return out;
}

// The distance's derivatives in rho and z.
struct Meridian {
    double rho = 0, z = 0;
};

Meridian meridian_of(const Surface& surface, const Polar& at) {
    switch (surface.kind) {
        case SurfaceKind::cylinder:
            return {1, 0};
        case SurfaceKind::cone: {
            const double length = std::sqrt(1 + surface.slope * surface.slope);
            return {1 / length, -surface.slope / length};
        }
        case SurfaceKind::sphere:
        case SurfaceKind::torus: {
            const double from = surface.kind == SurfaceKind::torus ? at.rho - surface.radius : at.rho,
                         length = std::sqrt(from * from + at.z * at.z);
            return length > 0 ? Meridian{from / length, at.z / length} : Meridian{};
        }
        default:
            return {0, 1};
    }
}

}  // namespace

double signed_distance(const Surface& surface, const Vector3& x) {
    if (surface.kind == SurfaceKind::plane) return surface.axis.dot(x - surface.point);
    if (surface.kind == SurfaceKind::sphere) return (x - surface.point).norm() - surface.radius;
    const Polar at = polar_of(surface, x);
    if (surface.kind == SurfaceKind::cylinder) return at.rho - surface.radius;
    if (surface.kind == SurfaceKind::cone)
        return (at.rho - surface.radius - surface.slope * at.z) / std::sqrt(1 + surface.slope * surface.slope);
    FETTLE_ASSERT(surface.kind == SurfaceKind::torus, "a surface that features have");
    const double from = at.rho - surface.radius;
    return std::sqrt(from * from + at.z * at.z) - surface.slope;
}

Vector3 normal_at(const Surface& surface, const Vector3& x) {
    if (surface.kind == SurfaceKind::plane) return surface.axis;
    const Polar at = polar_of(surface, x);
    const Meridian meridian = meridian_of(surface, at);
    return meridian.rho * at.outward + meridian.z * surface.axis;
}

int parameter_count(SurfaceKind kind) {
    switch (kind) {
        case SurfaceKind::plane:
            return 3;
        case SurfaceKind::cylinder:
            return 5;
        case SurfaceKind::cone:
            return 6;
        case SurfaceKind::sphere:
            return 4;
        default:
            return 7;
    }
}

Across across_of(const Vector3& axis) {
    const Vector3 u = axis.unitOrthogonal();
    return {u, axis.cross(u)};
}

SurfaceStep distance_gradient(const Surface& surface, const Vector3& x) {
    SurfaceStep out(parameter_count(surface.kind));
    if (surface.kind == SurfaceKind::sphere) {
        out << -normal_at(surface, x), -1;
        return out;
    }
    const auto [u, v] = across_of(surface.axis);
    const Polar at = polar_of(surface, x);
    const double eu = at.outward.dot(u), ev = at.outward.dot(v);
    if (surface.kind == SurfaceKind::plane) {
        out << at.rho * eu, at.rho * ev, -1;
        return out;
    }
    // The axis leans by t towards u: z grows by rho eu t, rho falls by z eu t.
    const Meridian m = meridian_of(surface, at);
    const double turn = m.z * at.rho - m.rho * at.z;
    if (surface.kind == SurfaceKind::torus) {
        out << -m.rho * eu, -m.rho * ev, -m.z, turn * eu, turn * ev, -m.rho, -1;
    } else if (surface.kind == SurfaceKind::cylinder) {
        out << -eu, -ev, turn * eu, turn * ev, -1;
    } else {
        const double square = 1 + surface.slope * surface.slope, length = std::sqrt(square);
        const double over = at.rho - surface.radius - surface.slope * at.z;
        out << -m.rho * eu, -m.rho * ev, turn * eu, turn * ev, -1 / length, -at.z / length - over * surface.slope / (square * length);
    }
    return out;
}

Surface moved(const Surface& surface, const SurfaceStep& step) {
    Surface out = surface;
    const Across across = across_of(surface.axis);
    const Vector3 &u = across.u, &v = across.v;
    const auto lean = [&](double to_u, double to_v) { out.axis = (surface.axis + to_u * u + to_v * v).normalized(); };
    switch (surface.kind) {
        case SurfaceKind::plane:
            lean(step[0], step[1]);
            out.point += step[2] * surface.axis;
            break;
        case SurfaceKind::sphere:
            out.point += step.head<3>();
            out.radius += step[3];
            break;
        case SurfaceKind::torus:
            out.point += step[0] * u + step[1] * v + step[2] * surface.axis;
            lean(step[3], step[4]);
            out.radius += step[5];
            out.slope += step[6];
            break;
        default:
            out.point += step[0] * u + step[1] * v;
            lean(step[2], step[3]);
            out.radius += step[4];
            if (surface.kind == SurfaceKind::cone) out.slope += step[5];
    }
    return out;
}

}  // namespace fettle::core::features
