// SPDX-License-Identifier: MIT
#include "design/session/least_change.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace fettle::design::session::least_change_test {

TEST_CASE("least change: one slope, by hand") {
    // In ranges (10, 1) the slopes are 20 and 1: the step is 4 / 401 of them.
    const LeastChange least = least_change(Vector2(5, 0.5), Vector2(0, 0), Vector2(10, 1), Vector2(2, 1), 4);
    CHECK(least.reaches);
    CHECK(least.change == Approx(4));
    CHECK(least.values[0] == Approx(5 + 4 * 20 * 10 / 401.0));
    CHECK(least.values[1] == Approx(0.5 + 4 / 401.0));
}

TEST_CASE("least change: what bounds do not allow is told, and as much is done as they do") {
    const LeastChange least = least_change(Vector2(5, 0.5), Vector2(0, 0), Vector2(10, 1), Vector2(2, 1), 100);
    CHECK_FALSE(least.reaches);
    CHECK(least.values == Vector2(10, 1));
    CHECK(least.change == Approx(10.5));
    const LeastChange flat = least_change(Vector2(5, 0.5), Vector2(0, 0), Vector2(10, 1), Vector2(0, 0), 1);
    CHECK_FALSE(flat.reaches);
    CHECK(flat.values == Vector2(5, 0.5));
    CHECK(least_change(Vector2(5, 0.5), Vector2(0, 0), Vector2(10, 1), Vector2(0, 0), 0).reaches);
}

// The oracle: of random feasible values none that changes as much is nearer.
TEST_CASE("least change: nothing nearer changes as much") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int trial = 0; trial < 200; ++trial) {
        constexpr Eigen::Index n = 4;
        VectorX lower(n), upper(n), at(n), gradient(n);
        for (Eigen::Index k = 0; k < n; ++k) {
            lower[k] = 10 * unit(random) - 5;
            upper[k] = lower[k] + (k == 3 && trial % 5 == 0 ? 0 : 0.1 + 5 * unit(random));
            at[k] = lower[k] + (upper[k] - lower[k]) * (trial % 3 == 0 && k == 0 ? 1 : unit(random));
            gradient[k] = trial % 7 == 0 && k == 1 ? 0 : 4 * unit(random) - 2;
        }
        const auto far = [&](double sign) {
            double most = 0;
            for (Eigen::Index k = 0; k < n; ++k)
                most += std::max(sign * gradient[k] * (upper[k] - at[k]), sign * gradient[k] * (lower[k] - at[k]));
            return sign * most;
        };
        const double sign = trial % 2 == 0 ? 1 : -1, wanted = 0.9 * unit(random) * far(sign);
        const LeastChange least = least_change(at, lower, upper, gradient, wanted);
        CHECK(least.reaches);
        CHECK(gradient.dot(least.values - at) == Approx(wanted).margin(1e-12));
        CHECK((least.values.array() >= lower.array()).all());
        CHECK((least.values.array() <= upper.array()).all());
        const auto distance = [&](const VectorX& p) {
            double sum = 0;
            for (Eigen::Index k = 0; k < n; ++k)
                if (upper[k] > lower[k]) sum += std::pow((p[k] - at[k]) / (upper[k] - lower[k]), 2);
            return sum;
        };
        for (int other = 0; other < 200; ++other) {
            VectorX p(n);
            for (Eigen::Index k = 0; k < n; ++k) p[k] = lower[k] + (upper[k] - lower[k]) * unit(random);
            const double change = gradient.dot(p - at);
            // What changes more, towards the wanted side, can be shortened to change as much, and is nearer then.
            if (sign * change >= sign * wanted) CHECK(distance(p) >= distance(least.values) * (1 - 1e-12));
        }
    }
}

}  // namespace fettle::design::session::least_change_test
