// SPDX-License-Identifier: MIT
/// The standard normal distribution: mean 0, standard deviation 1.
#pragma once

namespace fettle::design::tolerances {

/// exp(-z^2 / 2) / sqrt(2 pi); 0 at infinity.
double normal_density(double z);

/// Probability of less than z, 1/2 erfc(-z / sqrt(2)); relative accuracy in the lower tail too. z may be infinite.
double normal_probability(double z);

/// The z of which normal_probability(z) = p. Contract: 0 < p < 1.
double normal_quantile(double p);

}  // namespace fettle::design::tolerances
