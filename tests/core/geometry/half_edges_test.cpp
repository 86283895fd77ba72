// SPDX-License-Identifier: MIT
#include "core/geometry/half_edges.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tuple>

#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::half_edges_test {

namespace {

/// Some corners equal, some edges in many triangles; indices from `first`, `step` apart.
std::vector<Triangle> random_triangles(int count, int vertices, int first, int step, std::mt19937_64& random) {
    std::uniform_int_distribution<int> vertex(0, vertices - 1);
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        Triangle t{};
        for (int& v : t) v = first + step * vertex(random);
        triangles.push_back(t);
    }
    return triangles;
}

std::vector<std::vector<Triangle>> samples() {
    std::mt19937_64 random(1);
    std::vector<std::vector<Triangle>> out{{}, {{3, 3, 3}}, {{0, 1, 2}}, tests::torus_mesh(2, 0.5, 20).triangles};
    for (const int vertices : {4, 30, 2000}) out.push_back(random_triangles(300, vertices, 0, 1, random));
    out.push_back(random_triangles(300, 40, -20, 1, random));                       // out of range of any mesh
    out.push_back(random_triangles(300, 1000, -1'000'000'000, 2'000'000, random));  // far too thin to be counted
    std::vector<Triangle> fan;
    for (int i = 1; i < 500; ++i) fan.push_back({0, 1 + (7 * i) % 499, 1 + (7 * i + 7) % 499});
    out.push_back(fan);
    return out;
}

std::pair<int, int> ends(const Triangle& t, std::size_t k) { return std::minmax(int{t[k]}, int{t[(k + 1) % 3]}); }

}  // namespace

TEST_CASE("half edges stand by edge, triangle and corner") {
    for (const std::vector<Triangle>& triangles : samples()) {
        std::vector<std::tuple<int, int, int, int, bool>> expected;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [low, high] = ends(triangles[t], k);
                expected.emplace_back(low, high, static_cast<int>(t), static_cast<int>(k), triangles[t][k] < triangles[t][(k + 1) % 3]);
            }
        }
        std::sort(expected.begin(), expected.end());
        const std::vector<HalfEdge> halves = sorted_half_edges(triangles);
        REQUIRE(halves.size() == expected.size());
        bool same = true;
        for (std::size_t i = 0; i < halves.size(); ++i) {
            const auto& [low, high, triangle, corner, forward] = expected[i];
            same = same && halves[i].low == low && halves[i].high == high && halves[i].triangle == triangle && halves[i].forward == forward;
        }
        CHECK(same);
    }
}

TEST_CASE("edges of triangles are numbered as they first appear") {
    for (const std::vector<Triangle>& triangles : samples()) {
        const TriangleEdges found = triangle_edges(triangles);
        std::map<std::pair<int, int>, int> number;
        std::vector<Edge> edges;
        std::vector<int> of_side;
        for (const Triangle& t : triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (t[k] == t[(k + 1) % 3]) {
                    of_side.push_back(-1);
                    continue;
                }
                const auto [at, fresh] = number.try_emplace(ends(t, k), count_of(edges));
                if (fresh) edges.push_back({t[k], t[(k + 1) % 3]});
                of_side.push_back(at->second);
            }
        }
        CHECK(found.edges == edges);
        CHECK(found.of_side == of_side);
        CHECK(count_edges(sorted_half_edges(triangles)) == edges.size());
    }
}

TEST_CASE("edges are found by their ends, the last of equal ones") {
    for (const std::vector<Triangle>& triangles : samples()) {
        std::vector<Edge> edges;
        for (const Triangle& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});  // most of them twice
        std::map<std::pair<int, int>, int> expected;
        for (std::size_t e = 0; e < edges.size(); ++e) expected[std::minmax(edges[e][0], edges[e][1])] = static_cast<int>(e);
        const EdgeIndex index(edges);
        bool right = true;
        for (const Edge& edge : edges) {
            for (const int shift : {0, 1}) {
                const auto at = expected.find(std::minmax(edge[0] + shift, edge[1]));
                const int wanted = at == expected.end() ? -1 : at->second;
                right = right && index.find(edge[0] + shift, edge[1]) == wanted && index.find(edge[1], edge[0] + shift) == wanted;
            }
        }
        CHECK(right);
        CHECK(index.find(2'000'000'000, 2'000'000'001) == -1);
        CHECK(index.find(-2'000'000'000, 5) == -1);
    }
}

}  // namespace fettle::core::geometry::half_edges_test
