// SPDX-License-Identifier: MIT
#include "design/tolerances/sobol.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "core/base/contract.hpp"
#include "core/files/hash.hpp"

namespace fettle::design::tolerances::sobol_test {

namespace {

using Coordinate = std::function<double(std::uint32_t k, int d)>;

// How many of the first `points` points lie in each of the boxes that halvings[d] halvings of coordinate d make; whether all have the same.
bool fills_evenly(const Coordinate& coordinate, int points, const std::vector<std::pair<int, int>>& halvings) {
    int boxes = 1;
    for (const auto& [d, times] : halvings) boxes <<= times;
    std::vector<int> counts(static_cast<size_t>(boxes), 0);
    for (int k = 0; k < points; ++k) {
        int box = 0;
        for (const auto& [d, times] : halvings)
            box = (box << times) + static_cast<int>(std::ldexp(coordinate(static_cast<std::uint32_t>(k), d), times));
        ++counts[static_cast<size_t>(box)];
    }
    return std::all_of(counts.begin(), counts.end(), [&](int count) { return count == points / boxes; });
}

double before(const SobolPoints& points, std::uint32_t k, int d) { return points.unscrambled(k, d) * 0x1p-32; }

MatrixX first_points(const SobolPoints& points, int count) {
    MatrixX result(points.dimension(), count);
    for (int k = 0; k < count; ++k) result.col(k) = points.point(static_cast<std::uint32_t>(k));
    return result;
}

// A function of integral 1 over the cube, with terms in each, two and all coordinates together.
double smooth(const VectorX& u) {
    double product = 1, sum = 0;
    for (const double x : u) {
        product *= 1 + 0.5 * (std::exp(x) - (std::exp(1.0) - 1));
        sum += x - 0.5;
    }
    return product + std::sin(sum);
}

// Root mean square, over repetitions, of the error of the average.
double sobol_error(int points, int repetitions) {
    double square = 0;
    for (int seed = 0; seed < repetitions; ++seed) {
        const SobolPoints sequence(10, static_cast<std::uint64_t>(seed));
        double sum = 0;
        for (int k = 0; k < points; ++k) sum += smooth(sequence.point(static_cast<std::uint32_t>(k))) - 1;
        square += sum * sum / (double(points) * points);
    }
    return std::sqrt(square / repetitions);
}

double random_error(int points, int repetitions) {
    std::mt19937_64 random(5);
    double square = 0;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        double sum = 0;
        for (int k = 0; k < points; ++k) {
            VectorX u(10);
            for (double& x : u) x = static_cast<double>(random() >> 11) * 0x1p-53;
            sum += smooth(u) - 1;
        }
        square += sum * sum / (double(points) * points);
    }
    return std::sqrt(square / repetitions);
}

}  // namespace

TEST_CASE("sobol: the first points are those of the literature") {
    // Joe and Kuo's generator prints, for three dimensions, 0 0 0; .5 .5 .5; .75 .25 .25; .25 .75 .75; .375 .375 .625; ... in Gray code
    // order: 0, 1, 3, 2, 6, 7, 5, 4.
    const SobolPoints points(3, 0);
    const double expected[8][3] = {{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375}};
    for (std::uint32_t j = 0; j < 8; ++j)
        for (int d = 0; d < 3; ++d) CHECK(before(points, j ^ j >> 1, d) == expected[j][d]);
}

TEST_CASE("sobol: each coordinate's first 2^m points have one in each dyadic interval, before and after scrambling") {
    for (const std::uint64_t seed : {0, 17}) {
        const SobolPoints points(200, seed);
        const MatrixX after = first_points(points, 1024);
        for (int d = 0; d < 200; ++d)
            for (int m = 0; m <= 10; ++m) {
                const std::vector<std::pair<int, int>> intervals{{d, m}};
                REQUIRE(fills_evenly([&](std::uint32_t k, int c) { return before(points, k, c); }, 1 << m, intervals));
                REQUIRE(fills_evenly([&](std::uint32_t k, int c) { return after(c, k); }, 1 << m, intervals));
            }
    }
}

TEST_CASE("sobol: the first two coordinates are a (0, m, 2)-net, the first three a (1, m, 3)-net, before and after scrambling") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const SobolPoints points(3, seed);
        const MatrixX after = first_points(points, 1024);
        const Coordinate coordinates[] = {[&](std::uint32_t k, int d) { return before(points, k, d); },
                                          [&](std::uint32_t k, int d) { return after(d, k); }};
        for (const Coordinate& coordinate : coordinates)
            for (int m = 0; m <= 10; ++m)
                for (int a = 0; a <= m; ++a) {
                    CHECK(fills_evenly(coordinate, 1 << m, {{0, a}, {1, m - a}}));
                    for (int b = 0; a + b < m; ++b) CHECK(fills_evenly(coordinate, 1 << m, {{0, a}, {1, b}, {2, m - 1 - a - b}}));
                }
    }
}

TEST_CASE("sobol: blocks of 2^m points that begin at a multiple of 2^m are nets too") {
    const SobolPoints points(2, 9);
    for (const std::uint32_t first : {64u, 4096u, 0xffffffc0u})
        for (int a = 0; a <= 6; ++a)
            CHECK(fills_evenly([&](std::uint32_t k, int d) { return points.point(first + k)[d]; }, 64, {{0, a}, {1, 6 - a}}));
}

TEST_CASE("sobol: points lie inside of the cube, and are the same on every machine") {
    const SobolPoints points(200, 2026);
    core::files::Fnv1a hash;
    for (const std::uint32_t k : {0u, 1u, 2u, 1023u, 0x80000000u, 0xffffffffu}) {
        const VectorX point = points.point(k);
        CHECK((point.minCoeff() >= 0x1p-53 && point.maxCoeff() <= 1 - 0x1p-53));
        for (const double x : point) hash.add(x);
    }
    CHECK(core::files::hexadecimal(hash.value()) == "8564c5159c7ae1b1");
    // Fewer dimensions are the first coordinates of more.
    CHECK(SobolPoints(7, 2026).point(77) == points.point(77).head(7));
}

TEST_CASE("sobol: different seeds are independent") {
    const MatrixX first = first_points(SobolPoints(10, 1), 256), second = first_points(SobolPoints(10, 2), 256);
    CHECK((first.array() != second.array()).all());
    // Over seeds, point 0 is uniform, and coordinates and neighbouring seeds are uncorrelated.
    const int seeds = 4000;
    MatrixX z(4, seeds);
    for (int seed = 0; seed < seeds; ++seed)
        z.col(seed) = (SobolPoints(4, static_cast<std::uint64_t>(seed)).point(0).array() - 0.5) * std::sqrt(12.0);
    const double error = 1 / std::sqrt(double(seeds));
    for (int d = 0; d < 4; ++d) {
        CHECK(std::abs(z.row(d).mean()) < 4 * error);
        CHECK(std::abs(z.row(d).squaredNorm() / seeds - 1) < 4 * error);
        CHECK(std::abs(z.row(d).head(seeds - 1).dot(z.row(d).tail(seeds - 1)) / seeds) < 4 * error);
        for (int c = 0; c < d; ++c) CHECK(std::abs(z.row(c).dot(z.row(d)) / seeds) < 4 * error);
    }
}

TEST_CASE("sobol: averages of a smooth function of ten variables converge faster than those of random points, without bias") {
    const double few = sobol_error(64, 30), many = sobol_error(4096, 30);
    const double rate = std::log(many / few) / std::log(4096.0 / 64.0);
    const double random_many = random_error(4096, 30);
    INFO("errors " << few << " with 64 points, " << many << " with 4096: n^" << rate << "; of random points " << random_many);
    CHECK(rate < -0.8);
    CHECK(many < 0.1 * random_many);
}

TEST_CASE("sobol: contracts") {
    CHECK_THROWS_AS(SobolPoints(0, 1), core::base::ContractError);
    CHECK_THROWS_AS(SobolPoints(3668, 1), core::base::ContractError);
    CHECK(SobolPoints(3667, 1).dimension() == 3667);
}

}  // namespace fettle::design::tolerances::sobol_test
