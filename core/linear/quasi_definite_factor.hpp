// SPDX-License-Identifier: MIT
/// L D L^T without pivoting of the saddle-point matrix of a potential under rows,
///   [ H   C^T   ]
///   [ C  -delta ]
/// over the free degrees of freedom; delta is small, and refinement takes it out (linear_system.hpp).
/// Order: bodies by least fill in the graph that contacts and rows make of them, each row after the last of its bodies, so that a row's
/// pivot is that of -C H^-1 C^T and none is small unless rows depend on one another. The work of a chain is linear in its length.
/// docs/method/joints.md#the-step-under-rows.
#pragma once

#include <memory>

#include "core/linear/free_dofs.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::linear {

class QuasiDefiniteFactor {
public:
    QuasiDefiniteFactor();
    ~QuasiDefiniteFactor();
    QuasiDefiniteFactor(QuasiDefiniteFactor&&) noexcept;
    QuasiDefiniteFactor& operator=(QuasiDefiniteFactor&&) noexcept;

    /// The symbolic factor is kept while the same bodies are coupled. @return is H positive definite where C y = 0 (by the signs of the
    /// pivots)? If not, solve may still be called, unless a pivot was 0 (is_usable).
    bool factorise(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs);
    bool is_usable() const;

    /// Once through the factor. Rows of the free degrees of freedom, then of the multipliers; one column per right-hand side, with the same
    /// bits whatever stands beside it.
    MatrixX solve(const MatrixX& rhs) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::linear
