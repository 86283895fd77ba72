// SPDX-License-Identifier: MIT
/// The nearest point that meets constraints which cost nothing to ask.
#pragma once

#include <functional>
#include <optional>

#include "design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

struct CheapConstraints {
    VectorX lower, upper;                                     ///< n, of the variables
    VectorX row_lower, row_upper;                             ///< k; infinite where there is none
    std::function<std::optional<Rows>(const VectorX&)> rows;  ///< nothing where they have no value
};

/// Minimises sum_k ((x_k - start_k) / (upper_k - lower_k))^2 under the rows, linearised anew at each of at most 20 points.
/// @return the last point at which the rows have values; `start` itself if they have none there.
VectorX project(const VectorX& start, const CheapConstraints& constraints);

}  // namespace fettle::design::optimisers
