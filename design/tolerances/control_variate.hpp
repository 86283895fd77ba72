// SPDX-License-Identifier: MIT
/// Estimates from samples y_k with a prediction x_k of each, whose own distribution is known (a control variate). What the prediction
/// explains of y costs no samples.
///   mean     ybar - b (xbar - mu_x),   b = cov(x, y) / var(x),   standard error sqrt(var(y) (1 - r^2) / (n - 2)), r their correlation
///   yield    P_x + (gained - lost) / n: P_x the share that is predicted to be good, `gained` the samples that are good though predicted
///            bad, `lost` the other way round. Interval: of gained and lost by Clopper and Pearson, each at (1 + confidence) / 2
///            (Bonferroni), and nothing for P_x.
/// Source: Owen, Monte Carlo theory, methods and examples (2013), chapter 8.9.
#pragma once

#include "core/base/types.hpp"
#include "design/tolerances/yield.hpp"

namespace fettle::design::tolerances {

struct ControlledMean {
    double mean = 0, error = 0;
    double correlation = 0;  ///< r; 0 where nothing varies: `mean` is that of y then
};
/// Contract: as many of both, at least 3.
ControlledMean controlled_mean(const VectorX& y, const VectorX& x, double mean_of_x);

/// @param predicted  P_x. Contract: gained + lost <= of, of > 0, 0 < confidence < 1.
CountedYield controlled_yield(double predicted, int gained, int lost, int of, double confidence);

}  // namespace fettle::design::tolerances
