// SPDX-License-Identifier: MIT
#include "design/tolerances/normal_distribution.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

double normal_probability(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
    FETTLE_ASSERT(p > 0 && p < 1, "a probability between 0 and 1");
    using DoublesAlone = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p, DoublesAlone());
}

}  // namespace fettle::design::tolerances
