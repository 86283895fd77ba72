// SPDX-License-Identifier: MIT
/// How a dimension as made deviates from its nominal. With m = (lower + upper) / 2 and half width w = (upper - lower) / 2 of its limits:
///
///   kind         density                                     mean        standard deviation   values
///   normal       normal, sigma = w / sigma_level             m + shift   sigma                all numbers
///   truncated    that of normal, cut off at the limits       follows     follows              lower .. upper
///   uniform      constant                                    m + shift   w / sqrt(3)          lower + shift .. upper + shift
///   triangular   symmetric, falls linearly from the middle   m + shift   w / sqrt(6)          lower + shift .. upper + shift
///
/// A shift says that the process is not centred. Normal, uniform and triangular distributions move as a whole, so that parts leave the
/// limits. A truncated one is what an inspection lets pass: the mean of the normal distribution moves, and the cuts stay.
/// Limits that are one-sided or unequal have a middle m that is not the nominal: the distribution is centred on m.
/// Limits of no width are a constant. Deviations of different dimensions are independent of each other.
#pragma once

#include <string>

#include "design/tolerances/moments.hpp"

namespace fettle::design::tolerances {

enum class DistributionKind { normal, truncated, uniform, triangular };

const char* to_string(DistributionKind kind);

struct Distribution {
    DistributionKind kind = DistributionKind::normal;
    double lower = 0, upper = 0;  ///< limits of the deviation from the nominal [SI unit of the dimension]
    double sigma_level = 3;       ///< how many sigma are in half of the width [1]; uniform and triangular ones have none
    double shift = 0;             ///< of the mean from the middle of the limits [as the limits]
};

/// Empty, or what is wrong, as a sentence: all numbers are finite, lower <= upper, sigma_level > 0; of a truncated one also
/// sigma_level >= least_truncated_sigma_level, and |shift| <= w, so that the centre of the process lies within the limits.
/// Contract of all functions below: empty.
std::string fault_of(const Distribution& distribution);

/// Below it a truncated normal is a uniform distribution (their standard deviations differ by 0.07%), which is to be written as such.
inline constexpr double least_truncated_sigma_level = 0.1;

/// Closed forms. The truncated one has, with a, b = (-w - shift) / sigma, (w - shift) / sigma, density phi and probability P of the
/// standard normal, and Z = P(b) - P(a), from the moments M_k = E[z^k] of z = (x - m - shift) / sigma:
///   M_0 = 1,   M_1 = (phi(a) - phi(b)) / Z,   M_k = (k - 1) M_(k-2) + (a^(k-1) phi(a) - b^(k-1) phi(b)) / Z
/// Source: Johnson, Kotz, Balakrishnan 1994, Continuous Univariate Distributions 1, section 13.10.1.
Moments moments_of(const Distribution& distribution);

/// The deviation below which the share u of all lies. Rises with u. Contract: 0 < u < 1.
/// Applied to points that fill (0, 1) evenly (sobol.hpp) it makes a sample of the distribution.
double quantile(const Distribution& distribution, double u);

}  // namespace fettle::design::tolerances
