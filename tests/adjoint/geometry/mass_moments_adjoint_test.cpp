// SPDX-License-Identifier: MIT
#include "adjoint/geometry/mass_moments_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::adjoint::geometry::mass_moments_adjoint_test {

namespace {

struct Case {
    const char* name;
    decltype(&core::geometry::solid_moments) moments;
    decltype(&solid_moments_tangent) tangent;
    decltype(&solid_moments_adjoint) adjoint;
};

const Case cases[] = {{"solid", core::geometry::solid_moments, solid_moments_tangent, solid_moments_adjoint},
                      {"surface", core::geometry::surface_moments, surface_moments_tangent, surface_moments_adjoint}};

core::geometry::Mesh rough_torus(std::mt19937_64& random) {
    core::geometry::Mesh mesh = tests::torus_mesh(1, 0.4, 6);
    mesh.vertices += 0.1 * tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
    return mesh;
}

Matrix4 random_bar(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    return Matrix4::NullaryExpr([&] { return uniform(random); });
}

}  // namespace

TEST_CASE("tangent of the moments against central differences, and the Taylor remainder's slope") {
    std::mt19937_64 random(3);
    const auto mesh = rough_torus(random);
    const Matrix3X direction = tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
    for (const Case& c : cases) {
        INFO(c.name);
        const Matrix4 exact = c.tangent(mesh.vertices, mesh.triangles, direction);
        CHECK(exact == exact.transpose());
        double best = 1;
        for (const double step : {1e-3, 1e-4, 1e-5, 1e-6}) {
            const Matrix4 difference = (c.moments(mesh.vertices + step * direction, mesh.triangles) -
                                        c.moments(mesh.vertices - step * direction, mesh.triangles)) /
                                       (2 * step);
            best = std::min(best, (difference - exact).norm() / exact.norm());
        }
        CHECK(best < 1e-9);
        const auto remainder = [&](double step) {
            return (c.moments(mesh.vertices + step * direction, mesh.triangles) - c.moments(mesh.vertices, mesh.triangles) - step * exact)
                .norm();
        };
        CHECK(std::log10(remainder(1e-2) / remainder(1e-3)) == Approx(2).margin(0.1));
        CHECK(std::log10(remainder(1e-3) / remainder(1e-4)) == Approx(2).margin(0.02));
    }
}

TEST_CASE("adjoint and tangent of the moments are transposes") {
    std::mt19937_64 random(4);
    const auto mesh = rough_torus(random);
    const int n = static_cast<int>(mesh.vertices.cols());
    for (const Case& c : cases) {
        INFO(c.name);
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix4 bar = random_bar(random);  // not symmetric
            const Matrix3X direction = tests::random_matrix(n, random);
            Matrix3X vertices_bar = Matrix3X::Zero(3, n);
            c.adjoint(mesh.vertices, mesh.triangles, bar, vertices_bar);
            const double forward = bar.cwiseProduct(c.tangent(mesh.vertices, mesh.triangles, direction)).sum();
            const double reverse = vertices_bar.cwiseProduct(direction).sum();
            CHECK(std::abs(forward - reverse) <= 1e-13 * vertices_bar.norm() * direction.norm());
        }
    }
}

TEST_CASE("every component of the moments' gradient, one bar at a time, against central differences") {
    std::mt19937_64 random(5);
    const auto mesh = tests::box_mesh({-0.4, -0.5, -0.3}, {0.6, 0.7, 0.8});
    Matrix3X x = mesh.vertices + 0.05 * tests::random_matrix(8, random);
    const double step = 1e-5;
    for (const Case& c : cases) {
        for (int entry = 0; entry < 16; ++entry) {
            INFO(c.name << " entry " << entry);
            Matrix4 bar = Matrix4::Zero();
            bar(entry / 4, entry % 4) = 1;
            Matrix3X gradient = Matrix3X::Zero(3, 8), difference(3, 8);
            c.adjoint(x, mesh.triangles, bar, gradient);
            for (int i = 0; i < 24; ++i) {
                Matrix3X plus = x, minus = x;
                plus(i % 3, i / 3) += step;
                minus(i % 3, i / 3) -= step;
                difference(i % 3, i / 3) =
                    bar.cwiseProduct(c.moments(plus, mesh.triangles) - c.moments(minus, mesh.triangles)).sum() / (2 * step);
            }
            CHECK((gradient - difference).norm() <= 1e-8 * gradient.norm());
        }
    }
}

TEST_CASE("volume: moving a closed mesh as a whole changes nothing, scaling it triples") {
    std::mt19937_64 random(6);
    const auto mesh = rough_torus(random);
    Matrix4 bar = Matrix4::Zero();
    bar(3, 3) = 1;
    Matrix3X gradient = Matrix3X::Zero(3, mesh.vertices.cols());
    solid_moments_adjoint(mesh.vertices, mesh.triangles, bar, gradient);
    CHECK(gradient.rowwise().sum().norm() < 1e-14 * gradient.norm() * std::sqrt(gradient.size()));
    CHECK(gradient.cwiseProduct(mesh.vertices).sum() ==
          Approx(3 * core::geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3)).epsilon(1e-13));
}

TEST_CASE("the adjoint adds, and a triangle without area contributes nothing") {
    std::mt19937_64 random(7);
    const auto mesh = rough_torus(random);
    const Matrix4 bar = random_bar(random);
    Matrix3X once = Matrix3X::Zero(3, mesh.vertices.cols()), twice = once;
    surface_moments_adjoint(mesh.vertices, mesh.triangles, bar, once);
    surface_moments_adjoint(mesh.vertices, mesh.triangles, bar, twice);
    surface_moments_adjoint(mesh.vertices, mesh.triangles, bar, twice);
    CHECK((twice - 2 * once).norm() <= 1e-14 * once.norm());
    Matrix3X flat(3, 3), flat_bar = Matrix3X::Zero(3, 3);
    flat << 0, 1, 2, 0, 0, 0, 0, 0, 0;
    surface_moments_adjoint(flat, {{0, 1, 2}}, bar, flat_bar);
    CHECK(flat_bar.isZero(0));
}

TEST_CASE("adjoint of the shift") {
    std::mt19937_64 random(8);
    const Vector3 shift(1, -2, 0.5);
    const Matrix4 bar = random_bar(random), dot = random_bar(random);
    CHECK(bar.cwiseProduct(core::geometry::shifted_moments(dot, shift)).sum() ==
          Approx(shifted_moments_adjoint(bar, shift).cwiseProduct(dot).sum()).epsilon(1e-13));
}

}  // namespace fettle::adjoint::geometry::mass_moments_adjoint_test
