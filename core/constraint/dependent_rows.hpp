// SPDX-License-Identifier: MIT
/// Which rows follow from others (two hinges on one axis)? By the pivots of the saddle system of the bodies' masses, in linear time.
/// docs/method.md section 9.
#pragma once

#include <array>
#include <vector>

#include "fettle/core/constraint/row.hpp"

namespace fettle::core::constraint {

/// Below this share of what a row would have by itself it depends on others: square of a sine, so rows within 3e-5 rad of one another.
inline constexpr double dependent_pivot = 1e-9;

struct DependentRow {
    int row = 0;
    std::vector<int> on;  ///< the rows that it is a sum of, those that count
};

/// @param masses  of each body, (q, phi); definite over what is free.
/// @param index   as SaddleSolver takes it.
std::vector<DependentRow> dependent_rows(const std::vector<Matrix6>& masses, const std::vector<std::array<int, 6>>& index, int count,
                                         const RowJacobian& rows);

/// Those of `rows` that are not listed, in order.
RowJacobian without(const RowJacobian& rows, const std::vector<DependentRow>& left_out);

}  // namespace fettle::core::constraint
