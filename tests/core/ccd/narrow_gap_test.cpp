// SPDX-License-Identifier: MIT
// Gaps down to 1e-9 of the size can be proven, whatever the features and however they are turned: lower bounds against exact distances, and
// small approaching motions are no hits at the start.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/ccd/curved_ccd.hpp"
#include "core/ccd/linear_ccd.hpp"
#include "tests/support/exact_ccd.hpp"

namespace fettle::core::ccd::narrow_gap_test {

namespace {

/// A pair of size about 1 with a gap, in a chosen position, then turned and moved anyhow.
struct NarrowPair {
    geometry::PairType type = geometry::PairType::edge_edge;
    geometry::PairVertices x;
};

constexpr int kinds = 12;

class Generator {
public:
    NarrowPair pair(int kind, double gap) {
        NarrowPair p = upright(kind, gap);
        const Matrix3 turn =
            Eigen::Quaterniond(normal_(random_), normal_(random_), normal_(random_), normal_(random_)).normalized().toRotationMatrix();
        const Vector3 offset(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        for (Vector3& v : p.x) v = turn * v + offset;
        if (p.type == geometry::PairType::edge_edge && uniform(0, 1) < 0.5) p.x = {p.x[3], p.x[2], p.x[0], p.x[1]};
        return p;
    }
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Vector3 vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }

private:
    NarrowPair upright(int kind, double g) {
        const Vector3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
        const double small = std::pow(10.0, uniform(-12, 0)), s = uniform(0.1, 0.9);
        switch (kind) {
            case 0:  // vertex over face
                return {geometry::PairType::point_triangle, {Vector3(uniform(0.1, 0.4), uniform(0.1, 0.4), g), o, x, y}};
            case 1:  // vertex beside an edge, in the plane
                return {geometry::PairType::point_triangle, {Vector3(s, -g, 0), o, x, y}};
            case 2:  // vertex at vertex
                return {geometry::PairType::point_triangle, {Vector3(-0.6 * g, -0.8 * g, 0), o, x, y}};
            case 3:  // edges that cross
                return {geometry::PairType::edge_edge, {Vector3(-0.5, 0, g), Vector3(0.5, 0, g), Vector3(0, -0.5, 0), Vector3(0, 0.5, 0)}};
            case 4:  // collinear, end to end
                return {geometry::PairType::edge_edge, {o, x, (1 + g) * x, 2 * x}};
            case 5:  // parallel, side by side
                return {geometry::PairType::edge_edge, {o, x, Vector3(s, g, 0), Vector3(s + 1, g, 0)}};
            case 6:  // an end over an edge, the rest leaning away by any angle
                return {geometry::PairType::edge_edge,
                        {o, x, Vector3(s, g * std::cos(3 * small), g * std::sin(3 * small)),
                         Vector3(s + uniform(-1, 1), g + small, uniform(-0.5, 0.5))}};
            case 7: {  // edges that cross at any angle
                const Vector3 b(0.5 * std::cos(small), 0.5 * std::sin(small), 0);
                return {geometry::PairType::edge_edge, {Vector3(-0.5, 0, g), Vector3(0.5, 0, g), -b, b}};
            }
            case 8:  // a T in a plane
                return {geometry::PairType::edge_edge, {o, x, Vector3(s, g, 0), Vector3(s + uniform(-0.5, 0.5), g + uniform(0.1, 1), 0)}};
            case 9: {  // vertex over a sliver, its corner anywhere along
                const double along = uniform(-0.2, 1.2), b1 = uniform(0.05, 0.4), b2 = uniform(0.05, 0.4);
                const Vector3 corner(along, small, 0);
                return {geometry::PairType::point_triangle, {b1 * x + b2 * corner + g * Vector3(0, 0, 1), o, x, corner}};
            }
            case 10: {  // vertex beside a sliver, anywhere
                const Vector3 corner(uniform(-0.2, 1.2), small, 0), p(uniform(-0.2, 1.2), uniform(-1, 1) * small, 0);
                return {geometry::PairType::point_triangle, {p + g * Vector3(0, 0, 1), o, x, corner}};
            }
            default:  // end to end, nearly collinear
                return {geometry::PairType::edge_edge,
                        {Vector3(-g, 0, 0), Vector3(-g - 1, small, uniform(-1, 1) * small), o,
                         Vector3(1, uniform(-1, 1) * small, uniform(-1, 1) * small)}};
        }
    }

    std::mt19937_64 random_{9};
    std::normal_distribution<double> normal_;
};

/// The pair's vertices as two bodies that do not turn, and go `step` and nowhere.
CurvedCcdResult curved(const NarrowPair& p, const Vector3& step, const Vector3& turn) {
    kinematics::PathSegment a, b;
    a.position_t0 = p.x[0];
    a.position_step = step;
    a.rotation_vector_step = turn;
    b.position_t0 = p.x[3];
    geometry::PairVertices X;
    const std::size_t n = p.type == geometry::PairType::point_triangle ? 1 : 2;
    for (std::size_t i = 0; i < 4; ++i) X[i] = p.x[i] - (i < n ? p.x[0] : p.x[3]);
    return curved_ccd(p.type, a, b, X, 0);
}

}  // namespace

TEST_CASE("lower bounds of narrow gaps are proven and close") {
    Generator g;
    for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9})
        for (int i = 0; i < 150 * kinds; ++i) {
            const NarrowPair p = g.pair(i % kinds, gap);
            const double bound = distance_lower_bound(p.type, p.x);
            INFO("gap " << gap << ", kind " << i % kinds);
            REQUIRE(bound > 0);
            REQUIRE(!tests::exact_distance_at_most(p.type, p.x, p.x, 0, bound * (1 - 0x1p-50)));
            REQUIRE(tests::exact_distance_at_most(p.type, p.x, p.x, 0, bound / 0.7));
        }
}

TEST_CASE("a small approach over a narrow gap is no hit at the start") {
    Generator g;
    int cleared = 0, hits = 0;
    for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9})
        for (int i = 0; i < 100 * kinds; ++i) {
            const NarrowPair p = g.pair(i % kinds, gap);
            INFO("gap " << gap << ", kind " << i % kinds);
            // Less than half of what is there: never a hit.
            const Vector3 way = g.vector().normalized();
            const double distance = distance_lower_bound(p.type, p.x);
            geometry::PairVertices moved = p.x;
            const std::size_t n = p.type == geometry::PairType::point_triangle ? 1 : 2;
            for (std::size_t k = 0; k < n; ++k) moved[k] += 0.4 * distance * way;
            REQUIRE(!linear_ccd(p.type, p.x, moved, 0).hit);
            const Vector3 turn = 0.05 * distance * g.vector().normalized();
            REQUIRE(!curved(p, 0.3 * distance * way, turn).hit);
            ++cleared;
            // Far more: a hit perhaps, but not at the start.
            const CurvedCcdResult far = curved(p, 1e-2 * way, Vector3::Zero());
            if (!far.hit) continue;
            ++hits;
            REQUIRE(far.toi > 0);
            REQUIRE(far.toi * 1e-2 > 0.5 * distance);
        }
    CHECK(cleared == 4 * 100 * kinds);
    CHECK(hits > 500);
}

}  // namespace fettle::core::ccd::narrow_gap_test
