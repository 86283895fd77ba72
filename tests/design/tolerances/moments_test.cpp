// SPDX-License-Identifier: MIT
#include "design/tolerances/moments.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances::moments_test {

namespace {

// Uniform in (0, 1), the same on every machine.
class Uniform {
public:
    double operator()() { return (static_cast<double>(random_() >> 12) + 0.5) * 0x1p-52; }

private:
    std::mt19937_64 random_{11};
};

struct Coverage {
    int mean = 0, deviation = 0;
};

// In how many of the repetitions the truth is within 1.96 standard errors.
Coverage covered(const std::function<double(double)>& quantile, double mean, double deviation, int n, int repetitions) {
    Uniform uniform;
    Coverage result;
    VectorX values(n);
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        for (double& x : values) x = quantile(uniform());
        const SampleMoments found = sample_moments(values);
        result.mean += std::abs(found.moments.mean - mean) < 1.96 * found.mean_error;
        result.deviation += std::abs(found.moments.standard_deviation - deviation) < 1.96 * found.standard_deviation_error;
    }
    return result;
}

// 95 of 100, within 3.5 standard deviations of the count.
void check_95(int count, int repetitions) { CHECK(std::abs(count - 0.95 * repetitions) < 3.5 * std::sqrt(0.95 * 0.05 * repetitions)); }

}  // namespace

TEST_CASE("moments: of a small sample, by hand") {
    const SampleMoments found = sample_moments((VectorX(5) << 1, 2, 3, 4, 10).finished());  // deviations -3 -2 -1 0 6
    CHECK(found.moments.mean == 4);
    CHECK(found.moments.standard_deviation == Approx(std::sqrt(12.5)).epsilon(1e-15));
    CHECK(found.moments.third == Approx(180.0 / 5).epsilon(1e-15));
    CHECK(found.moments.fourth == Approx(1394.0 / 5).epsilon(1e-15));
    CHECK(skewness(found.moments) == Approx(36 / std::pow(12.5, 1.5)).epsilon(1e-14));
    CHECK(kurtosis(found.moments) == Approx(278.8 / (12.5 * 12.5)).epsilon(1e-14));
    CHECK(found.mean_error == Approx(std::sqrt(12.5 / 5)).epsilon(1e-15));
    CHECK(found.standard_deviation_error == Approx(std::sqrt((278.8 - 12.5 * 12.5 / 2) / 5) / (2 * std::sqrt(12.5))).epsilon(1e-14));
}

TEST_CASE("moments: an added constant moves the mean alone, and equal values do not vary") {
    VectorX values(50);
    Uniform uniform;
    for (double& x : values) x = std::pow(uniform(), 2);
    const SampleMoments plain = sample_moments(values), moved = sample_moments(VectorX(values.array() + 1e6));
    CHECK(moved.moments.mean - 1e6 == Approx(plain.moments.mean).epsilon(1e-8));
    CHECK(moved.moments.standard_deviation == Approx(plain.moments.standard_deviation).epsilon(1e-8));
    CHECK(moved.moments.third == Approx(plain.moments.third).epsilon(1e-7));
    const SampleMoments same = sample_moments(VectorX::Constant(7, 0.1));
    CHECK(same.moments.mean == 0.1);
    CHECK((same.moments.standard_deviation == 0 && same.mean_error == 0 && same.standard_deviation_error == 0));
    CHECK_THROWS_AS(sample_moments(VectorX::Ones(1)), core::base::ContractError);
}

TEST_CASE("moments: intervals of 1.96 standard errors cover the truth in 95 of 100 samples, normal or not") {
    const int repetitions = 1000;
    const Coverage normal = covered([](double u) { return 3 + 2 * normal_quantile(u); }, 3, 2, 400, repetitions);
    const Coverage uniform = covered([](double u) { return u; }, 0.5, 1 / std::sqrt(12), 400, repetitions);
    const Coverage skewed = covered([](double u) { return std::sqrt(u); }, 2.0 / 3, std::sqrt(1.0 / 18), 400, repetitions);
    for (const Coverage& coverage : {normal, uniform, skewed}) {
        INFO("of " << repetitions << ": mean " << coverage.mean << ", standard deviation " << coverage.deviation);
        check_95(coverage.mean, repetitions);
        check_95(coverage.deviation, repetitions);
    }
}

}  // namespace fettle::design::tolerances::moments_test
