// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/triangle_pair.hpp"

#include <catch2/catch.hpp>

#include "fettle/tests/core/clearance/clearance_oracle.hpp"

using namespace fettle;
using namespace fettle::tests::clearance;
using core::clearance::triangle_pair_distance;

namespace {

Matrix3 random_triangle(std::mt19937& random, const Vector3& center) {
    Matrix3 x;
    for (int k = 0; k < 3; ++k) x.col(k) = center + random_vector(random, 1);
    return x;
}

Real oracle(const Matrix3& a, const Matrix3& b) {
    Real least = 1e300L;
    const auto x = a.cast<Real>().eval(), y = b.cast<Real>().eval();
    for (int i = 0; i < 3; ++i) {
        least = std::min(least, (x.col(i) - oracle_closest_on_triangle(x.col(i), y.col(0), y.col(1), y.col(2))).norm());
        least = std::min(least, (y.col(i) - oracle_closest_on_triangle(y.col(i), x.col(0), x.col(1), x.col(2))).norm());
        for (int j = 0; j < 3; ++j)
            least = std::min(least, oracle_edge_distance(x.col(i), x.col((i + 1) % 3), y.col(j), y.col((j + 1) % 3)));
    }
    return least;
}

}  // namespace

TEST_CASE("Distance of disjoint triangles agrees with an independent one, points included", "[clearance]") {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Matrix3 a = random_triangle(random, Vector3::Zero()), b = random_triangle(random, Vector3(0.3, 0.2, 2.2));
        const auto pair = triangle_pair_distance(a, b);
        CHECK(!pair.intersecting);
        CHECK(std::abs(static_cast<double>(pair.distance - oracle(a, b))) < 1e-14);
        CHECK(std::abs((pair.point_a - pair.point_b).norm() - pair.distance) < 1e-14);
        CHECK((pair.point_a - pair.point_b - pair.difference).norm() < 1e-14);
        const auto swapped = triangle_pair_distance(b, a);
        CHECK(std::abs(swapped.distance - pair.distance) < 1e-14);
    }
}

TEST_CASE("Triangles that pass through each other are at distance 0", "[clearance]") {
    std::mt19937 random(2);
    int piercing = 0;
    for (int i = 0; i < 2000; ++i) {
        const Matrix3 a = random_triangle(random, Vector3::Zero()), b = random_triangle(random, random_vector(random, 0.6));
        const auto pair = triangle_pair_distance(a, b);
        // Independent: an edge of one crosses the other's inside, by orientations (far from degenerate, or not counted).
        const auto volume = [](const Vector3& p, const Vector3& q, const Vector3& r, const Vector3& s) {
            return (q - p).dot((r - p).cross(s - p));
        };
        const auto crosses = [&](const Matrix3& edges, const Matrix3& t) {
            for (int k = 0; k < 3; ++k) {
                const Vector3 p = edges.col(k), q = edges.col((k + 1) % 3);
                const double sides = volume(p, t.col(0), t.col(1), t.col(2)) * volume(q, t.col(0), t.col(1), t.col(2));
                const double v0 = volume(p, q, t.col(0), t.col(1)), v1 = volume(p, q, t.col(1), t.col(2)),
                             v2 = volume(p, q, t.col(2), t.col(0));
                if (sides < 0 && v0 * v1 > 0 && v1 * v2 > 0) return true;
            }
            return false;
        };
        const bool expected = crosses(a, b) || crosses(b, a);
        piercing += expected;
        CHECK(pair.intersecting == expected);
        if (expected) CHECK(pair.distance < 1e-13);
        if (!expected) CHECK(std::abs(static_cast<double>(pair.distance - oracle(a, b))) < 1e-14);
    }
    CHECK(piercing > 200);
}
