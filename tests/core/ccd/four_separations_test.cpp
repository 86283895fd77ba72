// SPDX-License-Identifier: MIT
// Four bounds at a time against distances along the motion, and against the planes that are found one by one.
#include "core/ccd/four_separations.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/ccd/separating_plane.hpp"
#include "core/geometry/distance.hpp"

namespace fettle::core::ccd::four_separations_test {

namespace {

using geometry::PairType;
using geometry::PairVertices;

struct Motion {
    PairVertices t0, t1;
};

std::array<double, 4> separations(PairType type, const std::array<Motion, 4>& motions) {
    std::array<std::array<SweptVertex, 4>, 4> swept;
    FourPairs x;
    for (std::size_t pair = 0; pair < 4; ++pair)
        for (std::size_t i = 0; i < 4; ++i) {
            const Vector3 &a = motions[pair].t0[i], &b = motions[pair].t1[i];
            swept[pair][i] = {a[0], a[1], a[2], b[0], b[1], b[2]};
            x[i][pair] = &swept[pair][i];
        }
    return four_separations(type, x);
}

double distance(PairType type, const PairVertices& x) {
    return std::sqrt(type == PairType::point_triangle ? geometry::point_triangle_distance_squared(x[0], x[1], x[2], x[3])
                                                      : geometry::edge_edge_distance_squared(x[0], x[1], x[2], x[3]));
}

double least_distance(PairType type, const Motion& motion) {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 32; ++k) {
        PairVertices x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = (1 - k / 32.0) * motion.t0[i] + k / 32.0 * motion.t1[i];
        least = std::min(least, distance(type, x));
    }
    return least;
}

Motion random_motion(std::mt19937_64& random, double travel) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Motion out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.t0[i] = Vector3(unit(random), unit(random), unit(random));
        out.t1[i] = out.t0[i] + travel * Vector3(unit(random), unit(random), unit(random));
    }
    return out;
}

}  // namespace

TEST_CASE("four separations are bounds along the motion, and the distance at rest", "[four_separations]") {
    std::mt19937_64 random(1);
    for (const PairType type : {PairType::point_triangle, PairType::edge_edge})
        for (int trial = 0; trial < 2000; ++trial) {
            const double travel = trial % 4 == 0 ? 0 : 0.1 * (trial % 7);
            std::array<Motion, 4> motions;
            for (Motion& motion : motions) motion = random_motion(random, travel);
            const std::array<double, 4> bounds = separations(type, motions);
            for (std::size_t k = 0; k < 4; ++k) {
                const double least = least_distance(type, motions[k]);
                REQUIRE(bounds[k] >= 0);
                REQUIRE(bounds[k] <= least);
                if (travel == 0) REQUIRE(bounds[k] >= (1 - 1e-9) * least - 1e-12);
            }
        }
}

TEST_CASE("four separations of nearly parallel edges and slivers stay bounds, and useful ones", "[four_separations]") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vector = [&] { return Vector3(unit(random), unit(random), unit(random)); };
    for (int trial = 0; trial < 2000; ++trial) {
        const double tiny = std::pow(10, -1 - trial % 16);
        std::array<Motion, 4> edges, slivers;
        for (std::size_t k = 0; k < 4; ++k) {
            const Vector3 a = vector(), along = vector(), b = a + vector();
            edges[k].t0 = {a, a + along, b, b + along + tiny * vector()};
            slivers[k].t0 = {b, a, a + along, a + 0.3 * along + tiny * vector()};
            edges[k].t1 = edges[k].t0;
            slivers[k].t1 = slivers[k].t0;
        }
        for (const auto& [type, motions] : {std::pair(PairType::edge_edge, &edges), std::pair(PairType::point_triangle, &slivers)}) {
            const std::array<double, 4> bounds = separations(type, *motions);
            for (std::size_t k = 0; k < 4; ++k) {
                const double least = distance(type, (*motions)[k].t0);
                REQUIRE(bounds[k] <= least * (1 + 1e-15) + 1e-15);
                REQUIRE(bounds[k] >= 0.9 * least - 1e-4);
            }
        }
    }
}

TEST_CASE("what is not finite, too large or in one place is separated by nothing, and leaves the other three", "[four_separations]") {
    std::mt19937_64 random(3);
    for (const PairType type : {PairType::point_triangle, PairType::edge_edge})
        for (const double bad : {std::nan(""), double(INFINITY), 1e200})
            for (std::size_t which = 0; which < 4; ++which)
                for (std::size_t vertex = 0; vertex < 4; ++vertex) {
                    std::array<Motion, 4> motions;
                    for (Motion& motion : motions) motion = random_motion(random, 0.05);
                    const std::array<double, 4> good = separations(type, motions);
                    (vertex % 2 == 0 ? motions[which].t0 : motions[which].t1)[vertex][1] = bad;
                    const std::array<double, 4> found = separations(type, motions);
                    for (std::size_t k = 0; k < 4; ++k) CHECK(found[k] == (k == which ? 0 : good[k]));
                }
    Motion nowhere;
    nowhere.t0.fill(Vector3(0.3, 0.1, 0.2));
    nowhere.t1 = nowhere.t0;
    for (const PairType type : {PairType::point_triangle, PairType::edge_edge})
        for (const double bound : separations(type, {nowhere, nowhere, nowhere, nowhere})) CHECK(bound == 0);
}

}  // namespace fettle::core::ccd::four_separations_test
