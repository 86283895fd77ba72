// SPDX-License-Identifier: MIT
/// The share of products whose result y lies within the limits of a requirement: counted in a sample, or predicted from moments of y.
#pragma once

#include <optional>

#include "core/base/limits.hpp"
#include "design/tolerances/moments.hpp"

namespace fettle::design::tolerances {

/// The limits of a requirement lower <= y <= upper, in the unit of y; a limit that is missing is infinite. Contract: lower <= upper.
struct RequirementLimits {
    double lower = -core::base::infinity, upper = core::base::infinity;
};

/// Shares of all products [1]. Both are given, since a difference from 1 would lose the digits of a small one.
struct Yield {
    double within = 1, outside = 0;
};

/// Parts per million outside of the limits.
double ppm_outside(const Yield& yield);

struct CountedYield {
    Yield found;        ///< count / of
    Yield least, most;  ///< the interval's ends
};

/// From a count in a sample, with the interval of Clopper and Pearson, which holds the true yield in at least the share `confidence` of
/// samples, whatever their number, where they are independent (of Sobol points the count usually errs less):
///   least: I^-1(x, n - x + 1; (1 - confidence) / 2), 0 for x = 0;   most: I^-1(x + 1, n - x; (1 + confidence) / 2), 1 for x = n
/// with I^-1(a, b; p) the inverse of the regularised incomplete beta function.
/// @param within      x, how many lie within the limits. Products that jam or could not be evaluated do not. Contract: 0 <= x <= n.
/// @param of          n. Contract: n >= 1.
/// @param confidence  Contract: 0 < confidence < 1.
/// Source: Clopper and Pearson 1934, Biometrika 26(4).
CountedYield counted_yield(int within, int of, double confidence);

/// The yield of a normal y. Contract: standard_deviation >= 0; of 0, the mean is within the limits or not.
Yield normal_yield(double mean, double standard_deviation, const RequirementLimits& limits);

/// The yield of a y with four known moments, by the expansion of Cornish and Fisher: y = mean + standard_deviation w(z) with z standard
/// normal,
///   w(z) = z + S (z^2 - 1) / 6 + K (z^3 - 3 z) / 24 - S^2 (2 z^3 - 5 z) / 36,   S = skewness, K = kurtosis - 3
/// The yield is the probability of the z that w takes to values within the limits, on the interval about 0 on which w rises. No answer
/// where a limit lies beyond that interval, unless this reaches out to |z| = 8 (less than 1e-15 of all lies beyond). An approximation: the
/// smaller S and K, the better, and worst far out in the tails; normal_yield for S = K = 0.
/// Source: Cornish and Fisher 1938, Revue de l'Institut International de Statistique 5(4).
std::optional<Yield> cornish_fisher_yield(const Moments& y, const RequirementLimits& limits);

}  // namespace fettle::design::tolerances
