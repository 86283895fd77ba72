// SPDX-License-Identifier: MIT
/// Solves the saddle-point system of a potential under rows,
///   [ H  C^T ] [ y ]   [ r ]
///   [ C   0  ] [ m ] = [ c ]
/// over the free degrees of freedom. LDL^T without pivoting of the matrix with -delta in place of 0, iterative refinement takes delta out.
/// Order: bodies by least fill in the graph that contacts and rows make of them, each row after the last of its bodies, so that a row's
/// pivot is that of -C H^-1 C^T and none is small unless rows depend on one another. The work of a chain is linear in its length.
/// docs/method.md section 9.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fettle/core/constraint/row.hpp"

namespace fettle::core::constraint {

class SaddleSolver {
public:
    /// @param index  [body][dof]: number of the unknown, or -1 where nothing is solved for; 0 .. count - 1, increasing.
    SaddleSolver(std::vector<std::array<int, 6>> index, int count);
    ~SaddleSolver();
    SaddleSolver(SaddleSolver&&) noexcept;
    SaddleSolver& operator=(SaddleSolver&&) noexcept;

    /// @return is H positive definite where C y = 0 (by the signs of the pivots)? If not, solve may still be called, unless a pivot was 0
    ///         (is_usable).
    bool factorise(const kinematics::BlockHessian& hessian, const RowJacobian& rows);
    bool is_usable() const;

    struct Solution {
        VectorX y;            ///< over the free degrees of freedom
        VectorX multipliers;  ///< per row
        double error = 0;     ///< largest |residual| over the sum of the magnitudes that it is the difference of
    };
    /// Refined.
    Solution solve(const VectorX& r, const VectorX& c) const;

    /// Once through the factor: for corrections that are checked by what they come to.
    Solution solve_roughly(const VectorX& r, const VectorX& c) const;

    /// Per row: its pivot over that of the row by itself. What depends on rows that come before it in the order has next to nothing.
    VectorX relative_pivots() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::constraint
