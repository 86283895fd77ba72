// SPDX-License-Identifier: MIT
#include "design/gradient_audit/difference_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tests/design/gradient_audit/density_design.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::difference_check_test {

namespace {

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
    for (const auto& step : at.runs.front().simulation.report.steps) contacts += step.contacts;
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

TEST_CASE("ridders: with noise, the estimate that noise spoils least") {
    // 2 + s^2 + s^4, and noise of 1e-6: the smallest step has the worst difference, and says so.
    std::vector<double> differences;
    double step = 0.1, sign = 1;
    for (int i = 0; i < 6; ++i, step /= 4, sign = -sign)
        differences.push_back(2 + step * step + step * step * step * step + sign * 1e-6 / step);
    const DifferenceEstimate estimate = ridders_estimate(differences, 4, 1e-6 / 0.1);
    CHECK(std::abs(estimate.value - 2) < 1e-3);
    CHECK(std::abs(estimate.value - 2) < 3 * estimate.error);
    CHECK(estimate.noise_error >= 1e-5);
    CHECK(estimate.error >= estimate.noise_error);
}

TEST_CASE("check: nothing against rounding is no error, and noise that hides a gradient is told") {
    const auto none = [](const VectorX& u) { return VectorX(VectorX::Zero(u.size())); };
    const auto first = [](const VectorX& u) { return VectorX(VectorX::Unit(u.size(), 0)); };
    const DesignProblem problem =
        density_problem(2, {std::make_shared<OfDensities>([](const VectorX& u) { return 3 + u[0]; }, first),
                            // a clearance that nothing moves, but for its last bits
                            std::make_shared<OfDensities>([](const VectorX& u) { return 1e-4 + 1e-19 * scatter(u[0] + 3 * u[1]); }, none),
                            // nothing at all but rounding
                            std::make_shared<OfDensities>([](const VectorX& u) { return 1e-17 * scatter(u[0] - u[1]); }, none),
                            // its gradient is hidden at every step that is tried
                            std::make_shared<OfDensities>([](const VectorX& u) { return u[0] + 1e-3 * scatter(u[0] + u[1]); }, first)});
    const VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    const CheckReport report = check_gradients(problem, p, at);
    REQUIRE(report.rows.size() == 8);
    for (const CheckRow& row : report.rows) {
        INFO(row.quantity << " " << row.parameter << ": " << row.adjoint << " against " << row.difference << " +- "
                          << row.difference_error);
        CHECK(row.resolved == (row.quantity != "constraint 3"));
        CHECK(row.relative_error <= (row.resolved ? 1e-5 : 3 * row.difference_error));
        CHECK((row.relative_error > 1e-3) == !row.resolved);  // what noise hides is not told as exact
    }
    CHECK(report.simulations <= check_cost(2));
    CHECK(report.roughness.quantities[3].rough);
    CHECK_FALSE(report.roughness.quantities[2].rough);
}

TEST_CASE("check: a gradient that is wrong is found out, however small the steps it leads to") {
    for (const double factor : {1.001, -1.0, 0.0, 1e6}) {
        const DesignProblem problem = density_problem(
            1, {std::make_shared<OfDensities>([](const VectorX& u) { return std::exp(u[0]) + 1e-13 * scatter(u[0]); },
                                              [=](const VectorX& u) { return VectorX(VectorX::Constant(1, factor * std::exp(u[0]))); })});
        const VectorX p = values_of(problem.design().parameters);
        const CheckReport report = check_gradients(problem, p, problem.evaluate(p));
        INFO("factor " << factor << ", steps from " << report.first_step);
        REQUIRE(report.rows.size() == 1);
        CHECK(report.rows[0].resolved);
        CHECK(report.rows[0].relative_error > 5e-4);
        CHECK(report.rows[0].difference == Approx(1e-3).epsilon(1e-6));
    }
}

TEST_CASE("check: steps keep within the length over which a kinked quantity's gradient holds") {
    const double kink = 2e-4;
    const DesignProblem problem =
        density_problem(1, {std::make_shared<OfDensities>([](const VectorX& u) { return 3 - u[0]; },
                                                          [](const VectorX&) { return VectorX(-VectorX::Ones(1)); }),
                            std::make_shared<OfDensities>([=](const VectorX& u) { return std::exp(u[0]) + std::max(0.0, u[0] - kink); },
                                                          [](const VectorX& u) { return VectorX(VectorX::Constant(1, std::exp(u[0]))); })});
    const VectorX p = values_of(problem.design().parameters);
    const CheckReport report = check_gradients(problem, p, problem.evaluate(p));
    CHECK(report.first_step <= 1.2 * kink);
    CHECK(report.largest_relative_error < 1e-7);
}

TEST_CASE("kink: what stays as steps shrink, and is neither noise nor curvature") {
    const auto slopes_of = [](const std::function<double(double)>& q, double noise = 0) {
        SideSlopes result;
        double sign = 1;
        for (double s = 1e-2; s > 1e-5; s /= 4, sign = -sign) {
            result.steps.push_back(s);
            result.above.push_back((q(s) + sign * noise - q(0)) / s);
            result.below.push_back((q(0) - q(-s) - sign * noise) / s);
        }
        return result;
    };
    const Kink found = kink_of(slopes_of([](double s) { return std::exp(s) + std::max(0.0, 1e-3 * s); }), 1e-16, 1e-5);
    CHECK(found.jump() == Approx(1e-3).epsilon(0.1));
    CHECK(found.lies_between(1, 0));
    CHECK(found.lies_between(1.001, 0));
    CHECK_FALSE(found.lies_between(1.0012, 0));
    CHECK_FALSE(found.lies_between(0.9998, 0));
    CHECK(kink_of(slopes_of([](double s) { return std::exp(s) + std::max(0.0, 1e-3 * s); }), 1e-16, 1e-2).jump() == 0);  // counts for less
    CHECK(kink_of(slopes_of([](double s) { return std::exp(20 * s); }), 1e-16, 1e-5).jump() == 0);
    CHECK(kink_of(slopes_of([](double) { return 1.0; }, 1e-7), 1e-7, 1e-5).jump() == 0);
    CHECK(kink_of(slopes_of([](double s) { return std::max(0.0, s - 1e-3); }), 1e-16, 1e-5).jump() == 0);  // a thousandth beside it
    CHECK(kink_of({}, 1e-16, 1e-5).jump() == 0);
}

TEST_CASE("check: a gradient that is that of neither side of a kink lies outside, along the gradient too") {
    const auto report_for = [](double adjoint) {
        const DesignProblem problem =
            density_problem(1, {std::make_shared<OfDensities>([](const VectorX& u) { return 3 + std::max(2 * u[0], -u[0]); },
                                                              [=](const VectorX&) { return VectorX(VectorX::Constant(1, adjoint)); })});
        const VectorX p = values_of(problem.design().parameters);
        return check_gradients(problem, p, problem.evaluate(p));
    };
    for (const double adjoint : {2.0, -1.0, 0.7}) {
        const CheckReport right = report_for(adjoint);
        REQUIRE(right.rows.size() == 1);
        REQUIRE(right.along.size() == 1);
        CHECK(right.rows[0].lies_between);
        CHECK(right.along[0].lies_between);
        CHECK(right.largest_relative_error == 0);
    }
    for (const double adjoint : {2.01, -1.01, 5.0}) {
        const CheckReport wrong = report_for(adjoint);
        REQUIRE(wrong.rows.size() == 1);
        REQUIRE(wrong.along.size() == 1);
        CHECK_FALSE(wrong.rows[0].lies_between);
        CHECK_FALSE(wrong.along[0].lies_between);
        CHECK(wrong.largest_relative_error > 1e-4);
    }
}

TEST_CASE("check: a kink is named, with the slopes of both sides") {
    const DesignProblem problem =
        density_problem(2, {std::make_shared<OfDensities>([](const VectorX& u) { return 3 + std::max(2 * u[0], -u[0]) + std::exp(u[1]); },
                                                          [](const VectorX& u) { return VectorX(Vector2(2, std::exp(u[1]))); })});
    const VectorX p = values_of(problem.design().parameters);
    const CheckReport report = check_gradients(problem, p, problem.evaluate(p));
    REQUIRE(report.rows.size() == 2);
    CHECK(report.rows[0].kink == Approx(3e-3));
    CHECK(report.rows[0].difference == Approx(0.5e-3));
    CHECK(report.rows[0].lies_between);
    CHECK(report.rows[1].kink == 0);
    CHECK(report.rows[1].resolved);  // the kink of the one parameter is no noise of the other
    CHECK(report.rows[1].relative_error < 1e-6);
}

TEST_CASE("check: what was measured before a simulation fails counts as far as it is good enough, and the rest is not checked") {
    const auto wave = [](double size, double frequency) {  // small, so that gradients hold over the usual step
        return std::make_shared<OfDensities>(
            [=](const VectorX& u) { return size * std::sin(frequency * u[0]); },
            [=](const VectorX& u) { return VectorX::Constant(1, size * frequency * std::cos(frequency * u[0])); });
    };
    // Steps of 1, 1/4, 1/16 kg/m^3 are simulated, smaller ones are not: enough for the slow wave, not for the fast one.
    const auto check_of = [&](const std::vector<std::shared_ptr<OfDensities>>& quantities) {
        description::Design design = density_problem(1, quantities).design();
        design.relations.push_back({.name = "defined", .at = [](const VectorX& p) {
                                        const double away = std::abs(p[0] - 1000);
                                        return description::RelationValue{away > 0 && away < 0.05 ? std::nan("") : 0, VectorX::Zero(1)};
                                    }});
        const auto problem = DesignProblem::create(std::move(design));
        REQUIRE(problem);
        const VectorX p = values_of(problem->design().parameters);
        const DesignEvaluation at = problem->evaluate(p);
        REQUIRE(at.usable);
        return check_gradients(*problem, p, at);
    };
    const CheckReport slow = check_of({wave(0.01, 200)});
    CHECK(slow.failures.empty());
    REQUIRE(slow.rows.size() == 1);
    CHECK(slow.rows[0].relative_error < 1e-5);
    CHECK(slow.rows[0].difference_error < 1e-5);
    const CheckReport both = check_of({wave(0.01, 200), wave(5e-8, 2000)});
    INFO("first step " << both.first_step << ", roughness measured " << both.roughness.measured);
    REQUIRE(both.rows.size() == 1);
    CHECK(both.rows[0].quantity == "objective");
    REQUIRE(both.failures.size() == 1);
    CHECK(both.failures[0].find("relation `defined`") != std::string::npos);
}

TEST_CASE("check: along the gradient, the remainder's slope tells a right gradient from a wrong one") {
    for (const double factor : {1.0, 1.001}) {
        const auto value = [](const VectorX& u) { return std::exp(2 * u[0]) + 0.5 * u[0] * u[1]; };
        const auto gradient = [=](const VectorX& u) { return VectorX(factor * Vector2(2 * std::exp(2 * u[0]) + 0.5 * u[1], 0.5 * u[0])); };
        const DesignProblem problem =
            density_problem(2, {std::make_shared<OfDensities>(value, gradient),
                                std::make_shared<OfDensities>([](const VectorX& u) { return 2 + 3 * u[0]; },
                                                              [](const VectorX&) { return VectorX(Vector2(3, 0)); })});
        const VectorX p = values_of(problem.design().parameters);
        const CheckReport report = check_gradients(problem, p, problem.evaluate(p));
        REQUIRE(report.along.size() == 2);
        CAPTURE(factor, report.along[0].slope, report.along[0].difference, report.along[0].adjoint, report.first_step);
        CHECK(report.along[0].difference == Approx(report.along[0].adjoint / factor).epsilon(1e-7));
        CHECK((report.along[0].relative_error < 1e-7) == (factor == 1));
        if (factor == 1)
            CHECK(report.along[0].slope == Approx(2).margin(0.02));
        else
            CHECK(report.along[0].slope < 1.5);
        CHECK(std::isnan(report.along[1].slope));  // straight: rounding is all that is left
        CHECK(report.sweeps.failure.empty());
        CHECK(report.left_out.empty());
    }
}

TEST_CASE("check: cut to the parameters that the objective hangs on most") {
    const DesignProblem problem =
        density_problem(3, {std::make_shared<OfDensities>([](const VectorX& u) { return 3 + u[0] - 5 * u[1] + 2 * u[2]; },
                                                          [](const VectorX&) { return VectorX(Eigen::Vector3d(1, -5, 2)); })});
    const VectorX p = values_of(problem.design().parameters);
    CheckOptions options;
    options.most_parameters = 2;
    const CheckReport report = check_gradients(problem, p, problem.evaluate(p), options);
    REQUIRE(report.rows.size() == 2);
    CHECK(report.rows[0].parameter == problem.design().parameters[1].name);
    CHECK(report.rows[1].parameter == problem.design().parameters[2].name);
    CHECK(report.left_out == std::vector<std::string>{problem.design().parameters[0].name});
    CHECK(report.simulations <= check_cost(3, options));
    CHECK(check_cost(3, options) < check_cost(3));
}

}  // namespace fettle::design::gradient_audit::difference_check_test
