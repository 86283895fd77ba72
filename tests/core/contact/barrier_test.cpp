// SPDX-License-Identifier: MIT
// Known values, derivatives, invariants and the ends of the barrier's range; the same for the mollifier.
#include "core/contact/barrier.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/derivative_check.hpp"

namespace fettle::core::contact::barrier_test {

using namespace fettle::tests::support;

namespace {

VectorX scalar(double x) { return VectorX::Constant(1, x); }

}  // namespace

TEST_CASE("the barrier has known values") {
    const double e = std::exp(1.0);
    // g = g_hat / e: the logarithm is -1.
    const ScalarDerivatives b = barrier(1 / e, 1);
    CHECK(b.value == Approx((1 - 1 / e) * (1 - 1 / e)).epsilon(1e-15));
    CHECK(b.first == Approx((1 - 1 / e) * (-2 - e + 1)).epsilon(1e-15));
    CHECK(b.second == Approx(2 + e - 1 + (1 - 1 / e) * (2 + e) * e).epsilon(1e-15));
    CHECK(barrier(0.5, 1).value == Approx(0.25 * std::log(2.0)).epsilon(1e-15));
}

TEST_CASE("the barrier ends smoothly at the activation gap") {
    for (const double gap_hat : {1e-12, 1e-6, 1.0}) {
        for (const double gap : {gap_hat, 2 * gap_hat, std::numeric_limits<double>::infinity()}) {
            const ScalarDerivatives b = barrier(gap, gap_hat);
            CHECK((b.value == 0 && b.first == 0 && b.second == 0));
        }
        // C2: third order in what is missing.
        const ScalarDerivatives b = barrier(gap_hat * (1 - 1e-5), gap_hat);
        CHECK((b.value > 0 && b.value < 1.1e-15 * gap_hat * gap_hat));
        CHECK((b.first < 0 && b.first > -3.1e-10 * gap_hat));
        CHECK((b.second > 0 && b.second < 6.1e-5));
    }
}

TEST_CASE("the barrier grows without bound, steeper and convex, as the gap closes") {
    ScalarDerivatives last = barrier(0.999, 1);
    for (double gap = 0.9; gap > 1e-300; gap *= 0.5) {
        const ScalarDerivatives b = barrier(gap, 1);
        REQUIRE((b.value > last.value && b.first < last.first && b.second > 0));
        last = b;
    }
    CHECK(last.value > 600);
}

TEST_CASE("the barrier's derivatives are those of its value") {
    for (const double gap_hat : {1e-6, 1.0, 40.0})
        for (const double share : {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99}) {
            const double gap = share * gap_hat;
            const ScalarDerivatives b = barrier(gap, gap_hat);
            // In units of the gap.
            const auto value = [&](const VectorX& x) { return barrier(x[0] * gap, gap_hat).value; };
            const auto slope = [&](const VectorX& x) { return scalar(barrier(x[0] * gap, gap_hat).first); };
            INFO("gap_hat " << gap_hat << " share " << share);
            CHECK(check_gradient(value, scalar(1), scalar(b.first * gap)).relative_error < 1e-7);
            CHECK(check_jacobian(slope, scalar(1), scalar(b.second * gap)).relative_error < 1e-7);
        }
}

TEST_CASE("the barrier does not depend on the unit of length") {
    for (const double gap : {1e-4, 0.3, 0.8}) {
        const ScalarDerivatives metres = barrier(gap, 1), millimetres = barrier(1e6 * gap, 1e6);
        CHECK(millimetres.value == Approx(1e12 * metres.value).epsilon(1e-13));
        CHECK(millimetres.first == Approx(1e6 * metres.first).epsilon(1e-13));
        CHECK(millimetres.second == Approx(metres.second).epsilon(1e-13));
    }
}

TEST_CASE("the barrier of what is not a number is not a number") {
    CHECK(std::isnan(barrier(std::numeric_limits<double>::quiet_NaN(), 1).value));
    CHECK(std::isnan(edge_mollifier(std::numeric_limits<double>::quiet_NaN(), 1).value));
}

TEST_CASE("the mollifier rises from 0 to 1 with a level end") {
    for (const double eps : {1e-9, 1.0, 300.0}) {
        CHECK(edge_mollifier(0, eps).value == 0);
        CHECK(edge_mollifier(0.5 * eps, eps).value == 0.75);
        for (const double c : {eps, 3 * eps}) {
            const ScalarDerivatives m = edge_mollifier(c, eps);
            CHECK((m.value == 1 && m.first == 0 && m.second == 0));
        }
        CHECK(edge_mollifier(eps * (1 - 1e-9), eps).first * eps < 2.1e-9);
        for (const double share : {0.01, 0.4, 0.97}) {
            const ScalarDerivatives m = edge_mollifier(share * eps, eps);
            const auto value = [&](const VectorX& x) { return edge_mollifier(x[0] * eps, eps).value; };
            const auto slope = [&](const VectorX& x) { return scalar(edge_mollifier(x[0] * eps, eps).first); };
            const StepSweep below{5e-3, 0.25, 12};  // not beyond the end
            CHECK(check_gradient(value, scalar(share), scalar(m.first * eps), below).relative_error < 1e-7);
            CHECK(check_jacobian(slope, scalar(share), scalar(m.second * eps), below).relative_error < 1e-7);
        }
    }
}

TEST_CASE("kappa is a stiffness near the activation distance") {
    // Potential weight kappa / (4 a^2) b(d^2 - dmin^2): near d = dmin + dhat = a that is kappa times the barrier of plain distances,
    // -(d - a)^2 ln(...): second derivative in d of both goes as 6 kappa (a - d) / dhat ... so their quotient goes to a constant.
    const double dhat = 1e-3, kappa = 7, weight = 0.01;
    for (const double dmin : {0.0, 2e-3}) {
        const BarrierParameters p = barrier_parameters(dhat, dmin, kappa, weight);
        CHECK(p.activation == dmin + dhat);
        CHECK(p.gap_hat == Approx(p.activation * p.activation - dmin * dmin).epsilon(1e-12));
        const double d = p.activation - 1e-4 * dhat, missing = p.activation - d;
        const double gap = d * d - dmin * dmin;
        const double potential = p.factor * barrier(gap, p.gap_hat).value;
        // b ~ (2 a missing)^2 (2 a missing) / g_hat, times factor: weight kappa missing^2 (2 a missing / g_hat).
        CHECK(potential == Approx(weight * kappa * missing * missing * (2 * p.activation * missing / p.gap_hat)).epsilon(1e-3));
    }
}

}  // namespace fettle::core::contact::barrier_test
