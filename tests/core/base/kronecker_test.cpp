// SPDX-License-Identifier: MIT
// kronecker.hpp: its numbers in the literature, and how evenly the points lie.
#include "core/base/kronecker.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <utility>

namespace fettle::core::base::kronecker_test {

TEST_CASE("kronecker: the steps are the powers of the generalised golden ratios") {
    // The golden ratio, the plastic number and Roberts' table: 1 / g of dimensions 1, 2, 3 and 4.
    const double ratios[] = {1.6180339887498949, 1.3247179572447460, 1.2207440846057596, 1.1673039782614187};
    for (int n = 1; n <= 4; ++n) {
        const Kronecker points(n);
        for (int k = 0; k < n; ++k) {
            CHECK(points.at(0, static_cast<std::size_t>(k)) == 0.5);
            const double first = 0.5 + std::pow(ratios[n - 1], -(k + 1));
            CHECK(points.at(1, static_cast<std::size_t>(k)) == Approx(first - std::floor(first)).epsilon(1e-14));
        }
    }
}

TEST_CASE("kronecker: in one dimension each point falls in the widest gap, in more all parts of the cube have their share") {
    std::set<double> seen{0.0, 1.0};
    const Kronecker line(1);
    for (int i = 0; i < 200; ++i) seen.insert(line.at(i, 0));
    double widest = 0, last = 0;
    for (const double x : seen) widest = std::max(widest, x - std::exchange(last, x));
    CHECK(widest < 2.7 / 200);  // the three-gap theorem: at most g^2 times the mean
    const Kronecker cube(4);
    int counts[16] = {};
    for (int i = 0; i < 1600; ++i) {
        int part = 0;
        for (std::size_t k = 0; k < 4; ++k) part = 2 * part + (cube.at(i, k) < 0.5 ? 0 : 1);
        ++counts[part];
    }
    for (const int count : counts) CHECK(std::abs(count - 100) < 15);
}

}  // namespace fettle::core::base::kronecker_test
