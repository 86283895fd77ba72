// SPDX-License-Identifier: MIT
/// min |A x - b|_2 over x >= 0, by the active set method of Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23. Small and
/// dense.
#pragma once

#include "fettle/core/base/types.hpp"

namespace fettle::design::optimisers {

/// @param a  n x m, any rank.   @return x, m.
VectorX nonnegative_least_squares(const MatrixX& a, const VectorX& b);

}  // namespace fettle::design::optimisers
