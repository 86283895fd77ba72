// SPDX-License-Identifier: MIT
#include "design/tolerances/yield.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances {

namespace {

using core::base::infinity;

Yield beta_quantile(double a, double b, double probability) {
    using DoublesAlone = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
    Yield yield;
    yield.within = boost::math::ibeta_inv(a, b, probability, &yield.outside, DoublesAlone());
    return yield;
}

Yield constant_yield(double y, const RequirementLimits& limits) {
    return limits.lower <= y && y <= limits.upper ? Yield{1, 0} : Yield{0, 1};
}

// The yield of a standard normal z.
Yield between(double lower, double upper) {
    Yield yield;
    yield.outside = normal_probability(lower) + normal_probability(-upper);
    // Both on one side: the difference of small tails, not of numbers near 1.
    if (lower > 0)
        yield.within = normal_probability(-lower) - normal_probability(-upper);
    else if (upper < 0)
        yield.within = normal_probability(upper) - normal_probability(lower);
    else
        yield.within = 1 - yield.outside;
    return yield;
}

class CornishFisher {
public:
    CornishFisher(double skewness, double excess)
        : square_(skewness / 6), cube_(excess / 24 - skewness * skewness / 18), linear_(1 - excess / 8 + 5 * skewness * skewness / 36) {}

    double at(double z) const { return square_ * (z * z - 1) + z * (linear_ + z * z * cube_); }

    // How far w rises from 0 in the direction of `sign`; nothing where it does not rise at 0.
    std::optional<double> rises_to(double sign) const {
        if (!(linear_ > 0)) return std::nullopt;
        // w'(sign t) = linear + 2 sign square t + 3 cube t^2 = 0 at t > 0: the root that stays exact as cube tends to 0.
        const double half = sign * square_, discriminant = half * half - 3 * cube_ * linear_;
        if (discriminant < 0) return infinity;
        const double denominator = -half + std::sqrt(discriminant);
        return denominator > 0 ? linear_ / denominator : infinity;
    }

private:
    double square_, cube_, linear_;
};

// The z in the direction of `sign` that w takes to `value`; infinite where practically nothing lies beyond it.
std::optional<double> solve(const CornishFisher& w, double value) {
    constexpr double far = 8;
    if (std::isinf(value)) return value;
    const double sign = value >= w.at(0) ? 1 : -1;
    const std::optional<double> end = w.rises_to(sign);
    if (!end) return std::nullopt;
    const double outermost = std::min(*end, 40.0);  // the normal tail beyond is no double
    if (sign * (w.at(sign * outermost) - value) < 0) return *end >= far ? std::optional(sign * infinity) : std::nullopt;
    double inner = 0, outer = outermost;
    for (int halvings = 0; halvings < 80; ++halvings) {
        const double t = std::midpoint(inner, outer);
        (sign * (w.at(sign * t) - value) < 0 ? inner : outer) = t;
    }
    return sign * outer;
}

}  // namespace

double ppm_outside(const Yield& yield) { return 1e6 * yield.outside; }

CountedYield counted_yield(int within, int of, double confidence) {
    FETTLE_ASSERT(of >= 1 && within >= 0 && within <= of, "a count out of a sample");
    FETTLE_ASSERT(confidence > 0 && confidence < 1, "a confidence between 0 and 1");
    const double x = within, n = of;
    CountedYield result{{x / n, (n - x) / n}, {0, 1}, {1, 0}};
    if (within > 0) result.least = beta_quantile(x, n - x + 1, (1 - confidence) / 2);
    if (within < of) result.most = beta_quantile(x + 1, n - x, (1 + confidence) / 2);
    return result;
}

Yield normal_yield(double mean, double standard_deviation, const RequirementLimits& limits) {
    FETTLE_ASSERT(standard_deviation >= 0 && limits.lower <= limits.upper, "a deviation, and limits in order");
    if (standard_deviation == 0) return constant_yield(mean, limits);
    return between((limits.lower - mean) / standard_deviation, (limits.upper - mean) / standard_deviation);
}

std::optional<Yield> cornish_fisher_yield(const Moments& y, const RequirementLimits& limits) {
    FETTLE_ASSERT(y.standard_deviation >= 0 && limits.lower <= limits.upper, "a deviation, and limits in order");
    if (y.standard_deviation == 0) return constant_yield(y.mean, limits);
    const CornishFisher w(skewness(y), kurtosis(y) - 3);
    const std::optional<double> lower = solve(w, (limits.lower - y.mean) / y.standard_deviation);
    const std::optional<double> upper = solve(w, (limits.upper - y.mean) / y.standard_deviation);
    if (!lower || !upper) return std::nullopt;
    return between(*lower, *upper);
}

}  // namespace fettle::design::tolerances
