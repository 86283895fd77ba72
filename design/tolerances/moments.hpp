// SPDX-License-Identifier: MIT
/// The first four moments of a number that varies, and their estimates from a sample.
/// A dimension's follow from its distribution (distribution.hpp), a result's from its derivatives (propagation.hpp).
#pragma once

#include "core/base/types.hpp"

namespace fettle::design::tolerances {

/// Moments of a number x with expectation E. Units: those of x, to the power.
struct Moments {
    double mean = 0;                ///< E[x]
    double standard_deviation = 0;  ///< sqrt(E[(x - mean)^2])
    double third = 0, fourth = 0;   ///< central moments E[(x - mean)^3], E[(x - mean)^4]
};

/// third / standard_deviation^3 [1]; 0 where nothing varies.
double skewness(const Moments& moments);

/// fourth / standard_deviation^4 [1]: 3 for a normal distribution; also 3 where nothing varies.
double kurtosis(const Moments& moments);

struct SampleMoments {
    /// mean:               the average of the n values
    /// standard_deviation: s = sqrt(sum (x - mean)^2 / (n - 1))
    /// third, fourth:      the averages of (x - mean)^3 and (x - mean)^4, so that skewness and kurtosis are b1 and b2 of Joanes and Gill
    ///                     1998, The Statistician 47(1); for small n both lie nearer to 0 than those of the population.
    Moments moments;
    /// Standard errors, whatever the distribution, for independent values:
    ///   of the mean:               s / sqrt(n)
    ///   of the standard deviation: sqrt((fourth - s^4 (n - 3) / (n - 1)) / n) / (2 s);  0 where nothing varies
    /// An estimate lies within 1.96 of them of the truth in about 95 of 100 samples; of the standard deviation, in fewer where n is below
    /// 100 or tails are heavy, since the fourth moment is estimated too. Values at Sobol points (sobol.hpp) are not independent; their
    /// averages are usually nearer to the truth than these errors say.
    double mean_error = 0, standard_deviation_error = 0;
};

/// Contract: two values or more, all finite.
SampleMoments sample_moments(const VectorX& values);

}  // namespace fettle::design::tolerances
