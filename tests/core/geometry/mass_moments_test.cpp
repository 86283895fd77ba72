// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mass_moments.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "fettle/core/geometry/mesh_validity.hpp"
#include "fettle/tests/core/geometry/sample_meshes.hpp"

using namespace fettle;
using namespace fettle::core::geometry;

namespace {

Matrix4 diagonal_moments(double xx, double yy, double zz, double zeroth) { return Eigen::Vector4d(xx, yy, zz, zeroth).asDiagonal(); }

/// Largest relative error of the diagonal; off-diagonal entries must vanish against it.
double error_of(const Matrix4& moments, const Matrix4& expected) {
    double error = 0;
    for (int i = 0; i < 4; ++i) error = std::max(error, std::abs(moments(i, i) / expected(i, i) - 1));
    const Matrix4 difference = moments - expected;
    CHECK((difference - Matrix4(difference.diagonal().asDiagonal())).cwiseAbs().maxCoeff() <= 1e-12 * expected.diagonal().maxCoeff());
    return error;
}

template <class MeshOfSize, class MomentsOf>
void check_second_order(MeshOfSize mesh_of_size, MomentsOf moments_of, const Matrix4& limit) {
    double last = 0;
    for (const int n : {20, 40, 80, 160}) {
        const Mesh mesh = mesh_of_size(n);
        const double error = error_of(moments_of(mesh.vertices, mesh.triangles), limit);
        if (last != 0) CHECK(std::log2(last / error) == Approx(2).margin(0.05));
        last = error;
    }
    CHECK(last < 2e-3);
}

}  // namespace

TEST_CASE("solid moments of a box anywhere") {
    const Vector3 low(0.3, -1.2, 2), high(1.1, 0.7, 2.5);
    const Mesh box = tests::box_mesh(low, high);
    const Vector3 size = high - low, centre = (low + high) / 2;
    const double volume = size.prod();
    Matrix4 expected;
    expected.setZero();
    expected.topLeftCorner<3, 3>() = volume * (centre * centre.transpose());
    for (int i = 0; i < 3; ++i) expected(i, i) += volume * size(i) * size(i) / 12;
    expected.topRightCorner<3, 1>() = volume * centre;
    expected.bottomLeftCorner<1, 3>() = volume * centre.transpose();
    expected(3, 3) = volume;
    const Matrix4 moments = solid_moments(box.vertices, box.triangles);
    CHECK((moments - expected).cwiseAbs().maxCoeff() <= 1e-14 * expected.cwiseAbs().maxCoeff());
    CHECK(moments == moments.transpose());
    const Mesh turned = tests::inside_out(box);
    CHECK((solid_moments(turned.vertices, turned.triangles) + expected).cwiseAbs().maxCoeff() <= 1e-14 * expected.cwiseAbs().maxCoeff());
}

TEST_CASE("surface moments of a box about its centre") {
    const Vector3 half(0.5, 0.7, 1.1);
    const Mesh box = tests::box_mesh(-half, half);
    Matrix4 expected = Matrix4::Zero();
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        expected(3, 3) += 8 * half(j) * half(k);
        // Faces across i lie at distance half(i); the other four are uniform in i.
        expected(i, i) = 8 * half(j) * half(k) * half(i) * half(i) + 8 * half(i) * (half(j) + half(k)) * half(i) * half(i) / 3;
    }
    CHECK((surface_moments(box.vertices, box.triangles) - expected).cwiseAbs().maxCoeff() <= 1e-14 * expected.maxCoeff());
}

TEST_CASE("solid moments of an ellipsoid converge with order 2") {
    const Vector3 axes(1, 2, 0.5);
    const double volume = 4 * M_PI / 3 * axes.prod();
    check_second_order([&](int n) { return tests::ellipsoid_mesh(axes, n); }, solid_moments,
                       diagonal_moments(volume / 5, volume * 4 / 5, volume * 0.25 / 5, volume));
}

TEST_CASE("surface moments of a sphere converge with order 2") {
    const double r = 1.5, area = 4 * M_PI * r * r, second = area * r * r / 3;
    check_second_order(
        [&](int n) {
            return tests::ellipsoid_mesh({r, r, r}, n);
        },
        surface_moments, diagonal_moments(second, second, second, area));
}

TEST_CASE("solid and surface moments of a torus converge with order 2") {
    const double major = 2, minor = 0.6, volume = 2 * M_PI * M_PI * major * minor * minor;
    const double across = volume * (major * major / 2 + 3 * minor * minor / 8);
    const auto mesh_of_size = [&](int n) { return tests::torus_mesh(major, minor, n); };
    check_second_order(mesh_of_size, solid_moments, diagonal_moments(across, across, volume * minor * minor / 4, volume));
    const double area = 4 * M_PI * M_PI * major * minor;
    // int (major + minor cos v)^3 and int minor^2 sin^2 v (major + minor cos v) over the tube.
    const double across_surface = area * (major * major / 2 + 3 * minor * minor / 4), along_surface = area * minor * minor / 2;
    check_second_order(mesh_of_size, surface_moments, diagonal_moments(across_surface, across_surface, along_surface, area));
}

TEST_CASE("solid moments agree with Monte Carlo") {
    std::mt19937_64 random(1);
    Mesh mesh = tests::torus_mesh(1, 0.4, 7);
    mesh.vertices += 0.05 * tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
    const Vector3 low = mesh.vertices.rowwise().minCoeff(), high = mesh.vertices.rowwise().maxCoeff();
    const double box_volume = (high - low).prod();
    const int count = 40000;
    Matrix4 sum = Matrix4::Zero(), sum_of_squares = Matrix4::Zero();
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < count; ++i) {
        const Vector3 x = low + Vector3(uniform(random), uniform(random), uniform(random)).cwiseProduct(high - low);
        if (!point_in_solid(x, mesh.vertices, mesh.triangles)) continue;
        const Matrix4 sample = box_volume * x.homogeneous() * x.homogeneous().transpose();
        sum += sample;
        sum_of_squares += sample.cwiseProduct(sample);
    }
    const Matrix4 mean = sum / count;
    const Matrix4 deviation = ((sum_of_squares / count - mean.cwiseProduct(mean)) / count).cwiseSqrt();
    const Matrix4 moments = solid_moments(mesh.vertices, mesh.triangles);
    CHECK(((moments - mean).cwiseQuotient(deviation)).cwiseAbs().maxCoeff() < 4);  // ten independent entries, 4 sigma
    CHECK(deviation(3, 3) < 0.01 * moments(3, 3));
}

TEST_CASE("moments about another origin") {
    std::mt19937_64 random(2);
    Mesh mesh = tests::torus_mesh(1, 0.4, 9);
    mesh.vertices += 0.05 * tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
    const Vector3 shift(0.3, -2, 1.5);
    const Matrix3X moved = mesh.vertices.colwise() - shift;
    for (const auto moments_of : {solid_moments, surface_moments}) {
        const Matrix4 expected = moments_of(moved, mesh.triangles);
        const Matrix4 shifted = shifted_moments(moments_of(mesh.vertices, mesh.triangles), shift);
        CHECK((shifted - expected).cwiseAbs().maxCoeff() <= 1e-13 * expected.cwiseAbs().maxCoeff());
    }
}
