// SPDX-License-Identifier: MIT
/// The one linear system: of a potential's second derivative H over the free degrees of freedom, under rows C (joints, motors) or none,
///   [ H  C^T ] [ y ]   [ r ]
///   [ C   0  ] [ m ] = [ c ]
/// Behind it, by the kind of system and by the graph of what is coupled alone, so that no bit depends on the number of threads:
///   without rows   blocks of 6 x 6 (block_cholesky.hpp); above `supernodal_operations` CHOLMOD (supernodal_cholesky.hpp), where it is
///   there with rows      L D L^T (quasi_definite_factor.hpp) indefinite     L U (indefinite_factor.hpp), for derivatives alone
/// docs/method/joints.md#the-step-under-rows.
#pragma once

#include <memory>

#include "core/linear/free_dofs.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::linear {

class LinearSystem {
public:
    /// Multiplications and additions of the factor by blocks from which on CHOLMOD takes less time.
    static constexpr double supernodal_operations = 5e8;

    explicit LinearSystem(FreeDofs dofs);
    ~LinearSystem();
    LinearSystem(LinearSystem&&) noexcept;
    LinearSystem& operator=(LinearSystem&&) noexcept;

    const FreeDofs& dofs() const;

    /// For Newton's method: is H positive definite (where C y = 0)? If not, there is nothing to solve with, but with rows, where
    /// is_usable() says whether there is. The symbolic factor is kept while the same bodies are coupled.
    bool factorise(const BlockHessian& hessian, const RowJacobian& rows = {});

    /// For derivatives: whatever is invertible. @return false: singular to rounding, or not finite; there is nothing to solve with
    bool factorise_any(const BlockHessian& hessian, const RowJacobian& rows = {});

    bool is_usable() const;

    struct Solution {
        MatrixX y;            ///< over the free degrees of freedom, one column per right-hand side
        MatrixX multipliers;  ///< per row
    };

    static constexpr int usual_passes = 6;
    static constexpr int all_passes = 64;  ///< each halves what is left: more than take a number to its rounding

    /// Once through the factor, all right-hand sides in one pass: for steps and corrections that are checked by what they come to.
    /// @param c  as many columns as r; without rows nothing
    /// @return NaNs where is_usable() is false: the matrix of what a scene says may be anything
    Solution solve(const MatrixX& r, const MatrixX& c = {}) const;

    /// Solves with refinement by the matrix that was factorised: once without constraints, which is enough for how stiff contact makes H;
    /// with constraints, which delta is to be taken out of, until the remainder is rounding, or no longer falls by half. @param most_passes
    /// with constraints: the usual ones are enough unless contact is far stiffer than what constraints leave free, where each pass gains
    /// little.
    Solution solve_refined(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r, const MatrixX& c = {},
                           int most_passes = usual_passes) const;

    /// r - H y - C^T m and c - C y.
    Solution residual(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r, const MatrixX& c, const Solution& x) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::linear
