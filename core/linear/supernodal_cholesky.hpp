// SPDX-License-Identifier: MIT
/// CHOLMOD's supernodal Cholesky factor L L^T (Chen, Davis, Hager, Rajamanickam 2008; SuiteSparse), for many bodies that hang together in
/// three dimensions: there blocks of 6 x 6 (block_cholesky.hpp) wait for memory, dense panels of hundreds do not. The bodies are ordered by
/// nested dissection (METIS), or as the blocks are where that takes less.
/// CHOLMOD is loaded where it is first needed, and used with OpenBLAS alone, on one thread: the same bits for any number of ours, and on
/// every machine for which OpenBLAS has the same kernels.
#pragma once

#include <memory>
#include <vector>

#include "core/linear/free_dofs.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::linear {

class SupernodalCholesky {
public:
    SupernodalCholesky();
    ~SupernodalCholesky();
    SupernodalCholesky(SupernodalCholesky&&) noexcept;
    SupernodalCholesky& operator=(SupernodalCholesky&&) noexcept;

    /// Was fettle built with CHOLMOD, is it there, and is its BLAS OpenBLAS? The plain BLAS takes longer than the blocks.
    static bool is_available();

    /// The symbolic factor. @param order  of elimination of the bodies of which anything is free, which takes `operations`
    void analyse(const BlockHessian& hessian, const FreeDofs& dofs, const std::vector<int>& order, double operations);

    /// Factorises a matrix with the blocks that were analysed. @return false if the free part is not positive definite to rounding, or not
    /// finite
    bool factorise(const BlockHessian& hessian, const FreeDofs& dofs);

    /// Solution over the free part, one column per right-hand side.
    MatrixX solve(const MatrixX& rhs) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::linear
