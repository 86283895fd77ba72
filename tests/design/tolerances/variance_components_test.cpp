// SPDX-License-Identifier: MIT
// Against tables, restricted likelihood, and how often made-up groups have the truth within the intervals.
#include "design/tolerances/variance_components.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace fettle::design::tolerances::variance_components_test {

namespace {

class Normal {
public:
    double operator()() {
        const double u = (static_cast<double>(random_()) + 0.5) / 4294967296.0, v = static_cast<double>(random_()) / 4294967296.0;
        return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
    }

private:
    std::mt19937 random_{11};
};

bool holds(const Interval& interval, double truth) { return interval.least <= truth && truth <= interval.most; }

}  // namespace

TEST_CASE("variance components: quantiles of tables") {
    CHECK(chi_square_quantile(4, 0.05) == Approx(0.7107230));
    CHECK(chi_square_quantile(1, 0.975) == Approx(5.0238862));
    CHECK(f_quantile(4, 10, 0.975) == Approx(4.4683).epsilon(1e-4));
    CHECK(f_quantile(2, 12, 0.95) == Approx(3.8853).epsilon(1e-4));
    CHECK(f_quantile(10, 4, 0.025) == Approx(1 / 4.4683).epsilon(1e-4));
}

// Mean squares of 5 groups of 4, worked out by hand from F(4, 15): 97.5% 3.8043, 2.5% 0.115459 (= 1 / 8.6565, F(15, 4)); chi2(4): 97.5%
// 11.14329, 2.5% 0.484419.
TEST_CASE("variance components: a layout worked out by hand") {
    const VarianceComponents found = variance_components({9, 1, 4, 15, 4});
    CHECK(found.between.value == Approx(std::sqrt(2.0)));
    CHECK(found.between.least == Approx(std::sqrt(4 * (9 - 3.8043) / (4 * 11.14329))).epsilon(1e-4));
    CHECK(found.between.most == Approx(std::sqrt(4 * (9 - 0.115459) / (4 * 0.484419))).epsilon(1e-3));
    CHECK(found.share.value == Approx(2.0 / 3));
    CHECK(found.share.least == Approx((9 / 3.8043 - 1) / (3 + 9 / 3.8043)).epsilon(1e-4));
    CHECK(found.share.most == Approx((9 / 0.115459 - 1) / (3 + 9 / 0.115459)).epsilon(1e-3));
    CHECK(found.total == Approx(std::sqrt(3.0)));
    // Groups that differ by less than chance; by nothing; nothing but groups.
    const VarianceComponents none = variance_components({0.5, 1, 4, 15, 4});
    CHECK(none.between.value == 0);
    CHECK(none.between.least == 0);
    CHECK(none.between.most > 0);
    CHECK(none.share.value == 0);
    CHECK(none.total == 1);
    CHECK(variance_components({0, 0, 1, 2, 3}).total_bound == 0);
    CHECK(variance_components({1, 0, 1, 2, 3}).share.value == 1);
}

// REML of a balanced layout is that of the mean squares where these are in order: the restricted likelihood, on a grid, has its top there.
TEST_CASE("variance components: the restricted likelihood has its top there") {
    constexpr int groups = 6, n = 5;
    Normal normal;
    double y[groups][n], mean[groups] = {}, all = 0;
    for (int p = 0; p < groups; ++p) {
        const double u = 1.5 * normal();
        for (double& each : y[p]) {
            each = u + normal();
            mean[p] += each / n;
        }
        all += mean[p] / groups;
    }
    double between = 0, within = 0;
    for (int p = 0; p < groups; ++p) {
        between += n * (mean[p] - all) * (mean[p] - all) / (groups - 1);
        for (const double each : y[p]) within += (each - mean[p]) * (each - mean[p]) / (groups * (n - 1));
    }
    const VarianceComponents found = variance_components({between, within, groups - 1, groups * (n - 1), n});
    REQUIRE(found.between.value > 0);
    // -2 log L of error contrasts: means have variance l / n with l = W + n B, members about them W.
    const auto likelihood = [&](double b, double w) {
        const double l = w + n * b;
        return (groups - 1) * std::log(l) + (groups - 1) * between / l + groups * (n - 1) * (std::log(w) + within / w);
    };
    const double b = found.between.value * found.between.value, w = found.total * found.total - b, best = likelihood(b, w);
    for (const double db : {0.98, 1.0, 1.02})
        for (const double dw : {0.98, 1.0, 1.02}) CHECK(likelihood(b * db, w * dw) >= best - 1e-12);
}

TEST_CASE("variance components: intervals hold the truth in 95 of 100 layouts") {
    const int trials = 4000;
    struct Case {
        int groups, n;
        double between;
    };
    for (const auto& [groups, n, b] : {Case{3, 6, 1.0}, Case{5, 6, 0.5}, Case{5, 6, 0.0}, Case{8, 4, 2.0}}) {
        INFO(groups << " groups of " << n << ", " << b);
        Normal normal;
        int between = 0, share = 0, bound = 0;
        for (int trial = 0; trial < trials; ++trial) {
            double mean_square = 0, within = 0, all = 0, squares = 0;
            for (int p = 0; p < groups; ++p) {
                const double u = b * normal();
                double mean = 0, own = 0;
                for (int i = 0; i < n; ++i) {
                    const double y = u + normal();
                    mean += y / n;
                    own += y * y;
                }
                within += own - n * mean * mean;
                all += mean / groups;
                squares += mean * mean;
            }
            mean_square = n * (squares - groups * all * all) / (groups - 1);
            const VarianceComponents found =
                variance_components({mean_square, within / (groups * (n - 1)), groups - 1, groups * (n - 1), static_cast<double>(n)});
            between += holds(found.between, b);
            share += holds(found.share, b * b / (b * b + 1));
            bound += found.total_bound >= std::hypot(b, 1);
        }
        const double noise = 3 * std::sqrt(0.95 * 0.05 / trials);
        // Where nothing differs, its interval holds 0 unless the whole of it lies above: 97.5 of 100.
        CHECK(share / double(trials) == Approx(b == 0 ? 0.975 : 0.95).margin(noise));
        CHECK(between / double(trials) > 0.95 - noise);
        CHECK(between / double(trials) < 0.985);
        CHECK(bound / double(trials) > 0.95 - noise);
        CHECK(bound / double(trials) < 0.99);
    }
}

}  // namespace fettle::design::tolerances::variance_components_test
