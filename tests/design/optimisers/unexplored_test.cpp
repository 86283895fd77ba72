// SPDX-License-Identifier: MIT
#include "design/optimisers/unexplored.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::optimisers::unexplored_test {

TEST_CASE("what is held or was looked at is explored; of the rest there are orthogonal directions") {
    MatrixX holding(2, 4), steps(1, 4);
    holding << 0, 5, 0, 0,  //
        0, 1, 1e-3, 0;      // the same once more
    steps << 0.2, 0, 0, 0;
    const auto found = unexplored_directions(holding, steps, 4);
    REQUIRE(found.size() == 2);
    for (const VectorX& direction : found) {
        CHECK(direction.norm() == Approx(1));
        CHECK(std::abs(direction[0]) < 1e-9);
        CHECK(std::abs(direction[1]) < 0.1);
    }
    CHECK(std::abs(found[0].dot(found[1])) < 1e-12);
    CHECK(unexplored_directions(holding, steps, 1).size() == 1);
    CHECK(unexplored_directions(MatrixX(0, 4), MatrixX(0, 4), 9).size() == 4);
    CHECK(unexplored_directions(MatrixX::Identity(4, 4), MatrixX(0, 4), 9).empty());
    CHECK(unexplored_directions(MatrixX(0, 4), MatrixX::Identity(4, 4), 9).empty());
}

}  // namespace fettle::design::optimisers::unexplored_test
