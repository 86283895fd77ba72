// SPDX-License-Identifier: MIT
// Oracle: exact rational arithmetic (tests/support/exact_ccd.hpp), on random, degenerate and distant pairs.
#include "core/geometry/distance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/support/exact_ccd.hpp"

namespace fettle::core::geometry::distance_test {

using core::geometry::ClosestPoints;
using core::geometry::PairType;
using core::geometry::PairVertices;

namespace {

ClosestPoints closest(PairType type, const PairVertices& x) {
    return type == PairType::point_triangle ? core::geometry::point_triangle_closest(x[0], x[1], x[2], x[3])
                                            : core::geometry::edge_edge_closest(x[0], x[1], x[2], x[3]);
}

class Generator {
public:
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    Vector3 point(int range) { return Vector3(integer(-range, range), integer(-range, range), integer(-range, range)); }
    PairType type() { return integer(0, 1) == 0 ? PairType::point_triangle : PairType::edge_edge; }
    /// On a small grid most pairs are degenerate somehow: parallel, coplanar, touching, of no length.
    PairVertices pair() {
        PairVertices x;
        const int range = integer(1, 6);
        for (Vector3& v : x) v = point(range);
        const int kind = integer(0, 5);
        if (kind == 0) x[3] = x[2] + integer(-2, 2) * (x[1] - x[0]);
        if (kind == 1) x[3] = x[2];
        if (kind == 2) x[3] = x[1] + integer(-2, 2) * (x[2] - x[1]);
        return x;
    }

private:
    std::mt19937_64 random_{3};
};

}  // namespace

TEST_CASE("closest points are as far apart as exact arithmetic says") {
    Generator g;
    int wrong = 0, faces = 0, edges = 0, vertices = 0;
    for (int i = 0; i < 6000; ++i) {
        const PairType type = g.type();
        PairVertices x = g.pair();
        const double scale = std::ldexp(1.0, g.integer(-20, 20)), far = i % 3 == 0 ? 0x1p20 : 0;
        for (Vector3& v : x) v = scale * (v + Vector3(far, -far, far));
        const ClosestPoints c = closest(type, x);
        const double distance = std::sqrt(c.distance_squared), slack = 1e-14 * 20 * scale;
        wrong += !tests::exact_distance_at_most(type, x, x, 0, distance + slack);
        wrong += distance > slack && tests::exact_distance_at_most(type, x, x, 0, distance - slack);
        (c.free_count == 2 ? faces : c.free_count == 1 ? edges : vertices)++;
    }
    CHECK(wrong == 0);
    CHECK(faces > 500);
    CHECK(edges > 500);
    CHECK(vertices > 500);
}

TEST_CASE("closest points of slivers are as far apart as exact arithmetic says") {
    Generator g;
    int wrong = 0, faces = 0;
    for (int i = 0; i < 3000; ++i) {
        // Two vertices close together, the third 2^10 to 2^30 times as far off, and the point above one or the other end.
        const double reach = std::ldexp(1.0, g.integer(10, 30));
        PairVertices x{Vector3(0, 0, 0), Vector3(0, 0, 0), Vector3(1, 0.25, 0), Vector3(0, 0, 0)};
        x[3] = reach * (Vector3(0.5, 1, 0.25) + 0.125 * g.point(4));
        const double at = g.integer(1, 7) / 8.0, along = i % 2 ? g.integer(1, 7) / 8.0 : g.integer(1, 7) / reach;
        x[0] = at * (1 - along) * x[2] + along * x[3];
        x[0] += std::ldexp(g.integer(1, 9), -g.integer(4, 12)) * (x[2] - x[1]).cross(x[3] - x[1]).normalized();
        const int turn = g.integer(0, 2);
        const PairVertices turned{x[0], x[1 + turn], x[1 + (1 + turn) % 3], x[1 + (2 + turn) % 3]};
        const ClosestPoints c = closest(PairType::point_triangle, turned);
        const double distance = std::sqrt(c.distance_squared), slack = 1e-15 * reach;
        wrong += !tests::exact_distance_at_most(PairType::point_triangle, turned, turned, 0, distance + slack);
        wrong += distance > slack && tests::exact_distance_at_most(PairType::point_triangle, turned, turned, 0, distance - slack);
        faces += c.free_count == 2;
    }
    CHECK(wrong == 0);
    CHECK(faces > 500);
}

TEST_CASE("weights say where the closest points are") {
    Generator g;
    int wrong = 0;
    for (int i = 0; i < 6000; ++i) {
        const PairType type = g.type();
        const PairVertices x = g.pair();
        const ClosestPoints c = closest(type, x);
        Vector3 r = Vector3::Zero();
        for (std::size_t k = 0; k < 4; ++k) r += c.weight[k] * x[k];
        wrong += (r - c.difference).norm() > 1e-13 || std::abs(c.distance_squared - c.difference.squaredNorm()) > 1e-13;
        // Weights of the two primitives: convex, adding to 1 and -1, none of the wrong sign.
        const std::size_t first_count = type == PairType::point_triangle ? 1 : 2;
        double first = 0, second = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            (k < first_count ? first : second) += c.weight[k];
            wrong += k < first_count ? c.weight[k] < -1e-15 : c.weight[k] > 1e-15;
        }
        wrong += std::abs(first - 1) > 1e-14 || std::abs(second + 1) > 1e-14;
        // At an interior minimum the difference is normal to every way the weights are free to change.
        for (int k = 0; k < c.free_count; ++k) {
            Vector3 way = Vector3::Zero();
            for (std::size_t j = 0; j < 4; ++j) way += c.free_weight[k][j] * x[j];
            wrong += std::abs(way.dot(c.difference)) > 1e-12 * (1 + way.norm());
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("near contact the difference is turned by rounding of angles, not of lengths") {
    Generator g;
    int wrong = 0, faces = 0;
    for (int i = 0; i < 3000; ++i) {
        // A point over a triangle, or two edges over each other, of 14 m, a nanometre to a tenth of a millimetre apart along z.
        const double gap = std::ldexp(1.0, -g.integer(13, 30));
        PairVertices x;
        for (Vector3& v : x) v = 14.0 * g.point(10);
        for (Vector3& v : x) v.z() = 0;
        if (g.type() == PairType::point_triangle) {
            x[0] = (x[1] + x[2] + x[3]) / 3;
            x[0].z() = gap;
            const ClosestPoints c = closest(PairType::point_triangle, x);
            if (c.free_count < 2) continue;
            ++faces;
            wrong += c.difference.head<2>().norm() > 0 || std::abs(c.difference.z() / gap - 1) > 1e-15;
        } else {
            x[0].z() = x[1].z() = gap;
            const ClosestPoints c = closest(PairType::edge_edge, x);
            if (c.free_count < 2) continue;
            ++faces;
            wrong += c.difference.head<2>().norm() > 0 || std::abs(c.difference.z() / gap - 1) > 1e-15;
        }
    }
    CHECK(wrong == 0);
    CHECK(faces > 1000);
}

TEST_CASE("near an edge the difference is normal to it") {
    Generator g;
    int wrong = 0, edges = 0;
    for (int i = 0; i < 3000; ++i) {
        const double gap = std::ldexp(1.0, -g.integer(13, 30));
        const Vector3 e0 = 14.0 * g.point(10), e1 = 14.0 * g.point(10);
        const Vector3 e = (e1 - e0).normalized(), off = gap * e.unitOrthogonal();
        const Vector3 p = 0.3 * e0 + 0.7 * e1 + off;
        // The triangle lies on the edge's other side.
        const ClosestPoints c = point_triangle_closest(p, e0, e1, 0.5 * (e0 + e1) - 1e9 * off);
        if (c.free_count != 1) continue;
        ++edges;
        wrong += std::abs(c.difference.dot(e)) > 4e-16 * c.difference.norm();
    }
    CHECK(wrong == 0);
    CHECK(edges > 1000);
}

}  // namespace fettle::core::geometry::distance_test
