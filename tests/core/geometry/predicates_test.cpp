// SPDX-License-Identifier: MIT
#include "core/geometry/predicates.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/base/contract.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::predicates_test {

namespace {

using Rational = boost::multiprecision::cpp_rational;

/// Rational(double) of boost 1.74 is exact for every finite double; built by hand all the same, to be independent of that.
Rational rational(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    Rational result = static_cast<long long>(std::ldexp(mantissa, 53));
    const Rational power = Rational(boost::multiprecision::cpp_int(1) << std::abs(exponent - 53));
    return exponent >= 53 ? Rational(result * power) : Rational(result / power);
}

struct RationalVector {
    Rational x, y, z;
    explicit RationalVector(const Vector3& v) : x(rational(v.x())), y(rational(v.y())), z(rational(v.z())) {}
    RationalVector(Rational x_, Rational y_, Rational z_) : x(std::move(x_)), y(std::move(y_)), z(std::move(z_)) {}
    RationalVector operator-(const RationalVector& o) const { return {x - o.x, y - o.y, z - o.z}; }
    RationalVector cross(const RationalVector& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
    Rational dot(const RationalVector& o) const { return x * o.x + y * o.y + z * o.z; }
};

int rational_orient3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    const RationalVector origin(a);
    return (RationalVector(b) - origin).cross(RationalVector(c) - origin).dot(RationalVector(d) - origin).sign();
}

int rational_orient2d(const Vector2& a, const Vector2& b, const Vector2& c) {
    const Rational ax = rational(a.x()), ay = rational(a.y());
    return Rational((rational(b.x()) - ax) * (rational(c.y()) - ay) - (rational(b.y()) - ay) * (rational(c.x()) - ax)).sign();
}

Vector3 random_vector(std::mt19937_64& random) { return tests::random_matrix(1, random).col(0); }

Vector3 random_grid_vector(std::mt19937_64& random, int largest) {
    std::uniform_int_distribution<int> uniform(0, largest);
    return Vector3(uniform(random), uniform(random), uniform(random));
}

/// A double with any exponent, now and then zero, subnormal or the largest.
double random_extreme(std::mt19937_64& random) {
    switch (random() % 12) {
        case 0:
            return 0;
        case 1:
            return std::numeric_limits<double>::denorm_min() * static_cast<double>(random() % 8);
        case 2:
            return std::numeric_limits<double>::max();
        default:
            break;
    }
    const int exponent = static_cast<int>(random() % 2040) - 1020;
    return std::ldexp(static_cast<double>(static_cast<long long>(random())) * 0x1p-63, exponent);
}

Vector3 random_extreme_vector(std::mt19937_64& random) { return {random_extreme(random), random_extreme(random), random_extreme(random)}; }

void check_orient3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, int expected) {
    const bool right = orient3d(a, b, c, d) == expected && orient3d(b, a, c, d) == -expected && orient3d(d, b, c, a) == -expected &&
                       orient3d(b, c, a, d) == expected;
    if (!right) {
        INFO(a.transpose() << " / " << b.transpose() << " / " << c.transpose() << " / " << d.transpose());
        CHECK(right);
    }
}

}  // namespace

TEST_CASE("orientation of simple points") {
    CHECK(orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
    CHECK(orient2d({0, 0}, {0, 1}, {1, 0}) == -1);
    CHECK(orient2d({0, 0}, {1, 1}, {2, 2}) == 0);
    CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 1);
    CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}) == -1);
    CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 7, 0}) == 0);
    CHECK_THROWS_AS(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, std::nan(""), 1}), ContractError);
    CHECK_THROWS_AS(orient2d({0, 0}, {1, 0}, {0, std::numeric_limits<double>::infinity()}), ContractError);
}

TEST_CASE("orient2d against rational arithmetic") {
    std::mt19937_64 random(1);
    int zeros = 0, wrong = 0;
    for (int i = 0; i < 6000; ++i) {
        Vector3 a = random_vector(random), b = random_vector(random), c = random_vector(random);
        if (i % 4 == 1) {
            const double t = random_vector(random).x();
            c = a + t * (b - a);  // collinear up to rounding
        } else if (i % 4 == 2) {
            a = random_grid_vector(random, 3) * 0.1, b = random_grid_vector(random, 3) * 0.1, c = random_grid_vector(random, 3) * 0.1;
        } else if (i % 4 == 3) {
            a = random_extreme_vector(random), b = random_extreme_vector(random), c = i % 8 == 3 ? a : random_extreme_vector(random);
        }
        const int expected = rational_orient2d(a.head<2>(), b.head<2>(), c.head<2>());
        zeros += expected == 0;
        wrong +=
            orient2d(a.head<2>(), b.head<2>(), c.head<2>()) != expected || orient2d(c.head<2>(), b.head<2>(), a.head<2>()) != -expected;
    }
    CHECK(wrong == 0);
    CHECK(zeros > 500);
}

TEST_CASE("orient3d against rational arithmetic: random, coplanar up to rounding, far from the origin") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 4000; ++i) {
        const Vector3 shift = i % 2 ? Vector3(1000, -300, 0.001) : Vector3(0, 0, 0);
        const Vector3 a = random_vector(random) + shift, b = random_vector(random) + shift, c = random_vector(random) + shift;
        const double s = random_vector(random).x(), t = random_vector(random).x();
        const Vector3 d = i % 3 == 0 ? Vector3(random_vector(random) + shift) : Vector3(a + s * (b - a) + t * (c - a));
        check_orient3d(a, b, c, d, rational_orient3d(a, b, c, d));
    }
}

TEST_CASE("orient3d against rational arithmetic: grids, where most is degenerate") {
    std::mt19937_64 random(3);
    int zeros = 0;
    for (int i = 0; i < 4000; ++i) {
        const double scale = i % 2 ? 0.1 : 1;
        std::array<Vector3, 4> x;
        for (Vector3& v : x) v = random_grid_vector(random, 2) * scale;
        const int expected = rational_orient3d(x[0], x[1], x[2], x[3]);
        zeros += expected == 0;
        check_orient3d(x[0], x[1], x[2], x[3], expected);
    }
    CHECK(zeros > 1000);
}

TEST_CASE("orient3d against rational arithmetic: the whole range of doubles") {
    std::mt19937_64 random(4);
    int zeros = 0;
    for (int i = 0; i < 300; ++i) {
        std::array<Vector3, 4> x;
        for (Vector3& v : x) v = random_extreme_vector(random);
        if (i % 3 == 1) x[3] = x[i % 2];
        if (i % 3 == 2) {  // all tiny: everything underflows
            for (Vector3& v : x) v = random_grid_vector(random, 3) * std::numeric_limits<double>::denorm_min();
        }
        const int expected = rational_orient3d(x[0], x[1], x[2], x[3]);
        zeros += expected == 0;
        check_orient3d(x[0], x[1], x[2], x[3], expected);
    }
    CHECK(zeros > 80);
    CHECK(zeros < 220);
}

TEST_CASE("one ulp decides") {
    const Vector3 a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3);
    CHECK(orient3d(a, b, c, {0.7, 0.9, 0.3}) == 0);
    CHECK(orient3d(a, b, c, {0.7, 0.9, std::nextafter(0.3, 1.0)}) == 1);
    CHECK(orient3d(a, b, c, {0.7, 0.9, std::nextafter(0.3, 0.0)}) == -1);
}

TEST_CASE("sign of the volume is exact") {
    const auto box = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    CHECK(volume_sign(box.vertices, box.triangles) == 1);
    CHECK(volume_sign(box.vertices, tests::inside_out(box).triangles) == -1);
    CHECK(volume_sign(box.vertices, {}) == 0);
    // A slab one ulp thick far from the origin: rounding in the sum is 1e16 times its volume.
    const double z = 1000;
    const auto slab = tests::box_mesh({1000, 1000, z}, {1001, 1001, std::nextafter(z, 2 * z)});
    CHECK(volume_sign(slab.vertices, slab.triangles) == 1);
    CHECK(volume_sign(slab.vertices, tests::inside_out(slab).triangles) == -1);
    const auto flat = tests::box_mesh({1000, 1000, z}, {1001, 1001, z});
    CHECK(volume_sign(flat.vertices, flat.triangles) == 0);
}

TEST_CASE("collinear points are degenerate, one ulp off is not") {
    CHECK(is_degenerate({Vector3(0, 0, 0), Vector3(1, 1, 1), Vector3(3, 3, 3)}));
    CHECK(is_degenerate({Vector3(1, 2, 3), Vector3(1, 2, 3), Vector3(4, 1, 3)}));
    CHECK_FALSE(is_degenerate({Vector3(0, 0, 0), Vector3(1, 1, 1), Vector3(3, 3, std::nextafter(3.0, 4.0))}));
    CHECK(projection_axis({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == 2);
}

TEST_CASE("segments in space") {
    const auto both_ways = [](const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
        const bool result = segments_intersect(a, b, c, d);
        CHECK(segments_intersect(d, c, b, a) == result);
        CHECK(segments_intersect(b, a, c, d) == result);
        return result;
    };
    CHECK(both_ways({0, 0, 0}, {2, 2, 2}, {0, 2, 1}, {2, 0, 1}));           // cross
    CHECK_FALSE(both_ways({0, 0, 0}, {2, 2, 2}, {0, 2, 1}, {2, 0, 1.01}));  // skew
    CHECK(both_ways({0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 1}));           // T
    CHECK(both_ways({0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {3, 1, 1}));           // end to end
    CHECK(both_ways({0, 0, 0}, {2, 2, 2}, {1, 1, 1}, {3, 3, 3}));           // overlap on a line
    CHECK(both_ways({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {3, 3, 3}));
    CHECK_FALSE(both_ways({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}));
    CHECK_FALSE(both_ways({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}));  // parallel
    CHECK(both_ways({1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {3, 3, 3}));        // a point on a segment
    CHECK_FALSE(both_ways({1, 1, 1}, {1, 1, 1}, {1, 1, 2}, {1, 1, 2}));
}

TEST_CASE("segment against triangle") {
    const std::array<Vector3, 3> t{Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
    CHECK(segment_intersects_triangle({1, 1, -1}, {1, 1, 1}, t));
    CHECK(segment_intersects_triangle({1, 1, 0}, {1, 1, 1}, t));   // ends in the face
    CHECK(segment_intersects_triangle({2, 2, -1}, {2, 2, 1}, t));  // through an edge
    CHECK(segment_intersects_triangle({4, 0, -1}, {4, 0, 1}, t));  // through a corner
    CHECK_FALSE(segment_intersects_triangle({3, 3, -1}, {3, 3, 1}, t));
    CHECK_FALSE(segment_intersects_triangle({1, 1, 1}, {1, 1, 2}, t));
    CHECK(segment_intersects_triangle({1, 1, 0}, {1.5, 1, 0}, t));  // within, coplanar
    CHECK(segment_intersects_triangle({-1, 1, 0}, {9, 1, 0}, t));   // across, coplanar
    CHECK_FALSE(segment_intersects_triangle({3, 3, 0}, {9, 1, 0}, t));
    const std::array<Vector3, 3> needle{Vector3(1, 1, 1), Vector3(0, 0, 0), Vector3(2, 2, 2)};
    CHECK(segment_intersects_triangle({2, 0, 1}, {0, 2, 1}, needle));
    CHECK_FALSE(segment_intersects_triangle({3, 0, 3}, {3, 6, 3}, needle));
}

}  // namespace fettle::core::geometry::predicates_test
