// SPDX-License-Identifier: MIT
// Coupons are made up from a process whose bias and spread are known; the intervals hold these in 95 of 100.
#include "design/tolerances/process_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "design/tolerances/known_processes.hpp"

namespace fettle::design::tolerances::process_fit_test {

namespace {

constexpr double mm = 1e-3;

/// A process and a caliper.
struct Truth {
    double bias = 0, bias_per_size = 0, spread = 0, measuring = 0;
};

class Workshop {
public:
    Workshop(const Truth& truth, unsigned seed) : truth_(truth), random_(seed) {}

    // Standard normal, by Box and Muller: the same with every library.
    double normal() {
        const double u = (static_cast<double>(random_()) + 0.5) / 4294967296.0, v = static_cast<double>(random_()) / 4294967296.0;
        return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
    }

    std::vector<MeasuredFeature> coupon(FeatureKind kind, const std::vector<double>& sizes, const std::vector<int>& times) {
        std::vector<MeasuredFeature> features;
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            MeasuredFeature feature{to_string(kind) + std::to_string(i), kind, sizes[i] * mm, {}};
            const double made = feature.nominal + truth_.bias + truth_.bias_per_size * feature.nominal + truth_.spread * normal();
            for (int k = 0; k < times[i % times.size()]; ++k) feature.measured.push_back(made + truth_.measuring * normal());
            features.push_back(std::move(feature));
        }
        return features;
    }

private:
    Truth truth_;
    std::mt19937 random_;
};

bool holds(const Interval& interval, double truth) { return interval.least <= truth && truth <= interval.most; }

KindFit fit_one(const std::vector<MeasuredFeature>& features) {
    const Result<ProcessFit> fit = fit_process(features, "");
    REQUIRE(fit);
    REQUIRE(fit->kinds.size() == 1);
    return fit->kinds[0];
}

const std::vector<double> six{3, 4, 5, 6, 7, 8};

/// How many of some coupons have the truth within their intervals.
struct Covered {
    int bias = 0, slope = 0, spread = 0, bound = 0;
};

Covered cover(const Truth& truth, const std::vector<double>& sizes, const std::vector<int>& times, double spread, int trials) {
    Covered covered;
    Workshop workshop(truth, 7);
    for (int trial = 0; trial < trials; ++trial) {
        const KindFit fit = fit_one(workshop.coupon(FeatureKind::hole, sizes, times));
        covered.bias += holds(fit.bias, truth.bias + truth.bias_per_size * fit.mean_size);
        covered.slope += holds(fit.bias_per_size, truth.bias_per_size);
        covered.spread += holds(fit.spread, spread);
        covered.bound += spread <= fit.spread_bound;
    }
    return covered;
}

// 95 in 100 of n, within three standard deviations of such a count.
void check_share(int count, int of) { CHECK(std::abs(count - 0.95 * of) < 3 * std::sqrt(of * 0.95 * 0.05)); }

}  // namespace

TEST_CASE("a process' fit: a line through six features, against numbers worked out by hand") {
    // y = -0.20, -0.15, -0.16, -0.09, -0.11, -0.04 mm at 3 .. 8 mm: mean -0.125, slope 0.495 / 17.5, residual squares 0.01615 - 17.5
    // slope^2.
    std::vector<MeasuredFeature> features;
    const double off[] = {-0.20, -0.15, -0.16, -0.09, -0.11, -0.04};
    for (int i = 0; i < 6; ++i) features.push_back({"h", FeatureKind::hole, six[i] * mm, {(six[i] + off[i]) * mm}});
    const KindFit fit = fit_one(features);
    CHECK(fit.mean_size / mm == Approx(5.5));
    CHECK(fit.bias.value / mm == Approx(-0.125));
    const double slope = 0.495 / 17.5, s = std::sqrt((0.01615 - 17.5 * slope * slope) / 4);
    CHECK(fit.bias_per_size.value == Approx(slope));
    CHECK(fit.spread.value / mm == Approx(s));
    CHECK(fit.degrees_of_freedom == 4);
    // Tables: t(4, 97.5%) = 2.7764451; chi2(4): 97.5% 11.1432868, 2.5% 0.4844186, 5% 0.7107230.
    CHECK((fit.bias.most - fit.bias.value) / mm == Approx(2.7764451 * s / std::sqrt(6.0)).epsilon(1e-6));
    CHECK((fit.bias_per_size.most - slope) == Approx(2.7764451 * s / std::sqrt(17.5)).epsilon(1e-6));
    CHECK(fit.spread.least / mm == Approx(s * std::sqrt(4 / 11.1432868)).epsilon(1e-6));
    CHECK(fit.spread.most / mm == Approx(s * std::sqrt(4 / 0.4844186)).epsilon(1e-6));
    CHECK(fit.spread_bound / mm == Approx(s * std::sqrt(4 / 0.7107230)).epsilon(1e-6));
    CHECK(bias_at_no_size(fit) / mm == Approx(-0.125 - 5.5 * slope));
    CHECK(fit.outliers.empty());
}

TEST_CASE("a process' fit: intervals hold the truth in 95 of 100 coupons") {
    const Truth truth{-0.2 * mm, 0.01, 0.05 * mm, 0};
    const int trials = 2000;
    SECTION("six features, a line") {
        const Covered found = cover(truth, six, {1}, truth.spread, trials);
        check_share(found.bias, trials);
        check_share(found.slope, trials);
        check_share(found.spread, trials);
        check_share(found.bound, trials);
    }
    SECTION("four features, a constant") {
        const Covered found = cover({-0.2 * mm, 0, 0.05 * mm, 0}, {3, 4, 6, 8}, {1}, truth.spread, trials);
        check_share(found.bias, trials);
        check_share(found.spread, trials);
        check_share(found.bound, trials);
    }
    SECTION("measured three times each with a caliper that spreads too") {
        const double both = std::hypot(0.05, 0.03 / std::sqrt(3.0)) * mm;
        const Covered found = cover({-0.2 * mm, 0.01, 0.05 * mm, 0.03 * mm}, six, {3}, both, trials);
        check_share(found.bias, trials);
        check_share(found.slope, trials);
        check_share(found.spread, trials);
    }
    SECTION("measured once or three times: weighted, nearly as sure") {
        const Covered found = cover({-0.2 * mm, 0.01, 0.02 * mm, 0.05 * mm}, {3, 4, 5, 6, 7, 8, 9, 10}, {1, 3}, 0, trials);
        CHECK(found.bias > 0.93 * trials);
        CHECK(found.slope > 0.93 * trials);
    }
}

TEST_CASE("a process' fit: bias and spread come out right on the average, measuring taken off") {
    const Truth truth{-0.2 * mm, 0.01, 0.05 * mm, 0.04 * mm};
    Workshop workshop(truth, 7);
    double bias = 0, variance = 0, repeat = 0;
    const int trials = 400;
    for (int trial = 0; trial < trials; ++trial) {
        const auto features = workshop.coupon(FeatureKind::pin, {3, 4, 5, 6, 7, 8, 9, 10}, {2});
        const Result<ProcessFit> fit = fit_process(features, "");
        REQUIRE(fit);
        CHECK(fit->repeats == 8);
        bias += fit->kinds[0].bias.value / trials;
        repeat += fit->repeatability * fit->repeatability / trials;
        variance += (fit->kinds[0].spread.value * fit->kinds[0].spread.value - fit->repeatability * fit->repeatability / 2) / trials;
    }
    CHECK(bias / mm == Approx(-0.2 + 0.065).margin(3 * 0.058 / std::sqrt(8.0 * trials)));
    CHECK(std::sqrt(repeat) / mm == Approx(0.04).epsilon(0.05));
    CHECK(std::sqrt(variance) / mm == Approx(0.05).epsilon(0.06));
}

TEST_CASE("a process' fit: where one feature was measured more often it counts for more, if the caliper is what spreads") {
    // The process is exact, so that the mean of all measurements is the best: weights as the numbers of measurements.
    std::vector<MeasuredFeature> features{{"a", FeatureKind::wall, 2 * mm, {2.09 * mm, 2.11 * mm, 2.10 * mm, 2.12 * mm, 2.08 * mm}},
                                          {"b", FeatureKind::wall, 2 * mm, {2.12 * mm, 2.08 * mm}},
                                          {"c", FeatureKind::wall, 2 * mm, {2.11 * mm}}};
    const KindFit fit = fit_one(features);
    CHECK(fit.bias.value / mm == Approx((5 * 0.10 + 2 * 0.10 + 0.11) / 8));
    CHECK(!fit.has_slope);
    CHECK(fit.process_spread == 0);
}

TEST_CASE("a process' fit: where all others lie on one line, or measuring alone scatters as much, an outlier has a finite measure") {
    std::vector<MeasuredFeature> features;
    for (const double size : {2.0, 3.0, 4.0, 5.0, 6.0, 7.0}) features.push_back({"S", FeatureKind::slot, size * mm, {(size - 0.1) * mm}});
    features[2].measured[0] += 0.003 * mm;
    const KindFit fit = fit_process(features, "")->kinds.at(0);
    REQUIRE(fit.outliers.size() == 1);
    CHECK(std::isfinite(fit.outliers[0].studentised));
    CHECK(fit.outliers[0].studentised > 100);
    // Measured twice, 0.05 mm apart: 0.003 mm is nothing.
    for (MeasuredFeature& feature : features) {
        feature.measured.push_back(feature.measured[0] - 0.025 * mm);
        feature.measured[0] += 0.025 * mm;
    }
    CHECK(fit_process(features, "")->kinds.at(0).outliers.empty());
}

TEST_CASE("a process' fit: an outlier is named, and seldom without reason") {
    const Truth truth{-0.2 * mm, 0.01, 0.03 * mm, 0};
    Workshop workshop(truth, 5);
    int named = 0;
    const int trials = 1000;
    for (int trial = 0; trial < trials; ++trial) named += !fit_one(workshop.coupon(FeatureKind::slot, six, {1})).outliers.empty();
    CHECK(named < 0.07 * trials);
    auto features = workshop.coupon(FeatureKind::slot, {3, 4, 5, 6, 7, 8, 9, 10}, {1});
    features[2].measured[0] += 1 * mm;
    const KindFit fit = fit_one(features);
    REQUIRE(fit.outliers.size() == 1);
    CHECK(fit.outliers[0].name == features[2].name);
    CHECK(fit.outliers[0].residual > 0.5 * mm);
}

TEST_CASE("a process' fit: too few features are told, and nothing is made of them") {
    const auto feature = [](FeatureKind kind, double size, std::vector<double> measured) {
        return MeasuredFeature{"f", kind, size * mm, std::move(measured)};
    };
    CHECK(fit_process({}, "form.csv").errors()[0].message.find("nothing is measured") == 0);
    CHECK(fit_process({feature(FeatureKind::hole, 3, {})}, "form.csv").errors()[0].where == "form.csv");
    const auto few = fit_process({feature(FeatureKind::hole, 3, {2.9e-3}), feature(FeatureKind::hole, 4, {3.9e-3})}, "form.csv");
    REQUIRE(!few);
    CHECK(few.errors()[0].message.find("at least 3") != std::string::npos);
    // Three holes are a constant with wide intervals; two pins are left out.
    const auto some =
        fit_process({feature(FeatureKind::hole, 3, {2.8e-3}), feature(FeatureKind::hole, 4, {3.8e-3}),
                     feature(FeatureKind::hole, 5, {4.86e-3}), feature(FeatureKind::pin, 5, {5e-3}), feature(FeatureKind::pin, 6, {6e-3})},
                    "");
    REQUIRE(some);
    REQUIRE(some->too_few.size() == 1);
    CHECK(some->too_few[0].kind == FeatureKind::pin);
    CHECK(some->too_few[0].features == 2);
    CHECK(!some->kinds[0].has_slope);
    CHECK(some->kinds[0].spread_bound > 4 * some->kinds[0].spread.value);
    CHECK(some->repeats == 0);
    const Process process = fitted_process(*some, "mine", *find_known_process("fdm"));
    CHECK(find_feature(process, FeatureKind::pin)->tolerance == 0.3 * mm);
    CHECK(find_feature(process, FeatureKind::hole)->tolerance == 3 * some->kinds[0].spread_bound);
    CHECK(find_feature(process, FeatureKind::hole)->bias == Approx(some->kinds[0].bias.value));
    CHECK(process.features.size() == find_known_process("fdm")->features.size());
    CHECK(process.clearance->bands.size() == 3);
}

TEST_CASE("a process' fit: of several prints, how they differ is held in 95 of 100") {
    const Truth truth{-0.2 * mm, 0.01, 0.05 * mm, 0.01 * mm};
    const double shift = 0.04 * mm, within = std::hypot(truth.spread, truth.measuring);
    const int trials = 2000, prints = 5;
    Workshop workshop(truth, 7);
    int bias = 0, slope = 0, spread = 0, between = 0, share = 0, bound = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<MeasuredFeature> all;
        for (int p = 0; p < prints; ++p) {
            const double own = shift * workshop.normal();
            for (MeasuredFeature& feature : workshop.coupon(FeatureKind::hole, six, {1})) {
                feature.measured[0] += own;
                feature.print = p;
                all.push_back(feature);
            }
        }
        const KindFit fit = fit_one(all);
        REQUIRE(fit.components);
        REQUIRE(fit.degrees_of_freedom == 6 * prints - prints - 1);
        bias += holds(fit.bias, truth.bias + truth.bias_per_size * fit.mean_size);
        slope += holds(fit.bias_per_size, truth.bias_per_size);
        spread += holds(fit.spread, within);
        between += holds(fit.components->between, shift);
        share += holds(fit.components->share, shift * shift / (shift * shift + within * within));
        bound += taken_spread(fit) >= std::hypot(shift, within);
    }
    for (const int count : {bias, slope, spread, share}) check_share(count, trials);
    CHECK(between > 0.94 * trials);
    CHECK(between < 0.98 * trials);
    CHECK(bound > 0.94 * trials);
}

TEST_CASE("a process' fit: prints of different features, and what the process makes of them") {
    // Two prints, one 0.2 mm larger than the other; slopes and spreads are the same by hand: -0.1 +- 0.01 about each print's constant.
    std::vector<MeasuredFeature> features;
    const double off[] = {0.01, -0.01, 0.01, -0.01};
    for (int p = 0; p < 2; ++p)
        for (int i = 0; i < 4; ++i) features.push_back({"p", FeatureKind::pin, 5 * mm, {(5 - 0.1 + 0.2 * p + off[i]) * mm}, p});
    const Result<ProcessFit> fit = fit_process(features, "");
    REQUIRE(fit);
    const KindFit& pins = fit->kinds[0];
    CHECK(fit->prints == 2);
    CHECK(pins.prints == 2);
    CHECK(!pins.has_slope);
    CHECK(pins.bias.value / mm == Approx(0).margin(1e-9));
    CHECK(pins.degrees_of_freedom == 6);
    CHECK(pins.spread.value / mm == Approx(std::sqrt(8e-4 / 6)));
    const double found = std::sqrt(0.02 - 8e-4 / 6 / 4);  // of means -0.1 and 0.1
    CHECK(pins.components->between.value / mm == Approx(found));
    CHECK(taken_spread(pins) == Approx(std::hypot(pins.spread_bound, found * mm)));  // two prints bound nothing
    const Process process = fitted_process(*fit, "mine", *find_known_process("fdm"));
    const double share = found * found / (found * found + 8e-4 / 6);
    CHECK(shared_part(process, FeatureKind::pin).correlation == Approx(share));
    CHECK(shared_part(process, FeatureKind::hole).correlation == -find_known_process("fdm")->correlation);
    // A size of its own in each print says nothing of sizes: no slope, and numbers all the same.
    for (MeasuredFeature& feature : features) {
        const double moved = feature.print * 1 * mm;
        feature.nominal += moved;
        feature.measured[0] += moved;
    }
    const Result<ProcessFit> apart = fit_process(features, "");
    CHECK(!apart->kinds[0].has_slope);
    CHECK(std::isfinite(apart->kinds[0].components->between.most));
    // One of each kind and print: as if of one.
    std::vector<MeasuredFeature> singles;
    for (int p = 0; p < 4; ++p) singles.push_back({"w", FeatureKind::wall, 2 * mm, {(2 + 0.01 * p) * mm}, p});
    CHECK(!fit_process(singles, "")->kinds[0].components);
}

TEST_CASE("a process' fit: features that are all off by the same show no spread, and none is promised") {
    std::vector<MeasuredFeature> features;
    for (const double size : six) features.push_back({"h", FeatureKind::hole, size * mm, {(size - 0.1) * mm}});
    const Result<ProcessFit> fit = fit_process(features, "");
    REQUIRE(fit);
    CHECK(!has_spread(fit->kinds[0]));
    CHECK(fit->kinds[0].outliers.empty());
    for (const double size : {1.0, 2.0, 3.0}) {
        const auto wall = fit_process({{"a", FeatureKind::wall, size * mm, {(size + 0.1) * mm}},
                                       {"b", FeatureKind::wall, 2 * size * mm, {(2 * size + 0.1) * mm}},
                                       {"c", FeatureKind::wall, 3 * size * mm, {(3 * size + 0.1) * mm}}},
                                      "");
        CHECK(wall->kinds[0].outliers.empty());
    }
    const Process fdm = fitted_process(*fit, "mine", *find_known_process("fdm")),
                  cnc = fitted_process(*fit, "mine", *find_known_process("cnc"));
    CHECK(find_feature(fdm, FeatureKind::hole)->tolerance == 0.3 * mm);
    CHECK(find_feature(fdm, FeatureKind::hole)->bias == Approx(-0.1 * mm));
    CHECK(find_feature(cnc, FeatureKind::hole)->general_class == "m");
}

}  // namespace fettle::design::tolerances::process_fit_test
