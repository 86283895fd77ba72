// SPDX-License-Identifier: MIT
// Distances against formulas of another kind, derivatives against differences, fits against what points were made of.
#include "core/features/surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/features/fit_surface.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::core::features::surface_test {

namespace {

const std::vector<SurfaceKind> kinds{SurfaceKind::plane, SurfaceKind::cylinder, SurfaceKind::cone, SurfaceKind::sphere, SurfaceKind::torus};

Surface some_surface(SurfaceKind kind) {
    Surface out;
    out.kind = kind;
    out.point = Vector3(0.3, -0.2, 0.5);
    out.axis = Vector3(0.4, -0.3, 0.8).normalized();
    out.radius = kind == SurfaceKind::plane ? 0 : 0.7;
    out.slope = kind == SurfaceKind::cone ? 0.35 : kind == SurfaceKind::torus ? 0.2 : 0;
    return out;
}

// A point of the surface by two angles or lengths, `off` outside of it.
Vector3 point_on(const Surface& s, double a, double b, double off) {
    const auto [u, v] = across_of(s.axis);
    const Vector3 outward = std::cos(a) * u + std::sin(a) * v;
    switch (s.kind) {
        case SurfaceKind::plane:
            return s.point + a * u + b * v + off * s.axis;
        case SurfaceKind::cylinder:
            return s.point + (s.radius + off) * outward + b * s.axis;
        case SurfaceKind::cone: {
            const Vector3 normal = (outward - s.slope * s.axis).normalized();
            return s.point + (s.radius + s.slope * b) * outward + b * s.axis + off * normal;
        }
        case SurfaceKind::sphere:
            return s.point + (s.radius + off) * (std::cos(b) * outward + std::sin(b) * s.axis);
        default:
            return s.point + s.radius * outward + (s.slope + off) * (std::cos(b) * outward + std::sin(b) * s.axis);
    }
}

}  // namespace

TEST_CASE("a point beside a surface is as far from it as it was put, along the normal") {
    for (const SurfaceKind kind : kinds) {
        const Surface surface = some_surface(kind);
        for (const double a : {-2.0, 0.3, 1.1, 2.9})
            for (const double b : {-0.6, 0.0, 0.8})
                for (const double off : {-0.05, 0.0, 0.07}) {
                    const Vector3 x = point_on(surface, a, b, off);
                    CHECK(signed_distance(surface, x) == Approx(off).margin(1e-14));
                    CHECK(signed_distance(surface, x + 1e-3 * normal_at(surface, x)) == Approx(off + 1e-3).margin(1e-13));
                }
    }
}

TEST_CASE("derivatives of distances in the surface's own numbers agree with differences") {
    for (const SurfaceKind kind : kinds) {
        const Surface surface = some_surface(kind);
        std::vector<Vector3> points;
        for (const double a : {-2.0, 0.3, 1.1})
            for (const double b : {-0.6, 0.4}) points.push_back(point_on(surface, a, b, 0.03 * a));
        MatrixX jacobian(points.size(), parameter_count(kind));
        for (std::size_t k = 0; k < points.size(); ++k)
            jacobian.row(static_cast<Eigen::Index>(k)) = distance_gradient(surface, points[k]).transpose();
        const auto distances = [&](const VectorX& step) -> VectorX {
            VectorX out(points.size());
            for (std::size_t k = 0; k < points.size(); ++k)
                out[static_cast<Eigen::Index>(k)] = signed_distance(moved(surface, SurfaceStep(step)), points[k]);
            return out;
        };
        const auto check = tests::support::check_jacobian(distances, VectorX::Zero(parameter_count(kind)), jacobian);
        INFO(parts::name_of(kind) << ", number " << check.column);
        CHECK(check.relative_error < 1e-7);
    }
}

TEST_CASE("points of a surface give it back, from a start that is off") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(-1.5, 1.5), height(-0.8, 0.8), small(-0.02, 0.02);
    for (const SurfaceKind kind : kinds) {
        const Surface surface = some_surface(kind);
        std::vector<Vector3> points;
        for (int k = 0; k < 60; ++k) points.push_back(point_on(surface, angle(random), height(random), 0));
        SurfaceStep by(parameter_count(kind));
        for (double& each : by) each = small(random);
        const auto fitted = fitted_surface(moved(surface, by), points);
        REQUIRE(fitted);
        INFO(parts::name_of(kind));
        double largest = 0;
        for (int k = 0; k < 60; ++k)
            largest = std::max(largest, std::abs(signed_distance(*fitted, point_on(surface, angle(random), height(random), 0))));
        CHECK(largest < 1e-9);
    }
    CHECK_FALSE(fitted_surface(some_surface(SurfaceKind::torus), {Vector3::Zero(), Vector3::UnitX()}));
}

TEST_CASE("normals give a start that is near") {
    for (const SurfaceKind kind : kinds) {
        const Surface surface = some_surface(kind);
        SurfaceSamples samples;
        for (const double a : {-0.6, -0.3, 0.0, 0.3, 0.6})
            for (const double b : {-0.4, 0.0, 0.4}) {
                const Vector3 x = point_on(surface, a, b, 0);
                samples.points.push_back(x);
                samples.centres.push_back(x);
                samples.normals.push_back(normal_at(surface, x));
                samples.weights.push_back(1);
            }
        const auto near = near_surface(kind, samples);
        REQUIRE(near);
        INFO(parts::name_of(kind));
        for (const Vector3& x : samples.points) CHECK(std::abs(signed_distance(*near, x)) < 1e-9);
    }
}

}  // namespace fettle::core::features::surface_test
