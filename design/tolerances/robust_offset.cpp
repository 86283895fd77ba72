// SPDX-License-Identifier: MIT
#include "design/tolerances/robust_offset.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "design/tolerances/propagation.hpp"

namespace fettle::design::tolerances {

RobustOffset offset_at_sigmas(const VectorX& gradient, const VectorX& mean, const MatrixX& covariance, double sigmas) {
    FETTLE_ASSERT(mean.size() == gradient.size() && covariance.rows() == gradient.size() && covariance.cols() == gradient.size(),
                  "moments for each derivative");
    const VectorX spread = covariance * gradient;
    RobustOffset out;
    out.mean = gradient.dot(mean);
    out.standard_deviation = std::sqrt(std::max(0.0, gradient.dot(spread)));
    out.offset = out.mean + sigmas * out.standard_deviation;
    out.direction = mean;
    if (out.standard_deviation > 0) out.direction += sigmas / out.standard_deviation * spread;
    return out;
}

RobustOffset worst_offset(const VectorX& gradient, const VectorX& lower, const VectorX& upper, int side) {
    FETTLE_ASSERT(side == 1 || side == -1, "an upper or a lower bound");
    const LinearWorstCase worst = linear_worst_case(0, gradient, lower, upper);
    RobustOffset out;
    out.offset = side > 0 ? worst.most : worst.least;
    out.direction = side > 0 ? worst.at_most : worst.at_least;
    return out;
}

}  // namespace fettle::design::tolerances
