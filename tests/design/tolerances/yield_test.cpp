// SPDX-License-Identifier: MIT
#include "design/tolerances/yield.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances::yield_test {

namespace {

using core::base::infinity;

// Probability of `count` successes of n.
double binomial(int count, int n, double p) {
    return std::exp(std::lgamma(n + 1.0) - std::lgamma(count + 1.0) - std::lgamma(n - count + 1.0) + count * std::log(p) +
                    (n - count) * std::log1p(-p));
}

double binomial_sum(int from, int to, int n, double p) {
    double sum = 0;
    for (int count = from; count <= to; ++count) sum += binomial(count, n, p);
    return sum;
}

// A gamma distribution of integer shape, as a sum of exponentials: P(x <= t) = 1 - exp(-t) sum t^k / k!.
double gamma_probability(int shape, double t) {
    double term = 1, sum = 1;
    for (int k = 1; k < shape; ++k) sum += term *= t / k;
    return 1 - std::exp(-t) * sum;
}

Moments gamma_moments(int shape) {
    const double a = shape;
    return {a, std::sqrt(a), 2 * a, 3 * a * a + 6 * a};
}

}  // namespace

TEST_CASE("yield: normal, against tables, with both limits, one and none") {
    CHECK(ppm_outside(normal_yield(5, 2, {-1, 11})) == Approx(2699.796063).epsilon(1e-9));                  // three sigma
    CHECK(ppm_outside(normal_yield(0, 1, {-6, 6})) == Approx(1.973175290e-3).epsilon(1e-9));                // six
    CHECK(ppm_outside(normal_yield(0, 1, {-7.5, 4.5})) == Approx(3.3976731247 + 3.1909e-8).epsilon(1e-9));  // six, 1.5 off
    CHECK(ppm_outside(normal_yield(0, 1, {-infinity, 3})) == Approx(1349.898032).epsilon(1e-9));
    CHECK(ppm_outside(normal_yield(0, 1, {-3, infinity})) == Approx(1349.898032).epsilon(1e-9));
    const Yield all = normal_yield(0, 1, {});
    CHECK((all.within == 1 && all.outside == 0));
    CHECK(normal_yield(0, 1, {20, 21}).within == Approx(2.7536241186e-89).epsilon(1e-8));  // small yields are exact too
    CHECK(normal_yield(0, 1, {-21, -20}).within == Approx(2.7536241186e-89).epsilon(1e-8));
}

TEST_CASE("yield: of what does not vary") {
    CHECK(normal_yield(1, 0, {0, 1}).within == 1);
    CHECK(normal_yield(1.1, 0, {0, 1}).outside == 1);
    CHECK(cornish_fisher_yield({1, 0, 0, 0}, {0, 1})->within == 1);
}

TEST_CASE("yield: the ends of the counted interval are what Clopper and Pearson ask for") {
    for (const auto& [x, n] : {std::pair{19, 20}, {3, 7}, {1, 400}, {1995, 2000}})
        for (const double confidence : {0.8, 0.95, 0.999}) {
            const CountedYield counted = counted_yield(x, n, confidence);
            INFO(x << " of " << n << " at " << confidence);
            CHECK(counted.found.within == double(x) / n);
            CHECK(binomial_sum(x, n, n, counted.least.within) == Approx((1 - confidence) / 2).epsilon(1e-8));
            CHECK(binomial_sum(0, x, n, counted.most.within) == Approx((1 - confidence) / 2).epsilon(1e-8));
            CHECK(counted.least.within + counted.least.outside == Approx(1));
            CHECK(counted.most.within + counted.most.outside == Approx(1));
        }
    // All within: the "rule of three".
    const CountedYield all = counted_yield(2000, 2000, 0.95), none = counted_yield(0, 2000, 0.95);
    CHECK((all.found.within == 1 && all.most.within == 1 && all.most.outside == 0));
    CHECK(all.least.outside == Approx(1 - std::pow(0.025, 1 / 2000.0)).epsilon(1e-9));
    CHECK((none.least.within == 0 && none.most.within == Approx(all.least.outside).epsilon(1e-9)));
    CHECK_THROWS_AS(counted_yield(5, 4, 0.95), core::base::ContractError);
}

TEST_CASE("yield: the counted interval covers the truth in 95 of 100 samples or more, by the sum over all counts") {
    for (const int n : {10, 100, 500})
        for (const double p : {0.5, 0.9, 0.99, 0.997}) {
            double covered = 0;
            for (int x = 0; x <= n; ++x) {
                const CountedYield counted = counted_yield(x, n, 0.95);
                if (counted.least.within <= p && p <= counted.most.within) covered += binomial(x, n, p);
            }
            INFO("n " << n << ", yield " << p << ": covered " << covered);
            CHECK(covered >= 0.95);
            CHECK((p * n < n - 5 ? covered < 0.99 : covered <= 1 + 1e-9));  // and not much more, where the count can vary
        }
}

TEST_CASE("yield: Cornish and Fisher's expansion of normal moments is the normal one") {
    const Moments normal{2, 0.5, 0, 3 * 0.0625};
    for (const RequirementLimits& limits : {RequirementLimits{1, 3.2}, {1.9, infinity}, {-infinity, 0}, {}, {-60, 80}}) {
        const std::optional<Yield> found = cornish_fisher_yield(normal, limits);
        REQUIRE(found);
        const Yield expected = normal_yield(2, 0.5, limits);
        CHECK(found->outside == Approx(expected.outside).epsilon(1e-12));
        CHECK(found->within == Approx(expected.within).epsilon(1e-12));
    }
}

TEST_CASE("yield: Cornish and Fisher's expansion of a skewed distribution is nearer than the normal one") {
    for (const int shape : {20, 60, 300}) {
        const Moments y = gamma_moments(shape);
        for (const double sigmas : {-2.5, -1.0, 1.0, 2.0, 3.0}) {
            const double limit = y.mean + sigmas * y.standard_deviation, truth = 1 - gamma_probability(shape, limit);
            const std::optional<Yield> found = cornish_fisher_yield(y, {-infinity, limit});
            INFO("shape " << shape << ", " << sigmas << " sigma");
            REQUIRE(found);
            const double error = std::abs(found->outside - truth),
                         normal_error = std::abs(normal_yield(y.mean, y.standard_deviation, {-infinity, limit}).outside - truth);
            CHECK(error < 0.2 * normal_error);
            CHECK(error < 0.04 * std::min(truth, 1 - truth));
        }
    }
}

TEST_CASE("yield: a solved limit is one that the expansion takes") {
    const double s = -0.4, k = 0.5;
    const Moments y{0, 1, s, 3 + k};
    for (const double z : {-3.0, -1.2, 0.1, 1.0, 2.2}) {
        const double w = z + s * (z * z - 1) / 6 + k * (z * z * z - 3 * z) / 24 - s * s * (2 * z * z * z - 5 * z) / 36;
        CHECK(cornish_fisher_yield(y, {w, infinity})->outside == Approx(normal_probability(z)).epsilon(1e-10));
        CHECK(cornish_fisher_yield(y, {-infinity, w})->within == Approx(normal_probability(z)).epsilon(1e-10));
    }
}

TEST_CASE("yield: where the expansion does not rise there is no answer") {
    // Strong skewness with the tails of a normal: w turns back at z = -1.6 and 2.4.
    const Moments skewed{0, 1, 1.5, 3};
    CHECK(!cornish_fisher_yield(skewed, {-2, infinity}));
    CHECK(!cornish_fisher_yield(skewed, {-infinity, 4}));
    CHECK(cornish_fisher_yield(skewed, {-infinity, 0.5}));
    // Not even at 0: w'(0) = 1 - K / 8.
    CHECK(!cornish_fisher_yield({0, 1, 0, 12}, {-1, 1}));
    // It turns back far out only: what lies beyond is less than a double shows.
    const Moments slightly{0, 1, 0.1, 3};
    CHECK(cornish_fisher_yield(slightly, {-30, 60})->outside < 1e-15);
}

}  // namespace fettle::design::tolerances::yield_test
