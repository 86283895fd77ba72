// SPDX-License-Identifier: MIT
#include "design/tolerances/capability.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::tolerances::capability_test {

namespace {

using core::base::infinity;

struct Coverage {
    int cp = 0, cpk = 0;
};

// How often the true indices lie within 1.96 errors of those of a sample of n normal values of mean 0 and deviation 1.
Coverage covered(const RequirementLimits& limits, int n, int repetitions) {
    std::mt19937_64 random(3);
    const Capability truth = capability_of(0, 1, limits);
    Coverage result;
    VectorX values(n);
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        for (double& x : values) x = normal_quantile((static_cast<double>(random() >> 12) + 0.5) * 0x1p-52);
        const SampleMoments sample = sample_moments(values);
        const Capability found = estimated_capability(sample.moments.mean, sample.moments.standard_deviation, limits, n);
        if (truth.cp) result.cp += std::abs(found.cp->value - truth.cp->value) < 1.96 * found.cp->error;
        result.cpk += std::abs(found.cpk->value - truth.cpk->value) < 1.96 * found.cpk->error;
    }
    return result;
}

}  // namespace

TEST_CASE("capability: known values, with both limits and with one") {
    const Capability both = capability_of(10.1, 0.1, {9.4, 10.6});
    CHECK(both.cp->value == Approx(2).epsilon(1e-12));
    CHECK(both.cpk->value == Approx(5.0 / 3).epsilon(1e-12));
    CHECK((both.cp->error == 0 && both.cpk->error == 0));
    const Capability upper = capability_of(10.1, 0.1, {-infinity, 10.6}), lower = capability_of(10.1, 0.1, {9.4, infinity});
    CHECK((!upper.cp && !lower.cp));
    CHECK(upper.cpk->value == Approx(5.0 / 3).epsilon(1e-12));
    CHECK(lower.cpk->value == Approx(7.0 / 3).epsilon(1e-12));
    CHECK(capability_of(10.7, 0.1, {9.4, 10.6}).cpk->value == Approx(-1.0 / 3).epsilon(1e-12));
    const Capability none = capability_of(0, 1, {}), constant = capability_of(0, 0, {-1, 1});
    CHECK((!none.cp && !none.cpk && !constant.cp && !constant.cpk));
}

TEST_CASE("capability: Bissell's standard errors") {
    const Capability found = estimated_capability(10.1, 0.1, {9.4, 10.6}, 50);
    CHECK(found.cp->error == Approx(2 / std::sqrt(98.0)).epsilon(1e-12));
    CHECK(found.cpk->error == Approx(std::sqrt(1 / 450.0 + 25.0 / 9 / 98)).epsilon(1e-12));
    CHECK_THROWS_AS(estimated_capability(0, 1, {-1, 1}, 1), core::base::ContractError);
}

TEST_CASE("capability: intervals of 1.96 errors cover the truth in 95 of 100 samples") {
    const int repetitions = 1000;
    const double bound = 3.5 * std::sqrt(0.95 * 0.05 * repetitions);
    for (const RequirementLimits& limits : {RequirementLimits{-5, 3}, {-4, infinity}, {-infinity, 1}, {-2, 6}}) {
        const Coverage coverage = covered(limits, 200, repetitions);
        INFO(limits.lower << " .. " << limits.upper << ", of " << repetitions << ": Cp " << coverage.cp << ", Cpk " << coverage.cpk);
        CHECK(std::abs(coverage.cpk - 0.95 * repetitions) < bound);
        if (capability_of(0, 1, limits).cp) CHECK(std::abs(coverage.cp - 0.95 * repetitions) < bound);
    }
    // In the middle of the limits the two sides err in opposite directions: no fewer are covered.
    CHECK(covered({-4, 4}, 200, repetitions).cpk > 0.95 * repetitions - bound);
}

}  // namespace fettle::design::tolerances::capability_test
