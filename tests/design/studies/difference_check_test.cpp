// SPDX-License-Identifier: MIT
#include "fettle/design/studies/difference_check.hpp"

#include <catch2/catch.hpp>

#include "fettle/tests/design/small_problem.hpp"

namespace {

using namespace fettle;
using namespace fettle::design::studies;
using namespace fettle::tests::design_support;
using fettle::design::description::values_of;
using namespace fettle::design::problem;

}  // namespace

TEST_CASE("ridders: exact on the polynomials that it extrapolates, and it keeps away from noise") {
    std::vector<double> differences;
    for (double s = 0.1; s > 1e-4; s /= 4) differences.push_back(2 + 3 * s * s - 5 * s * s * s * s);
    CHECK(ridders_estimate(differences, 4).value == Approx(2).epsilon(1e-13));
    std::vector<double> noisy;
    for (double s = 1e-1; s > 1e-9; s /= 4) noisy.push_back((std::exp(1 + s) - std::exp(1 - s)) / (2 * s));
    const DifferenceEstimate estimate = ridders_estimate(noisy, 4);
    CHECK(std::abs(estimate.value - std::exp(1.0)) < 1e-11);
    CHECK(std::abs(estimate.value - std::exp(1.0)) < 10 * estimate.error + 1e-14);
    CHECK(std::isinf(ridders_estimate({1.0}, 4).error));
}

TEST_CASE("gradients of a simulated design with contact agree with differences", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    int contacts = 0;
    for (const auto& step : at.simulation.report.steps) contacts += step.contacts;
    CHECK(contacts > 0);
    const CheckReport report = check_gradients(problem, p, at);
    CHECK(report.failures.empty());
    REQUIRE(report.rows.size() == 6 * 5);
    int not_zero = 0;
    for (const CheckRow& row : report.rows) {
        INFO(row.quantity << " " << row.parameter << ": " << row.adjoint << " against " << row.difference << " +- "
                          << row.difference_error);
        CHECK(row.relative_error < 1e-6);
        not_zero += row.adjoint != 0;
    }
    CHECK(not_zero > 20);
}

TEST_CASE("a wrong gradient is noticed by the check", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    at.gradient[2] *= 1.001;
    CheckOptions quick;
    quick.sizes = 3;
    CHECK(check_gradients(problem, p, at, quick).largest_relative_error > 5e-4);
}
