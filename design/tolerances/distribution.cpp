// SPDX-License-Identifier: MIT
#include "design/tolerances/distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances {

namespace {

double middle(const Distribution& d) { return d.lower + 0.5 * (d.upper - d.lower); }
double half_width(const Distribution& d) { return 0.5 * (d.upper - d.lower); }
double sigma_of(const Distribution& d) { return half_width(d) / d.sigma_level; }

// Where the normal distribution of mean 0 and sigma 1 is cut.
struct Cuts {
    double lower, upper;
};

Cuts cuts_of(const Distribution& d) { return {(-half_width(d) - d.shift) / sigma_of(d), (half_width(d) - d.shift) / sigma_of(d)}; }

double share_between(const Cuts& cuts) {
    return 1 - normal_probability(cuts.lower) - normal_probability(-cuts.upper);  // tails: a <= 0 <= b
}

// E[z^k], k = 0 .. 4.
std::array<double, 5> raw_moments(const Cuts& cuts) {
    const double share = share_between(cuts);
    double at_lower = normal_density(cuts.lower) / share, at_upper = normal_density(cuts.upper) / share;
    std::array<double, 5> raw{1, at_lower - at_upper};
    for (size_t k = 2; k < raw.size(); ++k) {
        at_lower *= cuts.lower;
        at_upper *= cuts.upper;
        raw[k] = static_cast<double>(k - 1) * raw[k - 2] + at_lower - at_upper;
    }
    return raw;
}

Moments truncated_moments(const Distribution& d) {
    const double sigma = sigma_of(d);
    const auto [one, first, second, third, fourth] = raw_moments(cuts_of(d));
    const double square = first * first;
    return {middle(d) + d.shift + sigma * first, sigma * std::sqrt(second - square),
            std::pow(sigma, 3) * (third - 3 * first * second + 2 * first * square),
            std::pow(sigma, 4) * (fourth - 4 * first * third + 6 * square * second - 3 * square * square)};
}

double truncated_quantile(const Distribution& d, double u) {
    if (u > 0.5) {  // the mirrored distribution, so that upper tails are as exact as lower ones
        return -truncated_quantile({d.kind, -d.upper, -d.lower, d.sigma_level, -d.shift}, 1 - u);
    }
    const Cuts cuts = cuts_of(d);
    const double z = normal_quantile(normal_probability(cuts.lower) + u * share_between(cuts));
    return std::clamp(middle(d) + d.shift + sigma_of(d) * z, d.lower, d.upper);
}

// The quantile of a triangle on [-1, 1], peak at 0.
double triangular_quantile(double u) { return u <= 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u)); }

}  // namespace

const char* to_string(DistributionKind kind) {
    if (kind == DistributionKind::normal) return "normal";
    if (kind == DistributionKind::truncated) return "truncated";
    return kind == DistributionKind::uniform ? "uniform" : "triangular";
}

std::string fault_of(const Distribution& d) {
    if (!std::isfinite(d.lower) || !std::isfinite(d.upper) || !std::isfinite(d.sigma_level) || !std::isfinite(d.shift))
        return "limits, sigma level and shift must be finite";
    if (d.lower > d.upper) return "the lower limit is above the upper one";
    if (d.sigma_level <= 0) return "the sigma level must be positive";
    if (d.kind != DistributionKind::truncated) return "";
    if (d.sigma_level < least_truncated_sigma_level) return "a truncated distribution of a sigma level below 0.1 is a uniform one";
    if (std::abs(d.shift) > half_width(d)) return "the shift of a truncated distribution must leave its centre within the limits";
    return "";
}

Moments moments_of(const Distribution& d) {
    FETTLE_ASSERT(fault_of(d).empty(), fault_of(d));
    const double mean = middle(d) + d.shift, w = half_width(d);
    if (w == 0) return {mean, 0, 0, 0};
    switch (d.kind) {
        case DistributionKind::normal:
            return {mean, sigma_of(d), 0, 3 * std::pow(sigma_of(d), 4)};
        case DistributionKind::truncated:
            return truncated_moments(d);
        case DistributionKind::uniform:
            return {mean, w / std::sqrt(3), 0, std::pow(w, 4) / 5};
        case DistributionKind::triangular:
            return {mean, w / std::sqrt(6), 0, std::pow(w, 4) / 15};
    }
    return {};
}

double quantile(const Distribution& d, double u) {
    FETTLE_ASSERT(fault_of(d).empty(), fault_of(d));
    FETTLE_ASSERT(u > 0 && u < 1, "a share between 0 and 1");
    const double mean = middle(d) + d.shift, w = half_width(d);
    if (w == 0) return mean;
    switch (d.kind) {
        case DistributionKind::normal:
            return mean + sigma_of(d) * normal_quantile(u);
        case DistributionKind::truncated:
            return truncated_quantile(d, u);
        case DistributionKind::uniform:
            return mean + w * (2 * u - 1);
        case DistributionKind::triangular:
            return mean + w * triangular_quantile(u);
    }
    return mean;
}

}  // namespace fettle::design::tolerances
