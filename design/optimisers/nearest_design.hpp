// SPDX-License-Identifier: MIT
/// The problem of repair: of all points that meet the constraints of a problem, the one nearest to a given point.
///   minimise sum_k r_k^2,   r_k = (x_k - origin_k) / (upper_k - lower_k),   under the constraints of the problem
/// Of a periodic variable r_k is the shorter way round; of one that is fixed by its bounds, 0.
#pragma once

#include "design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

/// sum_k r_k^2 of the above: the square of the distance in ranges.
double squared_change(const Problem& problem, const VectorX& origin, const VectorX& point);

/// The problem, and its smoother models, with that objective (squared deviations: Gauss-Newton knows its curvature exactly). What else an
/// evaluation has stays.
Problem nearest_to(const VectorX& origin, Problem problem);

}  // namespace fettle::design::optimisers
