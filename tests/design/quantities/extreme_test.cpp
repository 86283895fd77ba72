// SPDX-License-Identifier: MIT
#include "design/quantities/extreme.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace fettle::design::quantities::extreme_test {

namespace {

// How far the value is from the truth, which is 0, wherever the steps fall.
struct Band {
    double lowest = 0, highest = 0;
};
Band band_of(const std::function<double(double)>& of) {
    Band out;
    for (int k = 0; k < 1000; ++k) {
        std::vector<double> y;
        for (int t = -8; t < 8; ++t) y.push_back(of(t + k / 1000.0));
        const double value = smooth_maximum(y).value;
        out.lowest = std::min(out.lowest, value);
        out.highest = std::max(out.highest, value);
    }
    return out;
}

}  // namespace

TEST_CASE("smooth extreme: parabolas exactly, the ends and flat stretches as they are") {
    std::vector<double> y;
    for (int i = 0; i < 9; ++i) y.push_back(3 - 0.5 * (i - 4.3) * (i - 4.3));
    const Extreme extreme = smooth_maximum(y);
    CHECK(extreme.value == Approx(3).epsilon(1e-14));
    CHECK(extreme.first == 2);
    double sum = 0;
    for (const double weight : extreme.weights) sum += weight;
    CHECK(sum == Approx(1));
    CHECK(smooth_maximum({3, 2, 1}).value == 3);
    CHECK(smooth_maximum({1, 2, 3}).value == 3);
    CHECK(smooth_maximum({1, 3, 2}).value == Approx(3 + 1.0 / 24));  // nothing is known of the neighbours' bends
    CHECK(smooth_maximum({1, 2, 2, 2, 1}).value == 2);
    CHECK(smooth_maximum({5, 5, 5}).value == 5);
    CHECK(smooth_maximum({7}).value == 7);
}

TEST_CASE("smooth extreme of a cosine: closer than its steps, by the stated bound, and nearly smooth in its phase") {
    const double step = 0.0314;
    double largest_jump = 0, last = 0, largest_error = 0;
    for (int k = 0; k <= 400; ++k) {
        std::vector<double> y;
        for (int t = 0; t < 210; ++t) y.push_back(std::cos(step * t + 0.5 + 1e-4 * k));
        const double value = smooth_maximum(y).value;
        largest_error = std::max(largest_error, std::abs(value - 1));
        if (k > 0) largest_jump = std::max(largest_jump, std::abs(value - last));
        last = value;
    }
    CHECK(largest_error < 3 * std::pow(step, 4) / 128 * 1.01);
    CHECK(largest_jump < 1e-8);
}

TEST_CASE("smooth extreme: a rise that ends in a cliff, wherever the steps fall") {
    const Band straight = band_of([](double x) { return x < 0 ? 0.1 * x : -3 * x; });
    CHECK(straight.lowest > -1e-14);
    CHECK(straight.highest < 1e-14);
    const Band mirrored = band_of([](double x) { return x > 0 ? -0.1 * x : 3 * x; });
    CHECK(mirrored.lowest > -1e-14);
    CHECK(mirrored.highest < 1e-14);
    const Band bent = band_of([](double x) { return x < 0 ? 0.1 * x - 0.01 * x * x : -10 * (1 - std::exp(-0.3 * x)); });
    CHECK(bent.lowest > -0.02);  // the largest step is below by up to 0.11, a parabola above by up to 0.28
    CHECK(bent.highest < 0.02);
}

TEST_CASE("smooth extreme: what is neither a bend nor a cliff is no higher than the steps") {
    const Band jump = band_of([](double x) { return x < 0 ? 0.1 * x : -3; });
    CHECK(jump.lowest >= -0.1);
    CHECK(jump.highest <= 0);
    const Band bend_before_jump = band_of([](double x) { return x < 0.5 ? -0.1 * x * x : -3; });
    CHECK(bend_before_jump.lowest >= -0.03);
    CHECK(bend_before_jump.highest < 1e-3);
    const Extreme spike = smooth_maximum({0, 0, 0, 1, 0, 0, 0});
    CHECK(spike.value == 1);
    CHECK(spike.doubt == 1);
    CHECK(smooth_maximum({0, 0.1, 0.2, -3, -3, -3}).doubt == Approx(0.1).epsilon(0.01));
}

TEST_CASE("smooth extreme: no doubt about bends and cliffs that the numbers show") {
    for (int k = 0; k < 100; ++k) {
        std::vector<double> bend, cliff;
        for (int t = -8; t < 8; ++t) {
            const double x = t + k / 100.0;
            bend.push_back(std::cos(0.5 * x));
            cliff.push_back(x < 0 ? 0.1 * x : -3 * x);
        }
        CHECK(smooth_maximum(bend).doubt == 0);
        CHECK(smooth_maximum(cliff).doubt < 1e-12);
    }
}

TEST_CASE("smooth extreme: the weights are the derivative") {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> number(-1, 1);
    int lifted = 0;
    for (int run = 0; run < 500; ++run) {
        // A bend, a cliff and some noise; the middle one stays the largest.
        const double slope = 0.3 * std::abs(number(generator)), fall = 1 + number(generator), at = 0.4 * number(generator),
                     bend = 0.3 * std::abs(number(generator));
        std::vector<double> y;
        for (int t = -3; t <= 3; ++t) y.push_back((t < at ? slope : -fall) * (t - at) - bend * t * t + 0.01 * number(generator));
        if (std::max_element(y.begin(), y.end()) != y.begin() + 3) continue;
        const Extreme extreme = smooth_maximum(y);
        if (extreme.value > y[3] + 1e-3) ++lifted;
        for (int k = 0; k < 5; ++k) {
            const double h = 1e-6;
            std::vector<double> up = y, down = y;
            up[extreme.first + k] += h;
            down[extreme.first + k] -= h;
            CHECK(extreme.weights[k] == Approx((smooth_maximum(up).value - smooth_maximum(down).value) / (2 * h)).margin(1e-5));
        }
    }
    CHECK(lifted > 100);
}

}  // namespace fettle::design::quantities::extreme_test
