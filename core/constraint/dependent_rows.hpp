// SPDX-License-Identifier: MIT
/// Which rows follow from others (two hinges on one axis)? Those that are sums of others where lengths are measured by mass
/// (linear/dependent_columns.hpp). docs/method/joints.md#the-step-under-rows.
#pragma once

#include <vector>

#include "core/constraint/row.hpp"
#include "core/linear/free_dofs.hpp"

namespace fettle::core::constraint {

/// A row within this angle [rad] of the space of others depends on them.
inline constexpr double dependent_angle = 3e-5;

struct DependentRow {
    int row = 0;
    std::vector<int> on;  ///< the rows that it is a sum of, those that count
};

/// In ascending order. @param masses  of each body, (q, phi); definite over what is free: else none is found.
std::vector<DependentRow> dependent_rows(const std::vector<Matrix6>& masses, const linear::FreeDofs& dofs, const RowJacobian& rows);

/// Those of `rows` that are not listed, in order.
RowJacobian without(const RowJacobian& rows, const std::vector<DependentRow>& left_out);

}  // namespace fettle::core::constraint
