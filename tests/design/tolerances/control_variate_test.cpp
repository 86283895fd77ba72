// SPDX-License-Identifier: MIT
#include "design/tolerances/control_variate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances::control_variate_test {

namespace {

// y = x + noise, x standard normal.
struct Samples {
    VectorX x, y;
};
Samples drawn(std::mt19937_64& random, int n, double noise) {
    std::normal_distribution<double> normal;
    Samples out{VectorX(n), VectorX(n)};
    for (int k = 0; k < n; ++k) {
        out.x[k] = normal(random);
        out.y[k] = 2 + 3 * out.x[k] + noise * normal(random);
    }
    return out;
}

}  // namespace

TEST_CASE("control variate: the mean's interval covers it, and is as narrow as what the control leaves") {
    std::mt19937_64 random(1);
    constexpr int repetitions = 400, n = 200;
    int covered = 0;
    for (int k = 0; k < repetitions; ++k) {
        const Samples samples = drawn(random, n, 0.3);
        const ControlledMean mean = controlled_mean(samples.y, samples.x, 0);
        if (std::abs(mean.mean - 2) <= 1.96 * mean.error) ++covered;
        CHECK(mean.correlation > 0.98);
        CHECK(mean.error < 0.12 * 3 / std::sqrt(n));  // a tenth of what the samples alone have
    }
    CHECK(covered >= 0.92 * repetitions);
    CHECK(covered <= 0.98 * repetitions);
}

TEST_CASE("control variate: a control that explains nothing, and one that does not vary, change nothing") {
    std::mt19937_64 random(2);
    const Samples samples = drawn(random, 500, 0.3);
    const double plain = std::sqrt((samples.y.array() - samples.y.mean()).square().sum() / 499 / 500);
    const ControlledMean constant = controlled_mean(samples.y, VectorX::Ones(500), 1);
    CHECK(constant.mean == samples.y.mean());
    CHECK(constant.error == Approx(plain));
    std::normal_distribution<double> normal;
    const VectorX unrelated = VectorX::NullaryExpr(500, [&] { return normal(random); });
    CHECK(controlled_mean(samples.y, unrelated, 0).error == Approx(plain).epsilon(0.02));
}

TEST_CASE("control variate: the yield's interval covers it at least as often as it says") {
    std::mt19937_64 random(3);
    constexpr int repetitions = 400, n = 500;
    const double limit = 8, noise = 0.05;  // y is normal about 2
    const double truth = normal_probability((limit - 2) / std::hypot(3, noise)), predicted = normal_probability((limit - 2) / 3);
    int covered = 0;
    double width = 0, plain = 0;
    for (int k = 0; k < repetitions; ++k) {
        const Samples samples = drawn(random, n, noise);
        int gained = 0, lost = 0, met = 0;
        for (int i = 0; i < n; ++i) {
            const bool good = samples.y[i] <= limit, wanted = 2 + 3 * samples.x[i] <= limit;
            if (good) ++met;
            if (good && !wanted) ++gained;
            if (!good && wanted) ++lost;
        }
        const CountedYield yield = controlled_yield(predicted, gained, lost, n, 0.95);
        CHECK(yield.found.within == Approx(predicted + (gained - lost) / static_cast<double>(n)));
        if (yield.least.within <= truth && truth <= yield.most.within) ++covered;
        width += yield.most.within - yield.least.within;
        plain += counted_yield(met, n, 0.95).most.within - counted_yield(met, n, 0.95).least.within;
    }
    CHECK(covered >= 0.95 * repetitions);
    CHECK(width < 0.7 * plain);
}

TEST_CASE("control variate: yields stay between 0 and 1") {
    const CountedYield yield = controlled_yield(0.999, 3, 0, 10, 0.95);
    CHECK(yield.found.within == 1);
    CHECK(yield.most.within == 1);
    CHECK(yield.found.outside == 0);
    CHECK(yield.least.within < 1);
}

}  // namespace fettle::design::tolerances::control_variate_test
