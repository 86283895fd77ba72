// SPDX-License-Identifier: MIT
#include "design/tolerances/propagation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/base/contract.hpp"
#include "design/tolerances/distribution.hpp"
#include "design/tolerances/sobol.hpp"
#include "design/tolerances/yield.hpp"
#include "tests/design/tolerances/quadrature.hpp"

namespace fettle::design::tolerances::propagation_test {

namespace {

using tests::design_support::gauss_hermite, tests::design_support::gauss_legendre, tests::design_support::GaussRule;
using tests::design_support::tensor_moments;

constexpr double degrees = 180 / std::numbers::pi;

// One-way clutch (Gao, Chase, Magleby): phi = acos((a + c) / (e - c)), lengths in mm, phi in degrees.
const Vector3 clutch_nominal(27.645, 11.43, 50.8), clutch_tolerances(0.05, 0.01, 0.0125);

double clutch_angle(const Vector3& p) { return degrees * std::acos((p[0] + p[1]) / (p[2] - p[1])); }

struct Derivatives {
    VectorX gradient;
    MatrixX hessian;
};

Derivatives clutch_derivatives(const Vector3& p = clutch_nominal) {
    const double sum = p[0] + p[1], gap = p[2] - p[1], ratio = sum / gap;
    const double inverse = 1 / gap, square = inverse * inverse, steep = sum * square, bend = 2 * sum * square * inverse;
    const double slope = -1 / std::sqrt(1 - ratio * ratio), curvature = ratio * slope * slope * slope;
    const Vector3 of_ratio(inverse, inverse + steep, -steep);
    Matrix3 bends;
    bends << 0, square, -square,                    //
        square, 2 * square + bend, -square - bend,  //
        -square, -square - bend, bend;
    return {degrees * slope * of_ratio, degrees * (curvature * of_ratio * of_ratio.transpose() + slope * bends)};
}

std::vector<Moments> clutch_inputs() {
    std::vector<Moments> inputs;
    for (const double t : clutch_tolerances) inputs.push_back(moments_of({DistributionKind::normal, -t, t}));
    return inputs;
}

Moments exact_clutch_moments() {
    return tensor_moments(gauss_hermite(16), 3, [](const VectorX& z) {
        return clutch_angle(clutch_nominal + Vector3(clutch_tolerances.array() * z.array() / 3));
    });
}

std::mt19937_64& generator() {
    static std::mt19937_64 random(20);
    return random;
}

double in_range(double from, double to) { return from + (to - from) * static_cast<double>(generator()() >> 11) * 0x1p-53; }

VectorX random_vector(int n) {
    VectorX v(n);
    for (double& x : v) x = in_range(-1, 1);
    return v;
}

MatrixX random_symmetric(int n) {
    MatrixX m(n, n);
    for (int j = 0; j < n; ++j) m.col(j) = random_vector(n);
    return m + m.transpose();
}

double quadratic(double nominal, const VectorX& gradient, const MatrixX& hessian, const VectorX& d) {
    return nominal + gradient.dot(d) + 0.5 * d.dot(hessian * d);
}

}  // namespace

TEST_CASE("propagation: the clutch, linear") {
    const Derivatives at = clutch_derivatives();
    CHECK(clutch_angle(clutch_nominal) == Approx(7.018389803).epsilon(1e-10));
    CHECK(at.gradient[0] == Approx(-11.910473).epsilon(1e-7));
    CHECK(at.gradient[1] == Approx(-23.731700).epsilon(1e-7));
    CHECK(at.gradient[2] == Approx(11.821227).epsilon(1e-7));
    const LinearPrediction linear = predict_linearly(clutch_angle(clutch_nominal), at.gradient, clutch_inputs());
    CHECK(linear.mean == Approx(7.018389803).epsilon(1e-10));
    CHECK(linear.standard_deviation == Approx(0.2192924).epsilon(1e-6));
    CHECK(100 * linear.shares[0] == Approx(81.942).epsilon(1e-5));
    CHECK(100 * linear.shares[1] == Approx(13.013).epsilon(1e-4));
    CHECK(100 * linear.shares[2] == Approx(5.045).epsilon(1e-4));
    CHECK(linear.shares.sum() == Approx(1).epsilon(1e-14));
    const LinearWorstCase worst = linear_worst_case(clutch_angle(clutch_nominal), at.gradient, -clutch_tolerances, clutch_tolerances);
    CHECK(worst.most - 7.018389803 == Approx(0.980606).epsilon(1e-6));
    CHECK(7.018389803 - worst.least == Approx(0.980606).epsilon(1e-6));
    // The corners it names are those where the true angle is least and most.
    CHECK(clutch_angle(clutch_nominal + worst.at_least) == Approx(5.957365).epsilon(1e-6));
    CHECK(clutch_angle(clutch_nominal + worst.at_most) == Approx(7.938469).epsilon(1e-6));
}

TEST_CASE("propagation: the clutch, of second order, against quadrature") {
    const Derivatives at = clutch_derivatives();
    const Moments exact = exact_clutch_moments();
    CHECK(exact.mean == Approx(7.0149565).epsilon(1e-8));
    CHECK(exact.standard_deviation == Approx(0.2196700).epsilon(1e-6));
    CHECK(skewness(exact) == Approx(-0.0943927).epsilon(1e-5));
    CHECK(kurtosis(exact) == Approx(3.0238976).epsilon(1e-7));
    const Moments found = predict_quadratically(clutch_angle(clutch_nominal), at.gradient, at.hessian, clutch_inputs());
    INFO("mean " << found.mean << ", deviation " << found.standard_deviation << ", skewness " << skewness(found) << ", kurtosis "
                 << kurtosis(found));
    CHECK(found.mean == Approx(exact.mean).epsilon(1e-4));
    // The third derivatives add as much as the second ones do, but for the mean and the skewness.
    CHECK(found.standard_deviation == Approx(exact.standard_deviation).epsilon(2e-3));
    CHECK(std::abs(skewness(found) - skewness(exact)) < 1e-3);
    CHECK(std::abs(kurtosis(found) - kurtosis(exact)) < 0.02);
}

TEST_CASE("propagation: the clutch, with third derivatives by differences, against quadrature") {
    const Derivatives at = clutch_derivatives();
    const auto gradient_at = [](const Vector3& d) { return clutch_derivatives(clutch_nominal + d).gradient; };
    const Vector3 deviation = clutch_tolerances / 3;
    ThirdDerivatives third{MatrixX(3, 3), 0};
    const auto bend_along = [&](const Vector3& step) -> VectorX { return gradient_at(step) + gradient_at(-step) - 2 * at.gradient; };
    for (int j = 0; j < 3; ++j)
        third.twice.row(j) = bend_along(deviation[j] * Vector3::Unit(j)).transpose() / (deviation[j] * deviation[j]);
    const Vector3 v = deviation.array().square() * at.gradient.array();
    const double step = 1 / predict_linearly(0, at.gradient, clutch_inputs()).standard_deviation;  // step v: one standard deviation of phi
    third.along = v.dot(bend_along(step * v)) / (step * step);
    const Moments exact = exact_clutch_moments();
    const Moments found = predict_with_third_derivatives(clutch_angle(clutch_nominal), at.gradient, at.hessian, third, clutch_inputs());
    INFO("mean " << found.mean << ", deviation " << found.standard_deviation << ", skewness " << skewness(found) << ", kurtosis "
                 << kurtosis(found));
    CHECK(found.mean == Approx(exact.mean).epsilon(1e-5));
    CHECK(found.standard_deviation == Approx(exact.standard_deviation).epsilon(3e-5));
    CHECK(std::abs(skewness(found) - skewness(exact)) < 2e-3);
    CHECK(std::abs(kurtosis(found) - kurtosis(exact)) < 1e-3);
}

TEST_CASE("propagation: the motor's eleven dimensions") {
    // Dimensioning and Tolerancing Handbook, chapter 9; inches. A and J count negatively.
    const double nominal[] = {0.375, 0.032, 0.060, 0.438, 0.120, 1.500, 0.120, 0.438, 0.450, 3.019, 0.300};
    VectorX gradient = VectorX::Ones(11), lower(11), upper(11);
    gradient[0] = gradient[9] = -1;
    lower << -0.031, -0.002, -0.003, -0.015, -0.005, -0.004, -0.005, -0.015, -0.007, 0, -0.030;
    upper << 0, 0.002, 0.003, 0, 0.005, 0.010, 0.005, 0, 0.007, 0.012, 0.030;
    double gap = 0;
    std::vector<Moments> inputs;
    for (int j = 0; j < 11; ++j) {
        gap += gradient[j] * nominal[j];
        inputs.push_back(moments_of({DistributionKind::normal, lower[j], upper[j]}));
    }
    const LinearWorstCase worst = linear_worst_case(gap, gradient, lower, upper);
    CHECK(worst.least == Approx(-0.034).epsilon(1e-10));
    CHECK(worst.most == Approx(0.157).epsilon(1e-10));
    const LinearPrediction linear = predict_linearly(gap, gradient, inputs);
    CHECK(linear.mean == Approx(0.0615).epsilon(1e-10));
    CHECK(3 * linear.standard_deviation == Approx(0.03808).margin(5e-6));  // root sum of squares
    // With no curvature the second order is the first.
    const Moments second = predict_quadratically(gap, gradient, MatrixX::Zero(11, 11), inputs);
    CHECK(second.mean == Approx(linear.mean).epsilon(1e-14));
    CHECK(second.standard_deviation == Approx(linear.standard_deviation).epsilon(1e-14));
    CHECK(kurtosis(second) == Approx(3).epsilon(1e-13));
}

TEST_CASE("propagation: quadratic forms of normal inputs, shifted ones too, are exact") {
    const GaussRule rule = gauss_hermite(6);
    for (int trial = 0; trial < 20; ++trial) {
        const int n = 1 + trial % 4;
        const VectorX gradient = random_vector(n), shift = random_vector(n), deviation = random_vector(n).cwiseAbs();
        const MatrixX hessian = random_symmetric(n);
        std::vector<Moments> inputs;
        for (int j = 0; j < n; ++j) inputs.push_back({shift[j], deviation[j], 0, 3 * std::pow(deviation[j], 4)});
        const Moments found = predict_quadratically(0.7, gradient, hessian, inputs);
        const Moments exact =
            tensor_moments(rule, n, [&](const VectorX& z) { return quadratic(0.7, gradient, hessian, shift + deviation.cwiseProduct(z)); });
        const double s = exact.standard_deviation;
        CHECK(found.mean == Approx(exact.mean).epsilon(1e-11).margin(1e-12));
        CHECK(found.standard_deviation == Approx(s).epsilon(1e-11));
        CHECK(std::abs(found.third - exact.third) < 1e-10 * std::pow(s, 3));
        CHECK(std::abs(found.fourth - exact.fourth) < 1e-10 * std::pow(s, 4));
    }
}

TEST_CASE("propagation: quadratic forms of other inputs: mean and variance are exact, and the rest to the order that is promised") {
    // Inputs z + skew (z^2 - 1) of normal z are skewed, uniform ones symmetric.
    const auto moments_of_input = [](double skew) {
        return tensor_moments(gauss_hermite(6), 1, [&](const VectorX& z) { return z[0] + skew * (z[0] * z[0] - 1); });
    };
    const int n = 3;
    const VectorX gradient = random_vector(n);
    const MatrixX curvature = random_symmetric(n);
    for (const bool uniform : {true, false}) {
        const double skew = 0.2;
        const Moments input = uniform ? Moments{0, 1 / std::sqrt(3), 0, 0.2} : moments_of_input(skew);
        const std::vector<Moments> inputs(n, input);
        double third_error[2], fourth_error[2];
        for (const int halving : {0, 1}) {
            const MatrixX hessian = std::ldexp(0.002, -halving) * curvature;
            const Moments found = predict_quadratically(0, gradient, hessian, inputs);
            const Moments exact = tensor_moments(uniform ? gauss_legendre(6) : gauss_hermite(12), n, [&](const VectorX& z) {
                const VectorX d = uniform ? z : VectorX(z.array() + skew * (z.array().square() - 1));
                return quadratic(0, gradient, hessian, d);
            });
            CHECK(found.mean == Approx(exact.mean).epsilon(1e-11).margin(1e-12));
            CHECK(found.standard_deviation == Approx(exact.standard_deviation).epsilon(1e-11));
            third_error[halving] = std::abs(found.third - exact.third);
            fourth_error[halving] = std::abs(found.fourth - exact.fourth);
        }
        const double third_order = std::log2(third_error[0] / third_error[1]), fourth_order = std::log2(fourth_error[0] / fourth_error[1]);
        INFO((uniform ? "uniform" : "skewed") << ": errors fall by order " << third_order << " and " << fourth_order);
        CHECK(third_order == Approx(uniform ? 3 : 2).margin(0.15));
        CHECK(fourth_order == Approx(uniform ? 2 : 1).margin(0.15));
    }
}

TEST_CASE("propagation: with third derivatives the errors of a cubic of normal inputs are of the order that is promised") {
    const int n = 3;
    const VectorX gradient = random_vector(n);
    const MatrixX hessian = random_symmetric(n);
    MatrixX directions(n, 4);  // T_jkl = sum over directions c of c_j c_k c_l: with all entries
    for (int c = 0; c < 4; ++c) directions.col(c) = random_vector(n);
    double variance_error[2], fourth_error[2];
    for (const int halving : {0, 1}) {
        const double s = std::ldexp(0.1, -halving);
        const auto cubic = [&](const VectorX& z) {
            return quadratic(0, gradient, hessian, s * z) + (directions.transpose() * s * z).array().cube().sum() / 6;
        };
        const MatrixX squared = directions.array().square();
        const ThirdDerivatives third{squared * directions.transpose(), (directions.transpose() * gradient * s * s).array().cube().sum()};
        const Moments found =
            predict_with_third_derivatives(0, gradient, hessian, third, std::vector<Moments>(n, {0, s, 0, 3 * std::pow(s, 4)}));
        const Moments exact = tensor_moments(gauss_hermite(8), n, cubic);
        const auto fourth_cumulant = [](const Moments& m) { return m.fourth - 3 * std::pow(m.standard_deviation, 4); };
        variance_error[halving] = std::abs(std::pow(found.standard_deviation, 2) - std::pow(exact.standard_deviation, 2));
        fourth_error[halving] = std::abs(fourth_cumulant(found) - fourth_cumulant(exact));
    }
    CHECK(std::log2(variance_error[0] / variance_error[1]) == Approx(6).margin(0.1));
    CHECK(std::log2(fourth_error[0] / fourth_error[1]) == Approx(8).margin(0.3));
}

TEST_CASE("propagation: Sobol samples of the clutch have the moments of second order, and the yield of Cornish and Fisher") {
    const Derivatives at = clutch_derivatives();
    std::vector<Distribution> distributions;
    for (const double t : clutch_tolerances) distributions.push_back({DistributionKind::normal, -t, t});
    const SobolPoints points(3, 1);
    const int n = 1 << 14;
    const RequirementLimits limits{6.4, 7.5};
    VectorX angles(n);
    int within = 0;
    for (int k = 0; k < n; ++k) {
        const VectorX u = points.point(static_cast<std::uint32_t>(k));
        Vector3 p = clutch_nominal;
        for (int j = 0; j < 3; ++j) p[j] += quantile(distributions[static_cast<size_t>(j)], u[j]);
        angles[k] = clutch_angle(p);
        within += limits.lower <= angles[k] && angles[k] <= limits.upper;
    }
    const SampleMoments sample = sample_moments(angles);
    const Moments second = predict_quadratically(clutch_angle(clutch_nominal), at.gradient, at.hessian, clutch_inputs());
    CHECK(std::abs(sample.moments.mean - second.mean) < 0.1 * sample.mean_error + 1e-5);
    CHECK(std::abs(sample.moments.standard_deviation - second.standard_deviation) < sample.standard_deviation_error);
    CHECK(std::abs(skewness(sample.moments) - skewness(second)) < 0.02);
    const std::optional<Yield> predicted = cornish_fisher_yield(second, limits);
    const CountedYield counted = counted_yield(within, n, 0.95);
    REQUIRE(predicted);
    INFO("counted " << counted.found.within << " (" << counted.least.within << " .. " << counted.most.within << "), predicted "
                    << predicted->within << ", as normal " << normal_yield(second.mean, second.standard_deviation, limits).within);
    CHECK((counted.least.within <= predicted->within && predicted->within <= counted.most.within));
}

TEST_CASE("propagation: derivatives of 0, and contracts") {
    const Moments input{0, 1, 0, 3};
    const LinearPrediction still = predict_linearly(5, VectorX::Zero(2), {input, input});
    CHECK((still.mean == 5 && still.standard_deviation == 0 && still.shares.isZero(0)));
    const LinearWorstCase worst =
        linear_worst_case(5, (VectorX(2) << 0, -2).finished(), (VectorX(2) << -1, -1).finished(), (VectorX(2) << 3, 2).finished());
    CHECK((worst.least == 1 && worst.most == 7 && worst.at_least[0] == 1 && worst.at_least[1] == 2 && worst.at_most[1] == -1));
    CHECK_THROWS_AS(predict_linearly(5, VectorX::Zero(3), {input, input}), core::base::ContractError);
    CHECK_THROWS_AS(predict_quadratically(5, VectorX::Zero(2), MatrixX::Zero(3, 3), {input, input}), core::base::ContractError);
}

}  // namespace fettle::design::tolerances::propagation_test
