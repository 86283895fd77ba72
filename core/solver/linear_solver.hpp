// SPDX-License-Identifier: MIT
/// Solves with the Hessian over the free degrees of freedom: Cholesky by blocks (block_cholesky.hpp). The same bits on every machine with
/// the same instruction set: no BLAS is involved.
#pragma once

#include <memory>
#include <vector>

#include "fettle/core/kinematics/tangent_system.hpp"
#include "fettle/core/solver/free_dofs.hpp"

namespace fettle::core::solver {

/// H v over all bodies' six coordinates.
std::vector<Vector6> multiply(const kinematics::BlockHessian& hessian, const std::vector<Vector6>& v);

class LinearSolver {
public:
    explicit LinearSolver(const FreeDofs& dofs);
    ~LinearSolver();
    LinearSolver(LinearSolver&&) noexcept;
    LinearSolver& operator=(LinearSolver&&) noexcept;

    /// Cholesky of the free part. @return false if it is not positive definite (then solve must not be called).
    bool factorise(const kinematics::BlockHessian& hessian);

    /// Any invertible symmetric matrix (dense LU, or sparse LU for many): for the adjoint. @return false if it is singular to rounding.
    bool factorise_indefinite(const kinematics::BlockHessian& hessian);

    /// One column per right-hand side.
    MatrixX solve(const MatrixX& rhs) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::solver
