// SPDX-License-Identifier: MIT
#include "core/geometry/close_boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::close_boxes_test {

namespace {

std::vector<Box> random_boxes(int count, const Vector3& scale, const Vector3& shift, std::mt19937_64& random) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
        const Matrix3X x = tests::random_matrix(2, random);
        const Vector3 centre = scale.cwiseProduct(x.col(0)) + shift, half = 0.1 * scale.cwiseProduct(x.col(1)).cwiseAbs();
        boxes.push_back({centre - half, centre + half});
    }
    return boxes;
}

}  // namespace

TEST_CASE("every overlapping pair of boxes is visited once") {
    std::mt19937_64 random(1);
    const Vector3 one = Vector3::Ones(), none = Vector3::Zero();
    std::vector<std::vector<Box>> samples{{},
                                          random_boxes(1, one, none, random),
                                          random_boxes(5, one, none, random),
                                          random_boxes(1000, one, none, random),
                                          random_boxes(300, {1, 1, 0}, {0, 0, 5}, random),
                                          random_boxes(300, {1e-9, 1, 1e9}, {1e6, -1e6, 0}, random),
                                          random_boxes(100, 1e300 * one, none, random),
                                          random_boxes(100, 1e-300 * one, one, random)};
    samples[3].push_back(samples[3][7]);
    for (const std::vector<Box>& boxes : samples) {
        std::multiset<std::pair<int, int>> visited;
        const CloseBoxes close(boxes);
        for (int task = 0; task < close.tasks(); ++task) {
            close.visit_task(task, [&](int i, int j) {
                visited.emplace(std::min(i, j), std::max(i, j));
                return true;
            });
        }
        bool once = true;
        std::size_t overlapping = 0;
        for (int i = 0; i < count_of(boxes); ++i) {
            for (int j = i + 1; j < count_of(boxes); ++j) {
                const bool overlaps = boxes[i].overlaps(boxes[j]);
                overlapping += overlaps ? 1 : 0;
                once = once && visited.count({i, j}) <= 1 && (!overlaps || visited.count({i, j}) == 1);
            }
        }
        CHECK(once);
        if (boxes.size() > 1000) CHECK(visited.size() < overlapping + 20);
    }
}

TEST_CASE("a visit of boxes ends when it is told to") {
    std::mt19937_64 random(2);
    const CloseBoxes close(random_boxes(200, Vector3::Ones(), Vector3::Zero(), random));
    REQUIRE(close.tasks() > 0);
    int calls = 0;
    for (int task = 0; task < close.tasks() && calls == 0; ++task) close.visit_task(task, [&](int, int) { return ++calls < 1; });
    CHECK(calls == 1);
}

}  // namespace fettle::core::geometry::close_boxes_test
