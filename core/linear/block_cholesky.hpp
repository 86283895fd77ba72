// SPDX-License-Identifier: MIT
/// Cholesky factor L L^T of a sparse symmetric matrix of 6 x 6 blocks, one row of blocks per body, with the bodies ordered so that few
/// blocks fill in (approximate minimum degree, Amestoy, Davis and Duff 1996, from Eigen). A library's factor would go by single numbers:
/// 36 times the indices, and an ordering of six times as many unknowns.
/// Left-looking, by columns of blocks; columns of which none needs another (branches of the elimination tree) on all threads, and each is
/// made from those before it in their order: the same bits for any number of threads.
#pragma once

#include <utility>
#include <vector>

#include "core/kinematics/tangent_system.hpp"
#include "core/linear/free_dofs.hpp"

namespace fettle::core::linear {

class BlockCholesky {
public:
    /// The symbolic factor, kept while the same bodies are coupled. @return is it another than before?
    bool analyse(const kinematics::BlockHessian& hessian, const FreeDofs& dofs);
    /// Multiplications and additions that a factor of what was analysed takes.
    double operations() const { return operations_; }
    /// Bodies of which anything is free, in the order of elimination.
    const std::vector<int>& order() const { return body_of_; }

    /// Factorises what was analysed. @return false if the free part is not positive definite to rounding, or not finite (then solve must
    /// not be called)
    bool factorise(const kinematics::BlockHessian& hessian, const FreeDofs& dofs);

    /// Solution over the free part, one column per right-hand side: the same bits whatever stands beside it.
    MatrixX solve(const MatrixX& rhs, const FreeDofs& dofs) const;

private:
    struct Entry {
        int row;    // node
        int block;  // into blocks_
    };

    void find_columns(const std::vector<std::vector<int>>& neighbours);
    void fill(const kinematics::BlockHessian& hessian, const FreeDofs& dofs);
    bool eliminate(int column);
    void find_levels();
    void solve_panel(int width, std::vector<Vector6>& x) const;

    std::vector<std::pair<int, int>> pattern_;  // bodies of the off-diagonal blocks that the analysis saw
    bool analysed_ = false;
    double operations_ = 0;
    std::vector<int> body_of_;                 // [node] in the order of elimination
    std::vector<int> node_of_;                 // [body] -1: nothing of it is free
    std::vector<std::vector<Entry>> columns_;  // [node] rows below it, ascending
    std::vector<std::vector<Entry>> rows_;     // [node] columns before it that reach it: .row is the column, .block its place there
    std::vector<Matrix6> diagonal_, blocks_;   // the matrix, then its factor
    std::vector<int> filled_in_;               // those of blocks_ that are none of the matrix
    std::vector<int> block_of_;                // [off-diagonal block of the matrix] into blocks_; -1: one of its bodies has nothing free
    struct Level {
        std::vector<int> columns;               // each needs columns of lower levels alone
        int factor_grain = 1, solve_grain = 1;  // of them that a thread takes at a time
    };
    std::vector<Level> levels_;
};

}  // namespace fettle::core::linear
