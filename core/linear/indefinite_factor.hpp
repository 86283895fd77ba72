// SPDX-License-Identifier: MIT
/// L U with pivoting of the whole matrix [H C^T; C 0], for derivatives, where any invertible matrix will do: dense where it is small, else
/// UMFPACK (Davis 2004; SuiteSparse), on one thread of its BLAS, or Eigen's sparse factor where fettle was built without, or UMFPACK is not
/// there.
#pragma once

#include <memory>

#include "core/linear/free_dofs.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::linear {

class IndefiniteFactor {
public:
    IndefiniteFactor();
    ~IndefiniteFactor();
    IndefiniteFactor(IndefiniteFactor&&) noexcept;
    IndefiniteFactor& operator=(IndefiniteFactor&&) noexcept;

    /// @return false if the matrix is singular to rounding: then there is nothing to solve with
    bool factorise(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs);

    /// Rows of the free degrees of freedom, then of the multipliers; one column per right-hand side.
    MatrixX solve(const MatrixX& rhs) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::linear
