// SPDX-License-Identifier: MIT
#include "design/quantities/interpolant.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "core/base/types.hpp"

namespace fettle::design::quantities::interpolant_test {

namespace {

std::vector<double> sampled(const std::function<double(double)>& of, double step, int count) {
    std::vector<double> y;
    for (int k = 0; k < count; ++k) y.push_back(of(step * k));
    return y;
}

// The largest error of what runs through exp(x) on [0, 1].
double error_of_exponential(int steps) {
    const double step = 1.0 / steps;
    const std::vector<double> y = sampled([](double x) { return std::exp(x); }, step, steps + 1);
    double most = 0;
    for (int k = 0; k <= 1000; ++k) most = std::max(most, std::abs(interpolated(y, k * steps / 1000.0).value - std::exp(k / 1000.0)));
    return most;
}

}  // namespace

TEST_CASE("interpolant: straight lines exactly, the numbers at their places, single ones and pairs") {
    const std::vector<double> line{1, 3, 5, 7}, bent{1, 3, 2, 2, 5};
    for (const double place : {0.0, 0.25, 1.0, 1.9, 3.0}) {
        CHECK(interpolated(line, place).value == Approx(1 + 2 * place).epsilon(1e-14));
        CHECK(interpolated(line, place).slope == Approx(2).epsilon(1e-14));
    }
    for (int k = 0; k < count_of(bent); ++k) CHECK(interpolated(bent, k).value == Approx(bent[k]));
    CHECK(interpolated({4}, 0).value == 4);
    CHECK(interpolated({4, 8}, 0.5).value == 6);
}

TEST_CASE("interpolant: between two numbers it stays between them, whatever they are") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> y(9);
        for (double& number : y) number = std::pow(any(random), 5);
        for (int k = 0; k + 1 < count_of(y); ++k) {
            double last = y[k];
            for (int i = 1; i <= 20; ++i) {
                const double value = interpolated(y, k + i / 20.0).value;
                CHECK((y[k + 1] >= y[k] ? value - last : last - value) >= -1e-15);
                last = value;
            }
        }
    }
}

TEST_CASE("interpolant: its error falls with the third power of the step") {
    const double coarse = error_of_exponential(10), fine = error_of_exponential(20), finest = error_of_exponential(40);
    CAPTURE(coarse, fine, finest);
    CHECK(std::log2(coarse / fine) > 2.7);
    CHECK(std::log2(fine / finest) > 2.8);
}

TEST_CASE("interpolant: weights and slope are its derivatives, and the slope is continuous") {
    const std::vector<double> y{0.3, 0.9, 1.1, 0.4, -0.3, -0.35, 0.2};
    for (const double place : {0.3, 0.9, 1.2, 2.5, 3.1, 4.4, 5.7, 6.0}) {
        CAPTURE(place);
        const Interpolated at = interpolated(y, place);
        const double h = 1e-6;
        if (place < 6)
            CHECK(at.slope == Approx((interpolated(y, place + h).value - interpolated(y, place - h).value) / (2 * h)).margin(1e-8));
        for (int k = 0; k < count_of(y); ++k) {
            std::vector<double> above = y, below = y;
            above[k] += h;
            below[k] -= h;
            const int i = k - at.first;
            const double weight = i >= 0 && i < 4 ? at.weights[i] : 0;
            CHECK(weight == Approx((interpolated(above, place).value - interpolated(below, place).value) / (2 * h)).margin(1e-8));
        }
    }
    for (int k = 1; k < 6; ++k) CHECK(interpolated(y, k - 1e-9).slope == Approx(interpolated(y, k).slope).margin(1e-7));
}

TEST_CASE("crossings: of a sine its zeros, in their order and direction") {
    const double step = 0.05, phase = 0.013;
    const std::vector<double> y = sampled([&](double x) { return std::sin(x + phase); }, step, 200);
    const std::vector<Crossing> found = crossings_of_zero(y);
    REQUIRE(found.size() == 3);
    for (int k = 0; k < 3; ++k) {
        CHECK(found[k].place * step == Approx((k + 1) * M_PI - phase).epsilon(1e-6));
        CHECK(found[k].rises == (k == 1));
        CHECK(interpolated(y, found[k].place).value == Approx(0).margin(1e-14));
    }
}

TEST_CASE("crossings: to begin on 0, to end there and to touch it is none; to rest on it is told") {
    CHECK(crossings_of_zero({0, 1, 2, 1, 0}).empty());
    CHECK(crossings_of_zero({1, 0, 1}).empty());
    CHECK(crossings_of_zero({1, 0, 0, 1}).empty());
    CHECK(crossings_of_zero({0, 0, 0}).empty());
    CHECK(crossings_of_zero({2}).empty());
    CHECK(crossings_of_zero({1e-12, 1, -1e-12, 1}).empty());
    const auto through = crossings_of_zero({-1, 0, 1});
    REQUIRE(through.size() == 1);
    CHECK(through[0].place == 1);
    CHECK_FALSE(through[0].is_at_rest);
    const auto down = crossings_of_zero({1, 0, -1});
    REQUIRE(down.size() == 1);
    CHECK(down[0].place == 1);
    CHECK_FALSE(down[0].rises);
    const auto rest = crossings_of_zero({-1, 0, 0, 1});
    REQUIRE(rest.size() == 1);
    CHECK(rest[0].is_at_rest);
}

TEST_CASE("crossings: the place follows the numbers without a jump as it goes from one interval to the next") {
    double last = 0;
    for (int k = 0; k <= 400; ++k) {
        const double c = -0.5 + 0.005 * k;
        std::vector<double> y = sampled([](double x) { return std::tanh(x - 2); }, 0.25, 17);
        for (double& number : y) number -= c;
        const auto found = crossings_of_zero(y);
        if (c >= std::tanh(2)) break;
        REQUIRE(found.size() == 1);
        CHECK(found[0].place * 0.25 == Approx(2 + std::atanh(c)).margin(3e-3));
        CHECK(found[0].place > last);
        last = found[0].place;
    }
}

}  // namespace fettle::design::quantities::interpolant_test
