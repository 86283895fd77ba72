// SPDX-License-Identifier: MIT
/// Which columns of a matrix are sums of others? By a sparse Q R of the columns scaled to length 1 (SuiteSparseQR, Davis 2011, or Eigen's
/// where fettle was built without, or it is not there): a column of which less than a share is left, once those before it in the order are
/// taken out (Heath 1982), depends on them. Where there are such columns, those that are kept stand well apart from one another if the
/// order allows it.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::linear {

struct DependentColumn {
    int column = 0;
    std::vector<int> on;  ///< the columns that it is a sum of: those whose parts are more than 1e-6 of the largest, ascending
};

/// @param share  of a column's length, which is the sine of its angle to the space of the others
/// @return in ascending order
std::vector<DependentColumn> dependent_columns(Eigen::SparseMatrix<double> matrix, double share);

}  // namespace fettle::core::linear
