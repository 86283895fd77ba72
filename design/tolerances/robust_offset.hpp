// SPDX-License-Identifier: MIT
/// The reserve that a number y needs for the deviations d of the design as made, to first order of its derivatives g = dy/dd:
///   at k standard deviations   y + g . m + side k s,   s = sqrt(g^T C g)         m, C: mean and covariance of the deviations
///   in the worst case          y + the largest (side 1) or least (side -1) of g . d over lower <= d <= upper
/// side is 1 for an upper bound and a number that is minimised, -1 for a lower bound and one that is maximised. The first is the value that
/// a normal y exceeds (side 1) with the probability of a standard normal number beyond k: 1350 ppm of k = 3.
///
/// Both are functions of g alone, so that with g = g(p) their derivative in a design parameter p is one derivative of g along a direction:
///   d offset/dp = (dg/dp)^T w,   w = d offset/dg = m + side k C g / s,   or the corner of the worst case
#pragma once

#include "core/base/types.hpp"

namespace fettle::design::tolerances {

struct RobustOffset {
    double offset = 0;              ///< of what y is asked to be from y [unit of y]
    VectorX direction;              ///< w [units of the deviations]
    double mean = 0;                ///< g . m
    double standard_deviation = 0;  ///< s; of a worst case 0: it has none
};

/// Where s = 0, no deviation changes y: offset g . m, direction m, which is one of those that a kink has there.
/// @param sigmas  side k. Contract: covariance symmetric and not negative, sizes as the gradient's.
RobustOffset offset_at_sigmas(const VectorX& gradient, const VectorX& mean, const MatrixX& covariance, double sigmas);

/// A deviation that does not change y is in the middle of its limits.
/// @param side  1 or -1. Contract: finite limits in order.
RobustOffset worst_offset(const VectorX& gradient, const VectorX& lower, const VectorX& upper, int side);

}  // namespace fettle::design::tolerances
