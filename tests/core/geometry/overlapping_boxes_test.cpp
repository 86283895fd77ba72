// SPDX-License-Identifier: MIT
// Tree and sweep against all pairs.
#include "core/geometry/overlapping_boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/base/parallel.hpp"

namespace fettle::core::geometry::overlapping_boxes_test {

namespace {

using Pairs = std::vector<std::pair<int, int>>;

Pairs by_all_pairs(const std::vector<Box>& boxes) {
    Pairs pairs;
    for (int i = 0; i < count_of(boxes); ++i)
        for (int j = i + 1; j < count_of(boxes); ++j)
            if (boxes[i].overlaps(boxes[j])) pairs.emplace_back(i, j);
    return pairs;
}

Pairs by_tree(const std::vector<Box>& boxes) {
    Pairs pairs;
    visit_overlapping_pairs(boxes, [&](int i, int j) {
        pairs.emplace_back(i, j);
        return true;
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// Along a line, in a plane or in space, some of them very large, some alike, some that touch.
std::vector<Box> some_boxes(int count, int dimensions, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-10, 10), size(0.1, 1);
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
        Vector3 low = Vector3::Zero();
        for (int k = 0; k < dimensions; ++k) low[(k + static_cast<int>(seed)) % 3] = place(random);
        Box box{low, low + Vector3(size(random), size(random), size(random))};
        if (i % 50 == 7) box = {Vector3::Constant(-20), Vector3(20, 0, 20)};
        if (i % 10 == 3 && i > 0) box = boxes.back();
        if (i % 10 == 5) box = {boxes.back().high, boxes.back().high + Vector3::Ones()};
        boxes.push_back(box);
    }
    return boxes;
}

TEST_CASE("tree and sweep find every overlapping pair once") {
    std::size_t all = 0;
    for (const int count : {1, 2, 3, 5, 70, 300}) {
        for (const int dimensions : {1, 2, 3}) {
            for (const unsigned seed : {0U, 1U, 2U}) {
                const std::vector<Box> boxes = some_boxes(count, dimensions, seed);
                const Pairs expected = by_all_pairs(boxes);
                all += expected.size();
                CAPTURE(count, dimensions, seed);
                CHECK(by_tree(boxes) == expected);
                for (const int threads : {1, 2, 4}) {
                    const base::ThreadLimit limit(threads);
                    CHECK(overlapping_pairs(boxes, [](int, int) { return true; }) == expected);
                }
            }
        }
    }
    CHECK(all > 10000);
    CHECK(overlapping_pairs({}, [](int, int) { return true; }).empty());
}

TEST_CASE("a sweep leaves out what is not wanted, and asks with the lower index first") {
    const std::vector<Box> boxes = some_boxes(200, 3, 1);
    Pairs expected = by_all_pairs(boxes);
    const auto wanted = [](int a, int b) { return a < b && (a + b) % 3 == 0; };
    expected.erase(std::remove_if(expected.begin(), expected.end(), [&](const auto& pair) { return !wanted(pair.first, pair.second); }),
                   expected.end());
    CHECK(overlapping_pairs(boxes, wanted) == expected);
}

TEST_CASE("a visit ends when it is told to") {
    int calls = 0;
    visit_overlapping_pairs(some_boxes(100, 1, 0), [&](int, int) { return ++calls < 5; });
    CHECK(calls == 5);
}

}  // namespace

}  // namespace fettle::core::geometry::overlapping_boxes_test
