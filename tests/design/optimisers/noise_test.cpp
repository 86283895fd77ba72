// SPDX-License-Identifier: MIT
#include "design/optimisers/noise.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace fettle::design::optimisers::noise_test {

namespace {

constexpr double unit_rounding = std::numeric_limits<double>::epsilon() / 2;

VectorX sampled(const std::function<double(double)>& f, double from, double spacing, int points) {
    VectorX values(points);
    for (int i = 0; i < points; ++i) values[i] = f(from + i * spacing);
    return values;
}

// Uniform in [-a, a] has the standard deviation a / sqrt(3).
class UniformNoise {
public:
    explicit UniformNoise(double deviation) : width_(std::sqrt(3.0) * deviation) {}
    double operator()() { return width_ * uniform_(random_); }

private:
    double width_;
    std::mt19937_64 random_{7};
    std::uniform_real_distribution<double> uniform_{-1, 1};
};

}  // namespace

TEST_CASE("noise: a sine with uniform noise gives back its standard deviation, over decades") {
    for (double deviation = 1e-12; deviation < 1e-3; deviation *= 10) {
        UniformNoise noise(deviation);
        int detected = 0, within_factor_four = 0, above = 0;
        for (int trial = 0; trial < 400; ++trial) {
            const VectorX values = sampled([&](double t) { return std::sin(t) + noise(); }, 0.3 + 0.01 * trial, 1e-2, 9);
            const NoiseLevel found = estimate_noise(values, 1e-2);
            if (found.status != NoiseStatus::detected) continue;
            ++detected;
            within_factor_four += found.noise > deviation / 4 && found.noise < 4 * deviation;
            above += found.noise > deviation;
        }
        INFO("sigma " << deviation << ": detected " << detected << ", within a factor of four " << within_factor_four << ", above "
                      << above);
        CHECK(detected > 360);
        CHECK(within_factor_four > 0.95 * detected);
        CHECK((above > 0.3 * detected && above < 0.7 * detected));  // no bias to either side
    }
}

TEST_CASE("noise: five values still tell its order of magnitude") {
    UniformNoise noise(1e-6);
    int detected = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const NoiseLevel found = estimate_noise(sampled([&](double t) { return std::exp(t) + noise(); }, 0.01 * trial, 1e-5, 5), 1e-5);
        if (found.status != NoiseStatus::detected) continue;
        ++detected;
        CHECK((found.noise > 1e-7 && found.noise < 1e-5));
    }
    CHECK(detected > 200);
}

TEST_CASE("noise: an added constant and a factor change nothing but the unit") {
    UniformNoise noise(1e-5);
    const VectorX values = sampled([&](double t) { return std::cos(t) + noise(); }, 0, 1e-3, 7);
    const NoiseLevel plain = estimate_noise(values, 1e-3), shifted = estimate_noise(VectorX(values.array() - values[3]), 1e-3),
                     scaled = estimate_noise(VectorX(-1000 * values), 1e-3);
    REQUIRE(plain.status == NoiseStatus::detected);
    CHECK(shifted.status == NoiseStatus::detected);
    CHECK(shifted.noise == Approx(plain.noise).epsilon(1e-9));
    CHECK(scaled.status == NoiseStatus::detected);
    CHECK(scaled.noise == Approx(1000 * plain.noise).epsilon(1e-9));
}

TEST_CASE("noise: a polynomial has that of its rounding, once the spacing lets it show") {
    const auto polynomial = [](double t) { return ((0.7 * t - 1.1) * t + 0.3) * t + 1.9; };
    const NoiseLevel found = estimate_noise(sampled(polynomial, 0.4, 1e-4, 9), 1e-4);
    CHECK(found.status == NoiseStatus::detected);
    CHECK(found.noise > 0);
    CHECK(found.noise < 4 * unit_rounding);
    // Coarse: a cubic's fourth differences are rounding, so that the bound is as good as the answer.
    const NoiseLevel coarse = estimate_noise(sampled(polynomial, 0.4, 0.1, 9), 0.1);
    CHECK(coarse.noise < 4 * unit_rounding);
}

TEST_CASE("noise: a spacing at which the smooth part dominates is too large, and bounds the noise from above") {
    UniformNoise noise(1e-9);
    const auto f = [&](double t) { return std::exp(t) + noise(); };
    double spacing = 0.5;
    NoiseLevel found = estimate_noise(sampled(f, 0, spacing, 7), spacing);
    CHECK(found.status == NoiseStatus::spacing_too_large);
    CHECK(found.noise > 1e-9);
    for (int tries = 0; tries < 4 && found.status == NoiseStatus::spacing_too_large; ++tries) {
        spacing /= 100;
        found = estimate_noise(sampled(f, 0, spacing, 7), spacing);
    }
    CHECK(found.status == NoiseStatus::detected);
    CHECK((found.noise > 3e-10 && found.noise < 3e-9));
}

TEST_CASE("noise: values in steps are not resolved below the width of a step, and noise of their height above") {
    const auto stairs = [](double t) { return 1e-3 * std::floor(t / 1e-3); };
    const NoiseLevel fine = estimate_noise(sampled(stairs, 0.0101, 1e-4, 9), 1e-4);
    CHECK(fine.status == NoiseStatus::spacing_too_small);
    // Rounding to multiples of w is an error of standard deviation w / sqrt(12); the golden ratio fills the steps evenly.
    const double spacing = 1e-3 * (1 + std::sqrt(5.0)) / 2;
    const NoiseLevel coarse = estimate_noise(sampled(stairs, 0.0101, spacing, 9), spacing);
    CHECK(coarse.status == NoiseStatus::detected);
    CHECK((coarse.noise > 1e-3 / std::sqrt(12.0) / 2.5 && coarse.noise < 1e-3 / std::sqrt(12.0) * 2.5));
    const NoiseLevel constant = estimate_noise(VectorX::Constant(7, 3.25), 1);
    CHECK(constant.status == NoiseStatus::spacing_too_small);
    CHECK(constant.noise == 0);
}

TEST_CASE("noise: derivatives of parabola and cubic are exact, and off by no more than their errors under noise") {
    const auto f = [](double t) { return 3 - 2 * t + 5 * t * t - 7 * t * t * t; };
    const NoiseLevel clean = estimate_noise(sampled(f, -0.3, 0.1, 7), 0.1);
    CHECK(clean.second_derivative == Approx(10).epsilon(1e-12));  // at the middle, t = 0
    CHECK(clean.third_derivative == Approx(-42).epsilon(1e-11));
    UniformNoise noise(1e-2);
    int detected = 0, second = 0, third = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const NoiseLevel found = estimate_noise(sampled([&](double t) { return f(t) + noise(); }, -0.3, 0.1, 7), 0.1);
        if (found.status != NoiseStatus::detected) continue;
        ++detected;
        second += std::abs(found.second_derivative - 10) < 2 * found.second_derivative_error;
        third += std::abs(found.third_derivative + 42) < 2 * found.third_derivative_error;
    }
    REQUIRE(detected > 50);
    // 95% of a normal distribution; fewer, since the noise is an estimate itself, and not all, else the errors would be too large.
    INFO(detected << " detected; within two errors " << second << " and " << third);
    CHECK((second > 0.8 * detected && second < detected));
    CHECK((third > 0.8 * detected && third < detected));
}

TEST_CASE("noise: the best steps balance noise and curvature") {
    const double noise = 1e-10;
    UniformNoise uniform(noise);
    const auto f = [&](double t) { return std::exp(t) + uniform(); };
    const auto error_at = [&](bool central, double h) {
        double square = 0;
        for (int trial = 0; trial < 300; ++trial) {
            const double slope = central ? (f(h) - f(-h)) / (2 * h) : (f(h) - f(0)) / h;
            square += (slope - 1) * (slope - 1);
        }
        return std::sqrt(square / 300);
    };
    const double forward = best_forward_step(noise, 1), central = best_central_step(noise, 1);
    CHECK(forward == Approx(std::pow(8, 0.25) * 1e-5));
    CHECK(central == Approx(std::cbrt(3e-10)));
    for (const double factor : {0.2, 5.0}) {
        CHECK(error_at(false, forward) < error_at(false, forward * factor));
        CHECK(error_at(true, central) < error_at(true, central * factor));
    }
    CHECK(std::isinf(best_forward_step(noise, 0)));
    CHECK(std::isinf(best_central_step(noise, 0)));
}

TEST_CASE("noise: columns are judged one by one") {
    UniformNoise noise(1e-4);
    MatrixX values(7, 3);
    values.col(0) = sampled([](double t) { return std::exp(t); }, 0, 0.1, 7);
    values.col(1) = sampled([&](double t) { return t + noise(); }, 0, 0.1, 7);
    values.col(2).setConstant(4);
    const std::vector<NoiseLevel> found = estimate_noise_by_column(values, 0.1);
    REQUIRE(found.size() == 3);
    for (int q = 0; q < 3; ++q) {
        const NoiseLevel alone = estimate_noise(VectorX(values.col(q)), 0.1);
        CHECK(found[q].noise == alone.noise);
        CHECK(found[q].status == alone.status);
    }
    CHECK(found[0].status == NoiseStatus::spacing_too_large);
    CHECK(found[1].status == NoiseStatus::detected);
    CHECK(found[2].status == NoiseStatus::spacing_too_small);
}

}  // namespace fettle::design::optimisers::noise_test
