// SPDX-License-Identifier: MIT
#include "core/geometry/mass_moments.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "core/solids/mesh_validity.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::mass_moments_test {

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
        if (!solids::point_in_solid(x, mesh.vertices, mesh.triangles)) continue;
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

TEST_CASE("line and point moments in closed form") {
    // A circle of radius r about z through c, as a polygon: second order in its side.
    const double r = 0.7;
    double last = 0;
    for (const int n : {20, 40, 80, 160}) {
        Matrix3X v(3, n);
        std::vector<Edge> edges;
        for (int i = 0; i < n; ++i) {
            v.col(i) << r * std::cos(2 * M_PI * i / n), r * std::sin(2 * M_PI * i / n), 0;
            edges.push_back({i, (i + 1) % n});
        }
        const double length = 2 * M_PI * r, across = length * r * r / 2;
        const Matrix4 moments = line_moments(v, edges);
        CHECK(moments(2, 2) == 0);
        CHECK(moments.col(3).head<3>().norm() < 1e-14);
        const double error = std::max(std::abs(moments(0, 0) / across - 1), std::abs(moments(3, 3) / length - 1));
        if (last != 0) CHECK(std::log2(last / error) == Approx(2).margin(0.05));
        last = error;
    }
    CHECK(last < 2e-3);
    // One segment, anywhere, and cut in three: exact, not lumped.
    const Vector3 a(1, 2, 3), b(4, 2, 7);  // length 5
    Matrix3X ends(3, 4);
    ends << a, a + (b - a) / 4, a + (b - a) / 2, b;
    const Matrix4 whole = line_moments(ends, {{0, 3}}), parts = line_moments(ends, {{0, 1}, {1, 2}, {2, 3}});
    CHECK((whole - parts).norm() <= 1e-14 * whole.norm());
    CHECK(whole(3, 3) == Approx(5));
    CHECK(whole(0, 0) == Approx(5 * (1 + 4 + 16) / 3.0));       // int x^2 from 1 to 4, scaled
    CHECK(whole(0, 2) == Approx(5 * (3 + (4 + 9) / 2.0 + 4)));  // int (1 + 3 s)(3 + 4 s)
    const Matrix4 points = point_moments(ends);
    Matrix4 expected = Matrix4::Zero();
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector4d x = ends.col(i).homogeneous();
        expected += x * x.transpose();
    }
    CHECK((points - expected).norm() <= 1e-14 * expected.norm());
}

TEST_CASE("line moments agree with Monte Carlo") {
    std::mt19937_64 random(3);
    const Matrix3X vertices = tests::random_matrix(6, random);
    const std::vector<Edge> edges{{0, 1}, {1, 2}, {3, 4}, {4, 0}, {2, 5}};
    std::vector<double> lengths;
    for (const Edge& e : edges) lengths.push_back((vertices.col(e[1]) - vertices.col(e[0])).norm());
    std::discrete_distribution<std::size_t> choice(lengths.begin(), lengths.end());
    std::uniform_real_distribution<double> uniform(0, 1);
    const Matrix4 moments = line_moments(vertices, edges);
    Matrix4 sum = Matrix4::Zero(), sum_of_squares = Matrix4::Zero();
    const int count = 40000;
    for (int i = 0; i < count; ++i) {
        const Edge& e = edges[choice(random)];
        const double s = uniform(random);
        const Eigen::Vector4d x = ((1 - s) * vertices.col(e[0]) + s * vertices.col(e[1])).homogeneous();
        const Matrix4 sample = moments(3, 3) * x * x.transpose();
        sum += sample;
        sum_of_squares += sample.cwiseProduct(sample);
    }
    const Matrix4 mean = sum / count;
    const Matrix4 deviation = ((sum_of_squares / count - mean.cwiseProduct(mean)) / count).cwiseMax(0).cwiseSqrt();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4 - (i == 3); ++j) CHECK(std::abs(moments(i, j) - mean(i, j)) < 4 * deviation(i, j));
    }
    CHECK(deviation(0, 0) < 0.02 * moments(0, 0));
}

TEST_CASE("openings, and solids with these capped") {
    const Vector3 low(0.3, -1.2, 2), high(1.1, 0.7, 2.5);
    const Mesh box = tests::box_mesh(low, high);
    CHECK(openings(box.vertices, box.triangles).empty());
    CHECK(is_nearly_closed(box.vertices, box.triangles));
    const Matrix4 closed = solid_moments(box.vertices, box.triangles);
    CHECK(capped_solid_moments(box.vertices, box.triangles) == closed);

    SECTION("without its bottom: one opening, capped exactly, but too wide") {
        const std::vector<Triangle> lidless(box.triangles.begin() + 2, box.triangles.end());
        const auto found = openings(box.vertices, lidless);
        REQUIRE(found.size() == 1);
        CHECK(found[0].edges.size() == 4);
        CHECK((found[0].area.cwiseAbs() - Vector3(0, 0, 0.8 * 1.9)).norm() < 1e-15);
        CHECK((found[0].centre - Vector3(0.7, -0.25, 2)).norm() < 1e-15);
        CHECK((capped_solid_moments(box.vertices, lidless) - closed).norm() <= 1e-14 * closed.norm());
        CHECK_FALSE(is_nearly_closed(box.vertices, lidless));
    }
    SECTION("without bottom and top, where the openings' areas cancel: two openings") {
        const std::vector<Triangle> tube(box.triangles.begin() + 4, box.triangles.end());
        const auto found = openings(box.vertices, tube);
        REQUIRE(found.size() == 2);
        CHECK((found[0].area + found[1].area).norm() < 1e-15);
        CHECK((capped_solid_moments(box.vertices, tube) - closed).norm() <= 1e-14 * closed.norm());
        CHECK_FALSE(is_nearly_closed(box.vertices, tube));
    }
    SECTION("a crack: a T-junction encloses nothing") {
        Mesh cracked = box;  // the edge 0-2 of one triangle gets a vertex in its middle, which its neighbour does not know
        cracked.vertices.conservativeResize(3, 9);
        cracked.vertices.col(8) = 0.5 * (box.vertices.col(0) + box.vertices.col(2));
        cracked.triangles[0] = {0, 8, 3};
        cracked.triangles.push_back({8, 2, 3});
        const auto found = openings(cracked.vertices, cracked.triangles);
        REQUIRE(found.size() == 1);
        CHECK(found[0].edges.size() == 3);
        CHECK(found[0].area.norm() < 1e-15);
        CHECK(is_nearly_closed(cracked.vertices, cracked.triangles));
        CHECK((capped_solid_moments(cracked.vertices, cracked.triangles) - closed).norm() <= 1e-13 * closed.norm());
    }
    SECTION("a hole in a fine mesh: independent of the origin") {
        Mesh torus = tests::torus_mesh(1, 0.4, 12);
        torus.triangles.erase(torus.triangles.begin() + 30, torus.triangles.begin() + 34);
        CHECK(is_nearly_closed(torus.vertices, torus.triangles));
        const Vector3 shift(5, -7, 3);
        const Matrix3X moved = torus.vertices.colwise() - shift;
        const Matrix4 here = capped_solid_moments(torus.vertices, torus.triangles), there = capped_solid_moments(moved, torus.triangles);
        CHECK((shifted_moments(here, shift) - there).norm() <= 1e-12 * there.norm());
        const Matrix4 uncapped = shifted_moments(solid_moments(torus.vertices, torus.triangles), shift);
        CHECK((uncapped - solid_moments(moved, torus.triangles)).norm() > 1e-3 * there.norm());
    }
    CHECK_FALSE(is_nearly_closed(box.vertices, {}));
    CHECK_FALSE(is_nearly_closed(box.vertices, {box.triangles[0]}));
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

}  // namespace fettle::core::geometry::mass_moments_test
