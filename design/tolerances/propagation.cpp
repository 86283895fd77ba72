// SPDX-License-Identifier: MIT
#include "design/tolerances/propagation.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

namespace {

// Input by input.
struct InputColumns {
    VectorX mean, deviation, third, excess;  // excess: the fourth cumulant
};

InputColumns columns_of(const std::vector<Moments>& inputs) {
    const auto n = static_cast<Eigen::Index>(inputs.size());
    InputColumns columns{VectorX(n), VectorX(n), VectorX(n), VectorX(n)};
    for (Eigen::Index j = 0; j < n; ++j) {
        const Moments& input = inputs[static_cast<size_t>(j)];
        columns.mean[j] = input.mean;
        columns.deviation[j] = input.standard_deviation;
        columns.third[j] = input.third;
        columns.excess[j] = input.fourth - 3 * std::pow(input.standard_deviation, 4);
    }
    return columns;
}

}  // namespace

LinearPrediction predict_linearly(double nominal, const VectorX& gradient, const std::vector<Moments>& inputs) {
    FETTLE_ASSERT(gradient.size() == static_cast<Eigen::Index>(inputs.size()), "a derivative for each input");
    const InputColumns input = columns_of(inputs);
    const VectorX variances = (gradient.array() * input.deviation.array()).square();
    const double variance = variances.sum();
    LinearPrediction result;
    result.mean = nominal + gradient.dot(input.mean);
    result.standard_deviation = std::sqrt(variance);
    result.shares = variance > 0 ? VectorX(variances / variance) : VectorX::Zero(gradient.size());
    return result;
}

LinearWorstCase linear_worst_case(double nominal, const VectorX& gradient, const VectorX& lower, const VectorX& upper) {
    FETTLE_ASSERT(gradient.size() == lower.size() && gradient.size() == upper.size(), "two limits for each derivative");
    FETTLE_ASSERT((lower.array() <= upper.array()).all() && lower.allFinite() && upper.allFinite(), "finite limits in order");
    const VectorX middle = lower + 0.5 * (upper - lower);
    LinearWorstCase result{0, 0, middle, middle};
    for (Eigen::Index j = 0; j < gradient.size(); ++j) {
        if (gradient[j] == 0) continue;
        result.at_least[j] = gradient[j] > 0 ? lower[j] : upper[j];
        result.at_most[j] = gradient[j] > 0 ? upper[j] : lower[j];
    }
    result.least = nominal + gradient.dot(result.at_least);
    result.most = nominal + gradient.dot(result.at_most);
    return result;
}

Moments predict_quadratically(double nominal, const VectorX& gradient, const MatrixX& hessian, const std::vector<Moments>& inputs) {
    const auto n = static_cast<Eigen::Index>(inputs.size());
    FETTLE_ASSERT(gradient.size() == n && hessian.rows() == n && hessian.cols() == n, "derivatives for each input");
    const InputColumns input = columns_of(inputs);
    const Eigen::ArrayXd h = gradient + hessian * input.mean, diagonal = hessian.diagonal();
    const VectorX a = h * input.deviation.array();
    const MatrixX b = input.deviation.asDiagonal() * hessian * input.deviation.asDiagonal();
    const MatrixX b_squared = b * b;
    const VectorX b_times_a = b * a;
    const auto third = input.third.array(), excess = input.excess.array();

    const double variance = a.squaredNorm() + 0.5 * b.squaredNorm() + (h * diagonal * third + 0.25 * diagonal.square() * excess).sum();
    const double fourth_cumulant = 12 * b_times_a.squaredNorm() + 3 * b_squared.squaredNorm() + (h.square().square() * excess).sum();
    Moments y;
    y.mean = nominal + gradient.dot(input.mean) + 0.5 * input.mean.dot(hessian * input.mean) + 0.5 * b.trace();
    y.standard_deviation = std::sqrt(std::max(variance, 0.0));
    y.third = 3 * a.dot(b_times_a) + b_squared.cwiseProduct(b).sum() + (h.cube() * third + 1.5 * h.square() * diagonal * excess).sum();
    y.fourth = fourth_cumulant + 3 * variance * variance;
    return y;
}

Moments predict_with_third_derivatives(double nominal, const VectorX& gradient, const MatrixX& hessian, const ThirdDerivatives& third,
                                       const std::vector<Moments>& inputs) {
    Moments y = predict_quadratically(nominal, gradient, hessian, inputs);
    const InputColumns input = columns_of(inputs);
    FETTLE_ASSERT(input.mean.isZero(0), "derivatives at the inputs' means");
    FETTLE_ASSERT(third.twice.rows() == gradient.size() && third.twice.cols() == gradient.size(), "third derivatives for each input");
    const VectorX squares = input.deviation.array().square();
    const VectorX v = gradient.cwiseProduct(squares);
    // 1/3 f_j = s_j^4 + 1/3 (f_j - 3 s_j^4)
    const double added =
        squares.dot(third.twice * v) + (gradient.array() * third.twice.diagonal().array() * input.excess.array()).sum() / 3;
    const double before = y.standard_deviation * y.standard_deviation, variance = std::max(before + added, 0.0);
    y.standard_deviation = std::sqrt(variance);
    y.fourth += 4 * third.along + 3 * (variance * variance - before * before);
    return y;
}

}  // namespace fettle::design::tolerances
