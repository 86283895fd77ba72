// SPDX-License-Identifier: MIT
// Bounds of how far facets are from surfaces, against dense samples of the surfaces; Open CASCADE is not asked.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/step_importer/surface_bound.hpp"

namespace fettle::core::step_importer::surface_bound_test {

namespace {

using Kind = SurfaceShape::Kind;

double bernstein(int degree, int i, double t) {
    double out = 1;
    for (int k = 0; k < i; ++k) out *= static_cast<double>(degree - k) / (k + 1) * t;
    return out * std::pow(1 - t, degree - i);
}

Vector3d at(const BezierPatch& patch, double u, double v) {
    const double s = (u - patch.u0) / (patch.u1 - patch.u0), t = (v - patch.v0) / (patch.v1 - patch.v0);
    Pole sum = Pole::Zero();
    for (int i = 0; i <= patch.u_degree; ++i)
        for (int j = 0; j <= patch.v_degree; ++j)
            sum += bernstein(patch.u_degree, i, s) * bernstein(patch.v_degree, j, t) *
                   patch.poles[static_cast<std::size_t>(i * (patch.v_degree + 1) + j)];
    return sum.head<3>() / sum[3];
}

struct Random {
    std::mt19937_64 engine{11};
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
};

BezierPatch random_patch(Random& random, double u0, double u1, bool rational) {
    BezierPatch patch{3, 2, {}, u0, u1, -1, 1.5};
    for (int i = 0; i <= 3; ++i) {
        for (int j = 0; j <= 2; ++j) {
            const double weight = rational ? random(0.4, 2) : 1;
            Pole pole;
            pole << weight * Vector3d(i + random(-0.4, 0.4), 2 * j + random(-0.4, 0.4), random(-1, 1)), weight;
            patch.poles.push_back(pole);
        }
    }
    return patch;
}

/// The largest distance of the surface's points from the linear interpolation over a triangle of parameters.
template <class Surface>
double farthest(const Surface& surface, const std::array<Vector2d, 3>& uv) {
    constexpr int count = 40;
    const Vector3d a = surface(uv[0]), b = surface(uv[1]), c = surface(uv[2]);
    double most = 0;
    for (int i = 0; i <= count; ++i) {
        for (int j = 0; i + j <= count; ++j) {
            const double s = static_cast<double>(i) / count, t = static_cast<double>(j) / count, r = 1 - s - t;
            const Vector3d place = surface(Vector2d(r * uv[0] + s * uv[1] + t * uv[2]));
            most = std::max(most, (place - (r * a + s * b + t * c)).norm());
        }
    }
    return most;
}

std::array<Corner, 3> corners_of(const std::array<Vector2d, 3>& uv, const auto& surface) {
    return {Corner{surface(uv[0]), uv[0]}, Corner{surface(uv[1]), uv[1]}, Corner{surface(uv[2]), uv[2]}};
}

/// Half a cylinder of radius 5 along x, as a rational cubic, from x = 0 to 3.
SurfaceShape half_cylinder(double stretch = 1) {
    SurfaceShape shape;
    shape.kind = Kind::spline;
    BezierPatch patch{1, 3, {}, 0, 3, 0, 30};
    for (const double x : {0.0, 3.0})
        for (const auto& [y, z, w] : {std::tuple{0.0, 5.0, 1.0}, {10.0, 5.0, 1 / 3.0}, {10.0, -5.0, 1 / 3.0}, {0.0, -5.0, 1.0}})
            patch.poles.push_back(Pole(w * x, w * y * stretch, w * z, w));
    shape.grid = {{patch}, 1, 0, 0};
    return shape;
}

void recognise_by_samples(SurfaceShape& shape, double tolerance) {
    const BezierPatch patch = shape.grid.pieces.front();
    std::vector<Vector3d> places, normals;
    for (double u = 0.3; u < 3; u += 0.8) {
        for (double v = 2; v < 30; v += 7) {
            constexpr double h = 1e-4;
            places.push_back(at(patch, u, v));
            const Vector3d du = at(patch, u + h, v) - at(patch, u - h, v), dv = at(patch, u, v + h) - at(patch, u, v - h);
            normals.push_back(du.cross(dv).normalized());
        }
    }
    recognise(shape, places, normals, tolerance);
}

}  // namespace

TEST_CASE("surface bound: triangles of splines lie within what control nets say") {
    Random random;
    for (int round = 0; round < 200; ++round) {
        SurfaceShape shape;
        shape.kind = Kind::spline;
        const BezierPatch patch = random_patch(random, 2, 5, round % 2 == 1);
        shape.grid = {{patch}, 1, 0, 0};
        const auto surface = [&](const Vector2d& uv) { return at(patch, uv[0], uv[1]); };
        const double size = random(0.01, 1);
        const Vector2d middle(random(3, 4), random(-0.5, 1));
        const auto corner = [&] { return Vector2d(middle + size * Vector2d(random(-0.9, 0.9), random(-0.45, 0.45))); };
        const std::array<Vector2d, 3> uv{corner(), corner(), corner()};
        const auto bound = triangle_bound(shape, corners_of(uv, surface));
        REQUIRE(bound);
        const double found = farthest(surface, uv);
        CHECK(found <= *bound);
        if (round % 2 == 0 && size < 0.1) CHECK(*bound <= 12 * found + 1e-9);
    }
}

TEST_CASE("surface bound: a crease between pieces counts, a smooth joint does not") {
    Random random;
    for (int round = 0; round < 40; ++round) {
        const BezierPatch first = random_patch(random, 0, 1, false);
        BezierPatch second = random_patch(random, 1, 2, false);
        const bool is_smooth = round % 2 == 0;
        for (std::size_t j = 0; j < 3; ++j) {
            second.poles[j] = first.poles[9 + j];
            if (is_smooth) second.poles[3 + j] = 2 * first.poles[9 + j] - first.poles[6 + j];
        }
        SurfaceShape shape;
        shape.kind = Kind::spline;
        shape.grid = {{first, second}, 1, 0, 0};
        const auto surface = [&](const Vector2d& uv) { return uv[0] < 1 ? at(first, uv[0], uv[1]) : at(second, uv[0], uv[1]); };
        const std::array<Vector2d, 3> uv{Vector2d(0.95, 0), Vector2d(1.05, 0.1), Vector2d(0.98, 0.2)};
        const auto most = suprema(shape, {0.95, 0}, {1.05, 0.2});
        REQUIRE(most);
        CHECK((most->jump_u < 1e-9) == is_smooth);
        CHECK(farthest(surface, uv) <= *triangle_bound(shape, corners_of(uv, surface)));
    }
}

TEST_CASE("surface bound: cylinder, cone and torus in closed form") {
    Random random;
    for (int round = 0; round < 200; ++round) {
        SurfaceShape cylinder, cone, torus;
        cylinder.kind = Kind::cylinder, cylinder.radius = 5;
        cone.kind = Kind::cone;
        torus.kind = Kind::torus, torus.radius = 12, torus.minor = 3;
        const auto round_at = [](double radius, double u, double z) { return Vector3d(radius * std::cos(u), radius * std::sin(u), z); };
        const double width = random(0.01, 1);
        std::array<Vector2d, 3> uv;
        for (Vector2d& each : uv) each = {2 + width * random(0, 1), random(0, 6)};
        const auto on_cylinder = [&](const Vector2d& p) { return round_at(5, p[0], p[1]); };
        const auto on_cone = [&](const Vector2d& p) { return round_at(1 + 0.5 * p[1], p[0], p[1]); };
        const auto on_torus = [&](const Vector2d& p) { return round_at(12 + 3 * std::cos(p[1]), p[0], 3 * std::sin(p[1])); };
        // By rays: how far inside the facet's points are.
        for (int i = 0; i <= 20; ++i) {
            for (int j = 0; i + j <= 20; ++j) {
                const double s = i / 20.0, t = j / 20.0, r = 1 - s - t;
                const auto within = [&](const auto& surface) {
                    return Vector3d(r * surface(uv[0]) + s * surface(uv[1]) + t * surface(uv[2]));
                };
                const Vector3d p = within(on_cylinder), q = within(on_cone);
                const double rounding = 1e-12;
                const double inside = 5 - p.head<2>().norm(), inside_cone = 1 + 0.5 * q[2] - q.head<2>().norm();
                CHECK(inside >= -rounding);
                CHECK(inside <= *triangle_bound(cylinder, corners_of(uv, on_cylinder)) + rounding);
                CHECK(inside_cone >= -rounding);
                CHECK(inside_cone <= *triangle_bound(cone, corners_of(uv, on_cone)) + rounding);
            }
        }
        for (Vector2d& each : uv) each[1] = 1 + width * each[1] / 6;
        CHECK(farthest(on_torus, uv) <= *triangle_bound(torus, corners_of(uv, on_torus)));
    }
}

TEST_CASE("surface bound: a facet that spans more than a half turn has no good bound") {
    SurfaceShape cylinder;
    cylinder.kind = Kind::cylinder, cylinder.radius = 5;
    const std::array<Vector2d, 3> uv{Vector2d(0, 0), Vector2d(2 * M_PI, 0), Vector2d(3, 1)};
    const auto on_cylinder = [](const Vector2d& p) { return Vector3d(5 * std::cos(p[0]), 5 * std::sin(p[0]), p[1]); };
    CHECK(*triangle_bound(cylinder, corners_of(uv, on_cylinder)) >= 5);
}

TEST_CASE("surface bound: a curve's chord") {
    Random random;
    for (int round = 0; round < 100; ++round) {
        BezierCurve piece;
        piece.from = 1, piece.to = 4;
        for (int i = 0; i <= 4; ++i) {
            const double weight = random(0.5, 2);
            Pole pole;
            pole << weight * Vector3d(i, random(-1, 1), random(-1, 1)), weight;
            piece.poles.push_back(pole);
        }
        CurveShape curve;
        curve.kind = CurveShape::Kind::spline;
        curve.pieces = {piece};
        const auto place = [&](double t) {
            Pole sum = Pole::Zero();
            for (int i = 0; i <= 4; ++i) sum += bernstein(4, i, (t - 1) / 3) * piece.poles[static_cast<std::size_t>(i)];
            return Vector3d(sum.head<3>() / sum[3]);
        };
        const double from = random(1, 2.4), to = from + random(0.01, 1.5);
        const auto bound = chord_bound(curve, from, to);
        REQUIRE(bound);
        for (int k = 0; k <= 50; ++k) {
            const double s = k / 50.0;
            CHECK((place(from + s * (to - from)) - ((1 - s) * place(from) + s * place(to))).norm() <= *bound + 1e-12);
        }
    }
}

TEST_CASE("surface bound: a spline that is a cylinder is taken for one, with the proof; an ellipse's is not") {
    SurfaceShape shape = half_cylinder();
    recognise_by_samples(shape, 1e-6);
    REQUIRE(shape.kind == Kind::cylinder);
    CHECK(shape.is_recognised);
    CHECK(shape.radius == Approx(5).epsilon(1e-7));
    CHECK(std::abs(shape.axis[0]) == Approx(1));
    CHECK(shape.recognised_within <= 1e-6);
    SurfaceShape elliptic = half_cylinder(1.001);
    recognise_by_samples(elliptic, 1e-6);
    CHECK(elliptic.kind == Kind::spline);
    // With a tolerance that allows it, what it allows is told, and holds.
    recognise_by_samples(elliptic, 0.1);
    REQUIRE(elliptic.kind == Kind::cylinder);
    for (double v = 0; v <= 30; v += 0.1) {
        const Vector3d place = at(elliptic.grid.pieces.front(), 1.3, v), arm = place - elliptic.point;
        const double distance = (arm - arm.dot(elliptic.axis) * elliptic.axis).norm();
        CHECK(std::abs(distance - elliptic.radius) <= elliptic.recognised_within);
    }
}

}  // namespace fettle::core::step_importer::surface_bound_test
