// SPDX-License-Identifier: MIT
// The header's bound, 64 u L whatever the pair, against exact rational arithmetic (tests/support/exact_ccd.hpp) on pairs at the edge of
// being collinear, parallel, coplanar, slivers or of no size.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/geometry/distance.hpp"
#include "tests/support/exact_ccd.hpp"

namespace fettle::core::geometry::distance_campaign_test {

using core::geometry::ClosestPoints;
using core::geometry::edge_edge_closest;
using core::geometry::PairType;
using core::geometry::PairVertices;
using core::geometry::point_triangle_closest;

namespace {

class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed) {}

    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    /// 10^x, x in [low, high].
    double decade(double low, double high) { return std::pow(10.0, uniform(low, high)); }
    bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }
    Vector3 direction() {
        std::normal_distribution<double> n;
        return Vector3(n(random_), n(random_), n(random_)).normalized();
    }

    /// Two edges at an angle from 0 to 0.3, their lines from 0 to 1 apart, meeting within both, at an end or beyond.
    PairVertices edges(bool collinear, bool parallel) {
        const Vector3 along = direction(), up = direction().cross(along).normalized(), across = along.cross(up);
        const double length_a = one_in(3) ? decade(-8, 0) : 1, length_b = one_in(3) ? decade(-8, 0) : 1;
        const double angle = collinear || parallel ? 0 : decade(-18, -0.5);
        const double apart = one_in(4) ? 0 : decade(-17, 0);
        double s = uniform(-0.5, 1.5), t = uniform(-0.5, 1.5);
        if (collinear) {
            s = one_in(2) ? 1 + decade(-16, 0) : -decade(-16, 0);
            t = one_in(2) ? 0 : 1;
        }
        const Vector3 turned = std::cos(angle) * along + std::sin(angle) * across;
        const Vector3 start = one_in(2) ? direction() : Vector3(0, 0, 0);
        const Vector3 other = start + s * length_a * along + (collinear && one_in(2) ? 0.0 : apart) * up - t * length_b * turned;
        return shuffled({start, start + length_a * along, other, other + length_b * turned});
    }

    /// A triangle of any height down to 0, a point above, beside or in it.
    PairVertices face(bool flat, bool needle) {
        const Vector3 along = direction(), up = direction().cross(along).normalized(), across = along.cross(up);
        const double length = one_in(3) ? decade(-6, 0) : 1, height = flat ? 0 : decade(-18, 0);
        const double at = needle ? decade(-12, 0) : uniform(-0.2, 1.2);
        const Vector3 t0 = one_in(2) ? direction() : Vector3(0, 0, 0), t1 = t0 + length * along;
        const Vector3 t2 = t0 + at * length * along + height * length * across;
        Vector3 p = t0 + uniform(-0.1, 1.1) * (t1 - t0) + uniform(-0.1, 1.1) * (t2 - t0) + (one_in(4) ? 0.0 : decade(-17, 0)) * up;
        if (one_in(5)) p += decade(-17, 0) * direction();
        if (one_in(3)) return {p, t1, t2, t0};
        return one_in(2) ? PairVertices{p, t0, t2, t1} : PairVertices{p, t2, t0, t1};
    }

    /// Coinciding vertices.
    PairVertices of_no_size(PairType type) {
        PairVertices x = type == PairType::edge_edge ? edges(false, false) : face(false, false);
        if (type == PairType::point_triangle) {
            x[2] = x[1];
            if (one_in(3)) x[3] = x[1];
        } else {
            (one_in(2) ? x[1] : x[3]) = one_in(2) ? x[0] : x[2];
            if (one_in(4)) x = {x[0], x[0], x[2], x[2]};
        }
        return x;
    }

private:
    PairVertices shuffled(PairVertices x) {
        if (one_in(2)) std::swap(x[0], x[1]);
        if (one_in(2)) std::swap(x[2], x[3]);
        if (one_in(2)) x = {x[2], x[3], x[0], x[1]};
        return x;
    }

    std::mt19937_64 random_;
};

ClosestPoints closest(PairType type, const PairVertices& x) {
    return type == PairType::point_triangle ? point_triangle_closest(x[0], x[1], x[2], x[3]) : edge_edge_closest(x[0], x[1], x[2], x[3]);
}

/// Is the computed distance within the header's bound of the true one, and do the weights mean what it says?
bool is_within_bound(PairType type, const PairVertices& x) {
    double size = 0;
    for (const Vector3& v : x)
        for (const Vector3& w : x) size = std::max(size, (v - w).norm());
    if (size == 0) return true;
    const ClosestPoints c = closest(type, x);
    const double distance = std::sqrt(c.distance_squared), slack = 64 * 0x1p-53 * size;
    if (!tests::exact_distance_at_most(type, x, x, 0, distance + slack)) return false;
    if (distance > slack && tests::exact_distance_at_most(type, x, x, 0, distance - slack)) return false;
    for (std::size_t k = 0; k < 4; ++k) {
        const double weight = k == 0 || (k == 1 && type == PairType::edge_edge) ? c.weight[k] : -c.weight[k];
        if (!(weight >= 0 && weight <= 1)) return false;
    }
    return true;
}

int count_wrong(int trials, unsigned seed) {
    Generator g(seed);
    int wrong = 0;
    for (int i = 0; i < trials; ++i) {
        const PairType type = i % 2 ? PairType::edge_edge : PairType::point_triangle;
        const int kind = i / 2 % 4;
        PairVertices x = kind == 3                     ? g.of_no_size(type)
                         : type == PairType::edge_edge ? g.edges(kind == 0, kind == 1)
                                                       : g.face(kind == 0, kind == 1);
        const double scale = g.one_in(3) ? 1 : g.decade(-20, 20);
        for (Vector3& v : x) v *= scale;
        wrong += !is_within_bound(type, x);
    }
    return wrong;
}

}  // namespace

TEST_CASE("distances of degenerate pairs are within the header's bound") { CHECK(count_wrong(12000, 1) == 0); }

TEST_CASE("distances of very many degenerate pairs are within the header's bound", "[slow]") { CHECK(count_wrong(600000, 2) == 0); }

TEST_CASE("collinear edges end to end are as far apart as their ends") {
    Generator g(7);
    for (int i = 0; i < 2000; ++i) {
        const Vector3 along = g.direction(), start = g.direction();
        const double gap = g.decade(-6, 0);
        const auto at = [&](double x) { return Vector3(start + x * along); };
        const double d = std::sqrt(core::geometry::edge_edge_distance_squared(at(0), at(1), at(1 + gap), at(2 + gap)));
        REQUIRE(std::abs(d - gap) < 1e-14);
    }
}

TEST_CASE("a distance of what is not finite is not finite") {
    const PairVertices x{Vector3(0.2, 0.3, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (std::size_t i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) {
                PairVertices y = x;
                y[i][k] = bad;
                CHECK(!std::isfinite(closest(PairType::point_triangle, y).distance_squared));
                CHECK(!std::isfinite(closest(PairType::edge_edge, y).distance_squared));
            }
}

}  // namespace fettle::core::geometry::distance_campaign_test
