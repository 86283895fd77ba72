// SPDX-License-Identifier: MIT
#include "core/clearance/element_pair.hpp"

#include <catch2/catch.hpp>

#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::core::clearance::element_pair_test {

using namespace fettle::tests::clearance;
using core::clearance::Corners;
using core::clearance::element_pair_distance;
using core::clearance::Primitive;

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
        const auto pair = element_pair_distance({a, 3}, {b, 3});
        CHECK(!pair.intersecting);
        CHECK(std::abs(static_cast<double>(pair.distance - oracle(a, b))) < 1e-14);
        CHECK(std::abs((pair.point_a - pair.point_b).norm() - pair.distance) < 1e-14);
        CHECK((pair.point_a - pair.point_b - pair.difference).norm() < 1e-14);
        const auto swapped = element_pair_distance({b, 3}, {a, 3});
        CHECK(std::abs(swapped.distance - pair.distance) < 1e-14);
    }
}

TEST_CASE("Triangles that pass through each other are at distance 0", "[clearance]") {
    std::mt19937 random(2);
    int piercing = 0;
    for (int i = 0; i < 2000; ++i) {
        const Matrix3 a = random_triangle(random, Vector3::Zero()), b = random_triangle(random, random_vector(random, 0.6));
        const auto pair = element_pair_distance({a, 3}, {b, 3});
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

TEST_CASE("Points and edges against each other and triangles", "[clearance]") {
    std::mt19937 random(3);
    const auto element = [&](int count, const Vector3& center) {
        Corners c{random_triangle(random, center), count};
        for (int k = count; k < 3; ++k) c.x.col(k) = c.x.col(count - 1);
        return c;
    };
    for (int i = 0; i < 900; ++i) {
        const int na = 1 + i % 3, nb = 1 + i / 3 % 3;
        const Corners a = element(na, Vector3::Zero()), b = element(nb, Vector3(0.3, 0.2, 2.2));
        const auto pair = element_pair_distance(a, b);
        // The closest points of convex sets: by alternating projection in extended precision, from the points found and from corners.
        const auto x = a.x.cast<Real>().eval(), y = b.x.cast<Real>().eval();
        Real3 p = x.col(0), q = y.col(0);
        for (int k = 0; k < 20000; ++k) {
            q = oracle_closest_on_triangle(p, y.col(0), y.col(1), y.col(2));
            const Real3 next = oracle_closest_on_triangle(q, x.col(0), x.col(1), x.col(2));
            if ((next - p).norm() < 1e-17L) break;
            p = next;
        }
        CAPTURE(i, na, nb);
        CHECK(std::abs(static_cast<double>(pair.distance - (p - q).norm())) < 1e-9);
        CHECK(pair.distance <= static_cast<double>((p - q).norm()) + 1e-14);
        CHECK(std::abs((pair.point_a - pair.point_b).norm() - pair.distance) < 1e-14);
        CHECK(!pair.intersecting);
        if (na == 1) CHECK(pair.kind_a == Primitive::vertex);
        if (na == 2 && nb == 2) CHECK((pair.kind_a == Primitive::edge && pair.kind_b == Primitive::edge));
        if (na == 2 && nb == 1) CHECK((pair.kind_a == Primitive::edge && pair.kind_b == Primitive::vertex));
    }
    const auto pierced = element_pair_distance({Matrix3((Matrix3() << 0, 0, 0, 0, 0, 0, -1, 1, 1).finished()), 2},
                                               {Matrix3((Matrix3() << -1, 2, -1, -1, -1, 2, 0, 0, 0).finished()), 3});
    CHECK(pierced.intersecting);
    CHECK(pierced.distance < 1e-15);
    CHECK(pierced.depth == Approx(std::sqrt(0.5)));
}

TEST_CASE("Slivers and triangles without area break nothing", "[clearance]") {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        Matrix3 a = random_triangle(random, Vector3::Zero());
        const Matrix3 b = random_triangle(random, Vector3(0.3, 0.2, i % 5 == 0 ? 0.3 : 2.2));
        const double thin = i % 3 == 0 ? 0 : std::pow(10.0, -4 - 60 * std::abs(u(random)));
        a.col(2) = a.col(0) + u(random) * (a.col(1) - a.col(0)) + thin * a.col(2);
        if (i % 7 == 0) a.col(1) = a.col(0);
        const auto pair = element_pair_distance({a, 3}, {b, 3});
        CAPTURE(i, thin, pair.distance);
        CHECK((std::isfinite(pair.distance) && pair.point_a.allFinite() && pair.point_b.allFinite()));
        // No point of the sliver is nearer than its edges; the triangle b is whole.
        Real edges = 1e300L;
        const auto x = a.cast<Real>().eval(), y = b.cast<Real>().eval();
        for (int k = 0; k <= 400; ++k)
            for (int e = 0; e < 3; ++e) {
                const Real3 p = x.col(e) + Real(k) / 400 * (x.col((e + 1) % 3) - x.col(e));
                edges = std::min(edges, (p - oracle_closest_on_triangle(p, y.col(0), y.col(1), y.col(2))).norm());
            }
        CHECK(pair.distance <= static_cast<double>(edges) + 1e-12);
        if (!pair.intersecting) CHECK(pair.distance >= static_cast<double>(edges) - 2e-2);
    }
}

TEST_CASE("The features of another place are a way to begin, whatever they are", "[clearance]") {
    std::mt19937 random(11);
    int same = 0, other = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vector3 beside(0.3, 0.2, 2.2);
        const Matrix3 a = random_triangle(random, Vector3::Zero()),
                      b = random_triangle(random, i % 3 == 0 ? Vector3(0.5 * beside) : beside);
        const Vector3 moved = random_vector(random, i % 2 == 0 ? 0.1 : 3);
        const auto before = element_pair_distance({a, 3}, {b.colwise() + moved, 3});
        const auto pair = element_pair_distance({a, 3}, {b, 3}), again = element_pair_distance({a, 3}, {b, 3}, &before);
        (pair.kind_a == before.kind_a && pair.corner_a == before.corner_a && pair.corner_b == before.corner_b ? same : other) += 1;
        CHECK(again.intersecting == pair.intersecting);
        CHECK(std::abs(again.distance - pair.distance) < 1e-14);
        CHECK((again.difference - pair.difference).norm() < 1e-13);
        CHECK((again.point_a - again.point_b - again.difference).norm() < 1e-14);
        CHECK(std::abs(again.depth - pair.depth) < 1e-13);
    }
    CHECK(same > 500);
    CHECK(other > 500);
}

}  // namespace fettle::core::clearance::element_pair_test
