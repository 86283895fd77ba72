// SPDX-License-Identifier: MIT
#include "tests/support/derivative_check.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/base/contract.hpp"

namespace fettle::tests::support {
namespace {

/// Error of `analytic` against one matrix of differences, scaled by the largest entry of either.
DerivativeCheck compare(const MatrixX& analytic, const MatrixX& difference, double step) {
    DerivativeCheck check;
    check.step = step;
    if (!analytic.allFinite() || !difference.allFinite()) {
        check.relative_error = std::numeric_limits<double>::infinity();
        return check;
    }
    if (analytic.size() == 0) return check;
    Eigen::Index row = 0, column = 0;
    const double error = (analytic - difference).cwiseAbs().maxCoeff(&row, &column);
    const double scale = std::max(analytic.cwiseAbs().maxCoeff(), difference.cwiseAbs().maxCoeff());
    check.relative_error = error == 0 ? 0 : error / scale;
    check.row = static_cast<int>(row);
    check.column = static_cast<int>(column);
    check.analytic = analytic(row, column);
    check.difference = difference(row, column);
    return check;
}

/// Central differences along each column of `directions`; the best of all step sizes.
DerivativeCheck sweep_differences(const VectorFunction& f, const VectorX& x, const MatrixX& directions, const MatrixX& analytic,
                                  const StepSweep& sweep) {
    FETTLE_ASSERT(analytic.cols() == directions.cols() && directions.rows() == x.size(), "shapes of a derivative");
    DerivativeCheck best;
    best.relative_error = std::numeric_limits<double>::infinity();
    double h = sweep.largest;
    for (int k = 0; k < sweep.count; ++k, h *= sweep.factor) {
        MatrixX difference(analytic.rows(), analytic.cols());
        for (Eigen::Index i = 0; i < directions.cols(); ++i) {
            const VectorX after = f(x + h * directions.col(i)), before = f(x - h * directions.col(i));
            FETTLE_ASSERT(after.size() == analytic.rows(), "rows of a derivative");
            difference.col(i) = (after - before) / (2 * h);
        }
        const DerivativeCheck check = compare(analytic, difference, h);
        if (k == 0 || check.relative_error < best.relative_error) best = check;
    }
    return best;
}

VectorX random_vector(int size, std::mt19937& generator) {
    VectorX v(size);
    for (int i = 0; i < size; ++i) v[i] = static_cast<double>(generator()) / 2147483648.0 - 1.0;
    return v;
}

}  // namespace

DerivativeCheck check_gradient(const ScalarFunction& f, const VectorX& x, const VectorX& gradient, const StepSweep& sweep) {
    return check_jacobian([&](const VectorX& y) { return VectorX::Constant(1, f(y)).eval(); }, x, gradient.transpose(), sweep);
}

DerivativeCheck check_jacobian(const VectorFunction& f, const VectorX& x, const MatrixX& jacobian, const StepSweep& sweep) {
    return sweep_differences(f, x, MatrixX::Identity(x.size(), x.size()), jacobian, sweep);
}

DerivativeCheck check_directional(const VectorFunction& f, const VectorX& x, const VectorX& direction,
                                  const VectorX& jacobian_times_direction, const StepSweep& sweep) {
    return sweep_differences(f, x, direction, jacobian_times_direction, sweep);
}

double check_transpose(const VectorFunction& times, const VectorFunction& transpose_times, int n, int m, int trials) {
    std::mt19937 generator(20240229);
    double largest = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const VectorX v = random_vector(n, generator), w = random_vector(m, generator);
        const VectorX jv = times(v), jtw = transpose_times(w);
        FETTLE_ASSERT(jv.size() == m && jtw.size() == n, "shapes of a transpose");
        if (!jv.allFinite() || !jtw.allFinite()) return std::numeric_limits<double>::infinity();
        const double scale = w.norm() * jv.norm() + jtw.norm() * v.norm();
        if (scale > 0) largest = std::max(largest, std::abs(w.dot(jv) - jtw.dot(v)) / scale);
    }
    return largest;
}

TaylorCheck check_taylor(const ScalarFunction& f, const VectorX& x, const VectorX& gradient, const VectorX& direction,
                         const StepSweep& sweep) {
    const double f0 = f(x), slope = gradient.dot(direction);
    TaylorCheck check;
    std::vector<double> log_h, log_remainder;
    bool finite = std::isfinite(f0) && std::isfinite(slope);
    double h = sweep.largest;
    for (int k = 0; k < sweep.count; ++k, h *= sweep.factor) {
        const double f1 = f(x + h * direction);
        const double remainder = std::abs((f1 - f0) - h * slope);
        finite = finite && std::isfinite(remainder);
        // What rounding in f and in x + h d may have put there, with room: an f of some thousand operations.
        const double noise =
            1e4 * std::numeric_limits<double>::epsilon() * (std::abs(f0) + std::abs(f1) + std::abs(h * slope) + std::abs(slope) * x.norm());
        if (!(remainder > noise)) continue;
        log_h.push_back(std::log(h));
        log_remainder.push_back(std::log(remainder));
    }
    check.points = count_of(log_h);
    check.below_rounding = finite && check.points == 0;
    if (!finite || check.points < 2) return check;
    // The four smallest steps that stand clear of rounding: farthest into the range where the leading term rules.
    const int used = std::min(check.points, 4), first = check.points - used;
    double mean_h = 0, mean_r = 0, covariance = 0, variance = 0;
    for (int k = first; k < check.points; ++k) {
        mean_h += log_h[k] / used;
        mean_r += log_remainder[k] / used;
    }
    for (int k = first; k < check.points; ++k) {
        covariance += (log_h[k] - mean_h) * (log_remainder[k] - mean_r);
        variance += (log_h[k] - mean_h) * (log_h[k] - mean_h);
    }
    check.slope = covariance / variance;
    return check;
}

}  // namespace fettle::tests::support
