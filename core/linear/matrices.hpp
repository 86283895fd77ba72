// SPDX-License-Identifier: MIT
/// The matrices of a linear system (linear_system.hpp) as bodies and joints make them: H in blocks of 6 x 6
/// (kinematics/tangent_system.hpp), C in rows, each with a gradient per body. Products are over all six coordinates of every body, free or
/// not.
#pragma once

#include <array>
#include <vector>

#include "core/kinematics/tangent_system.hpp"

namespace fettle::core::linear {

using kinematics::BlockHessian;
using kinematics::OffDiagonalBlock;

/// The gradient of one row in one body.
struct RowGradient {
    int body = 0;
    Vector6 gradient = Vector6::Zero();
};

/// C: gradients of rows, each row's bodies in increasing order, each once.
struct RowJacobian {
    std::vector<int> first;  ///< [row] into `entries`; one more at the end. Empty: no rows
    std::vector<RowGradient> entries;
    int count() const { return first.empty() ? 0 : count_of(first) - 1; }
};

/// H v.
std::vector<Vector6> multiply(const BlockHessian& hessian, const std::vector<Vector6>& v);
/// C v.
VectorX multiply(const RowJacobian& rows, const std::vector<Vector6>& v);
/// out += C^T multipliers.
void add_transposed(const RowJacobian& rows, const Eigen::Ref<const VectorX>& multipliers, std::vector<Vector6>& out);

/// Makes the off-diagonal blocks of these pairs of bodies, zero where they are not there yet. @return [pair] where its block is
/// @param pairs  a < b, in any order, the same more than once too
std::vector<int> place_blocks(const std::vector<std::array<int, 2>>& pairs, BlockHessian& hessian);

/// Adds off-diagonal blocks, in their order, which may be any.
void add_blocks(const std::vector<OffDiagonalBlock>& blocks, BlockHessian& hessian);

}  // namespace fettle::core::linear
