// SPDX-License-Identifier: MIT
/// What to change so that a quantity becomes another one.
#pragma once

#include "core/base/types.hpp"

namespace fettle::design::session {

struct LeastChange {
    VectorX values;       ///< within the bounds
    double change = 0;    ///< of the quantity, to first order
    bool reaches = true;  ///< is that what was wanted? false: the bounds allow no more
};

/// The values that are nearest to `at`, measured in the parameters' ranges, at which the quantity has changed by `wanted` to first order:
///     min sum ((p_k - at_k) / range_k)^2   with   gradient . (p - at) = wanted   and   lower <= p <= upper
/// where the bounds do not allow that much, as much of it as they do.
/// Contract: lower <= at <= upper, all of one size, finite.
LeastChange least_change(const VectorX& at, const VectorX& lower, const VectorX& upper, const VectorX& gradient, double wanted);

}  // namespace fettle::design::session
