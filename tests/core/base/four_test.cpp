// SPDX-License-Identifier: MIT
#include "core/base/four.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::core::base::four_test {

namespace {

template <std::size_t count>
using Numbers = std::array<double, count>;

// 100 j + i is number i of object j.
template <std::size_t count>
bool is_gathered_right() {
    std::array<Numbers<count>, lanes> objects;
    std::array<const Numbers<count>*, lanes> pointers;
    for (std::size_t j = 0; j < lanes; ++j) {
        for (std::size_t i = 0; i < count; ++i) objects[j][i] = static_cast<double>(100 * j + i);
        pointers[j] = &objects[j];
    }
    std::array<Four, count> out;
    gather(pointers, out);
    bool right = true;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < lanes; ++j) right = right && out[i][j] == objects[j][i];
    return right;
}

}  // namespace

TEST_CASE("numbers of four objects are gathered lane by lane") {
    CHECK(is_gathered_right<4>());
    CHECK(is_gathered_right<6>());  // a chart point
    CHECK(is_gathered_right<7>());
    CHECK(is_gathered_right<8>());
    CHECK(is_gathered_right<12>());  // a pose
}

TEST_CASE("what is no number is the largest and the smallest, and stays so") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Four largest = {0, nan, 3, 1}, smallest = {0, nan, 3, 1};
    const Four x = {nan, 5, 2, 4};
    take_larger(x, largest);
    take_smaller(x, smallest);
    for (const Four& y : {largest, smallest}) {
        CHECK(std::isnan(y[0]));
        CHECK(std::isnan(y[1]));
    }
    CHECK((largest[2] == 3 && largest[3] == 4 && smallest[2] == 2 && smallest[3] == 1));
    double one = 1;
    take_larger(nan, one);
    take_larger(2.0, one);
    CHECK(std::isnan(one));
}

TEST_CASE("roots and magnitudes are those of each lane") {
    Four root, size;
    square_root(Four{0, 1, 4, 2}, root);
    magnitude(Four{-0.0, -1, 2, -std::numeric_limits<double>::infinity()}, size);
    CHECK((root[0] == 0 && root[1] == 1 && root[2] == 2 && root[3] == std::sqrt(2.0)));
    CHECK((!std::signbit(size[0]) && size[1] == 1 && size[2] == 2 && size[3] == std::numeric_limits<double>::infinity()));
}

}  // namespace fettle::core::base::four_test
