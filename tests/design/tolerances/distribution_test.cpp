// SPDX-License-Identifier: MIT
#include "design/tolerances/distribution.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "core/base/contract.hpp"
#include "tests/design/tolerances/quadrature.hpp"

namespace fettle::design::tolerances::distribution_test {

namespace {

using tests::design_support::gauss_legendre, tests::design_support::GaussRule;

// The moments of a density that need not have the integral 1, smooth but at the middle of its range.
Moments integrated(const std::function<double(double)>& density, double from, double to) {
    static const GaussRule rule = gauss_legendre(60);
    const auto integral = [&](const std::function<double(double)>& f) {
        double sum = 0;
        for (const double start : {from, 0.5 * (from + to)})
            for (int i = 0; i < 60; ++i) {
                const double x = start + 0.25 * (to - from) * (1 + rule.nodes[i]);
                sum += rule.weights[i] * f(x) * density(x);
            }
        return sum;
    };
    const double all = integral([](double) { return 1; });
    Moments result;
    result.mean = integral([](double x) { return x; }) / all;
    const auto central = [&](int power) { return integral([&](double x) { return std::pow(x - result.mean, power); }) / all; };
    result.standard_deviation = std::sqrt(central(2));
    result.third = central(3);
    result.fourth = central(4);
    return result;
}

void check_same(const Moments& found, const Moments& expected, double tolerance) {
    const double s = expected.standard_deviation;
    CHECK(std::abs(found.mean - expected.mean) < tolerance * s);
    CHECK(std::abs(found.standard_deviation - s) < tolerance * s);
    CHECK(std::abs(found.third - expected.third) < tolerance * std::pow(s, 3));
    CHECK(std::abs(found.fourth - expected.fourth) < tolerance * std::pow(s, 4));
}

// E[quantile(u)^k] over uniform u: midpoints of many cells.
Moments sampled_moments(const Distribution& d, int cells) {
    VectorX values(cells);
    for (int i = 0; i < cells; ++i) values[i] = quantile(d, (i + 0.5) / cells);
    return sample_moments(values).moments;
}

constexpr DistributionKind all_kinds[] = {DistributionKind::normal, DistributionKind::truncated, DistributionKind::uniform,
                                          DistributionKind::triangular};

}  // namespace

TEST_CASE("distribution: closed forms of symmetric limits") {
    const double w = 0.3e-3;
    const Moments normal = moments_of({DistributionKind::normal, -w, w});
    CHECK(normal.mean == 0);
    CHECK(normal.standard_deviation == Approx(0.1e-3).epsilon(1e-15));
    CHECK(kurtosis(normal) == Approx(3).epsilon(1e-14));
    CHECK(moments_of({DistributionKind::normal, -w, w, 1.5}).standard_deviation == Approx(0.2e-3).epsilon(1e-15));
    const Moments uniform = moments_of({DistributionKind::uniform, -w, w});
    CHECK(uniform.standard_deviation == Approx(w / std::sqrt(3)).epsilon(1e-15));
    CHECK(kurtosis(uniform) == Approx(1.8).epsilon(1e-14));
    const Moments triangular = moments_of({DistributionKind::triangular, -w, w});
    CHECK(triangular.standard_deviation == Approx(w / std::sqrt(6)).epsilon(1e-15));
    CHECK(kurtosis(triangular) == Approx(2.4).epsilon(1e-14));
    // Johnson, Kotz, Balakrishnan: cut at one sigma, the variance is 1 - 2 phi(1) / (2 Phi(1) - 1).
    const Moments cut = moments_of({DistributionKind::truncated, -w, w, 1});
    CHECK(cut.standard_deviation == Approx(w * std::sqrt(1 - 2 * 0.24197072451914337 / 0.6826894921370859)).epsilon(1e-13));
    CHECK(cut.third == 0);
}

TEST_CASE("distribution: moments agree with integrals over the density") {
    for (const double lower : {-1.0, -0.25, 0.0})
        for (const double shift : {0.0, 0.3, -0.45})
            for (const double level : {0.1, 0.5, 1.0, 2.0, 3.0, 4.5}) {
                const double upper = 1, m = 0.5 * (lower + upper), w = 0.5 * (upper - lower), sigma = w / level, c = m + shift * w;
                const auto gauss = [&](double x) { return std::exp(-0.5 * (x - c) * (x - c) / (sigma * sigma)); };
                INFO("lower " << lower << ", shift " << shift << " w, sigma level " << level);
                check_same(moments_of({DistributionKind::truncated, lower, upper, level, shift * w}), integrated(gauss, lower, upper),
                           level < 1 ? 1e-9 : 1e-12);
                check_same(moments_of({DistributionKind::normal, lower, upper, level, shift * w}),
                           integrated(gauss, c - 10 * sigma, c + 10 * sigma), 1e-12);
                check_same(moments_of({DistributionKind::uniform, lower, upper, level, shift * w}),
                           integrated([](double) { return 1; }, c - w, c + w), 1e-12);
                check_same(moments_of({DistributionKind::triangular, lower, upper, level, shift * w}),
                           integrated([&](double x) { return w - std::abs(x - c); }, c - w, c + w), 1e-12);
            }
}

TEST_CASE("distribution: quantiles make samples of the same moments, and rise") {
    for (const DistributionKind kind : all_kinds)
        for (const double shift : {0.0, 0.02, -0.05}) {
            const Distribution d{kind, -0.05, 0.15, 2.5, shift};
            INFO(to_string(kind) << ", shift " << shift);
            check_same(sampled_moments(d, 20'000), moments_of(d), 3e-3);
            double last = -1;
            for (int i = 0; i < 200; ++i) {
                const double x = quantile(d, (i + 0.5) / 200);
                CHECK(x > last);
                last = x;
            }
        }
}

TEST_CASE("distribution: a shift moves normal, uniform and triangular as a whole, and of a truncated one the centre, not the cuts") {
    const double least = 0x1p-53, most = 1 - 0x1p-53, shift = 0.04;
    for (const DistributionKind kind : all_kinds) {
        const Distribution still{kind, -0.1, 0.1, 3, 0}, moved{kind, -0.1, 0.1, 3, shift};
        INFO(to_string(kind));
        if (kind == DistributionKind::truncated) {
            CHECK(quantile(moved, least) == Approx(-0.1).epsilon(1e-9));
            CHECK(quantile(moved, most) == Approx(0.1).epsilon(1e-9));
            const Moments after = moments_of(moved);
            CHECK(after.mean > 0.8 * shift);
            CHECK(after.mean < shift);  // the cut takes more of the upper side
            CHECK(after.third < 0);
            CHECK(after.standard_deviation < moments_of(still).standard_deviation);
            continue;
        }
        for (const double u : {least, 0.001, 0.3, 0.5, 0.9, most}) CHECK(quantile(moved, u) - quantile(still, u) == Approx(shift));
        const Moments before = moments_of(still), after = moments_of(moved);
        CHECK(after.mean - before.mean == Approx(shift).epsilon(1e-14));
        CHECK(after.standard_deviation == before.standard_deviation);
        CHECK(after.third == 0);
        CHECK(after.fourth == before.fourth);
    }
    CHECK(quantile({DistributionKind::uniform, -0.1, 0.1, 3, shift}, most) == Approx(0.14));
    CHECK(quantile({DistributionKind::triangular, -0.1, 0.1, 3, shift}, least) == Approx(-0.06).margin(1e-7));
}

TEST_CASE("distribution: one-sided limits are centred on their middle") {
    const Distribution d{DistributionKind::normal, 0, 0.021e-3};  // H7 at 25 mm
    CHECK(moments_of(d).mean == Approx(0.0105e-3).epsilon(1e-14));
    CHECK(moments_of(d).standard_deviation == Approx(0.0035e-3).epsilon(1e-14));
    CHECK(quantile(d, 0.5) == Approx(0.0105e-3).epsilon(1e-12));
    CHECK(quantile(d, 0.0013498980316300946) == Approx(0).margin(1e-15));  // three sigma
    CHECK(quantile(d, 1 - 0.0013498980316300946) == Approx(0.021e-3).epsilon(1e-12));
}

TEST_CASE("distribution: no width is a constant") {
    for (const DistributionKind kind : all_kinds) {
        const Moments m = moments_of({kind, 0.2, 0.2});
        CHECK((m.mean == 0.2 && m.standard_deviation == 0 && m.third == 0 && m.fourth == 0));
        for (const double u : {1e-9, 0.5, 0.999}) CHECK(quantile({kind, 0.2, 0.2}, u) == 0.2);
        CHECK((skewness(m) == 0 && kurtosis(m) == 3));
    }
}

TEST_CASE("distribution: the extreme coordinates of a Sobol point give finite deviations within the truncated limits") {
    for (const double level : {0.1, 1.0, 3.0, 6.0, 12.0})
        for (const double u : {0x1p-53, 1 - 0x1p-53, 1e-9, 0.5}) {
            const double cut = quantile({DistributionKind::truncated, -0.1, 0.3, level, 0.2}, u);
            CHECK((cut >= -0.1 && cut <= 0.3));
            CHECK(std::abs(quantile({DistributionKind::normal, -0.1, 0.3, level, 0}, u) - 0.1) < 9 * 0.2 / level);
        }
}

TEST_CASE("distribution: faults") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    CHECK(fault_of({DistributionKind::normal, -1, 1}).empty());
    CHECK(fault_of({DistributionKind::normal, -1, 1, 3, 5}).empty());
    CHECK(!fault_of({DistributionKind::normal, 1, -1}).empty());
    CHECK(!fault_of({DistributionKind::normal, -1, infinite}).empty());
    CHECK(!fault_of({DistributionKind::normal, -1, 1, 3, nan}).empty());
    CHECK(!fault_of({DistributionKind::normal, -1, 1, 0}).empty());
    CHECK(fault_of({DistributionKind::normal, -1, 1, 0.01}).empty());
    CHECK(!fault_of({DistributionKind::truncated, -1, 1, 0.01}).empty());
    CHECK(!fault_of({DistributionKind::truncated, -1, 1, 3, 1.5}).empty());
    CHECK_THROWS_AS(moments_of({DistributionKind::uniform, 1, -1}), core::base::ContractError);
    CHECK_THROWS_AS(quantile({DistributionKind::uniform, -1, 1}, 1), core::base::ContractError);
}

}  // namespace fettle::design::tolerances::distribution_test
